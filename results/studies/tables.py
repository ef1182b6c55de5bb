"""csv files, and rows that have numbers NAME with standard errors NAME_error."""
import csv


def write_table(path, columns, rows, digits):
    with open(path, "w", newline="") as f:
        writer = csv.DictWriter(f, columns)
        writer.writeheader()
        for row in rows:
            writer.writerow(
                {k: f"{row[k]:.{digits}g}" if isinstance(row.get(k), float) else row.get(k) for k in columns}
            )


def read_table(path):
    """Rows of a table whose columns are all numbers."""
    return [{name: float(value) for name, value in row.items()} for row in read_texts(path)]


def read_texts(path):
    """Rows of a table as they are written."""
    with open(path, newline="") as f:
        return list(csv.DictReader(f))


def read_rows(path):
    """Rows of a table with texts; what is a number becomes one, an empty cell nan."""

    def value(text):
        try:
            return float(text or "nan")
        except ValueError:
            return text

    return [{name: value(text) for name, text in row.items()} for row in read_texts(path)]


def write_numbers(path, numbers):
    """Numbers that only the seeds tell, by name: value, standard error, degrees of freedom."""
    rows = [dict(zip(("name", "value", "standard_error", "degrees"), (name, *of))) for name, of in numbers.items()]
    write_table(path, list(rows[0]), rows, 5)


def read_numbers(path):
    return {r["name"]: (r["value"], r["standard_error"], r["degrees"]) for r in read_rows(path)}


def number(row, name):
    """A number of a row and its standard error."""
    return row[name], row[f"{name}_error"]


def entries(name, pair):
    """The other way round: what a row has of a number and its standard error."""
    return {name: pair[0], f"{name}_error": pair[1]}


def number_text(pair, digits):
    """A number with its standard error on a page."""
    return f"{pair[0]:.{digits}f} ± {pair[1]:.{digits}f}"


def columns_of(*names):
    """Column names of numbers with their errors."""
    return [c for n in names for c in (n, f"{n}_error")]


def markdown_row(cells):
    """A line of a table on a page."""
    return "|" + "|".join(f" {cell} " if cell != "" else " " for cell in cells) + "|"


def markdown_head(names):
    """The two lines above a table on a page."""
    return f"{markdown_row(names)}\n|{'---|' * len(names)}"
