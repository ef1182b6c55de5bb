"""Reads and writes csv files whose rows have numbers NAME with standard errors NAME_error."""
import csv

import numpy as np

from studies.estimates import quotient


def write_table(path, columns, rows, digits):
    """Writes rows with `digits` significant digits. `columns` are names, or a text of names with commas between them;
    NAME± stands for a number and its standard error."""
    if isinstance(columns, str):
        names = (name.strip() for name in columns.split(","))
        columns = [c for n in names for c in (columns_of(n[:-1]) if n[-1] == "±" else [n])]
    with open(path, "w", newline="") as f:
        writer = csv.DictWriter(f, columns)
        writer.writeheader()
        for row in rows:
            writer.writerow(
                {k: f"{row[k]:.{digits}g}" if isinstance(row.get(k), float) else row.get(k) for k in columns}
            )


def write_rows(path, rows, digits):
    """Writes all columns of the rows, in the order of the first row."""
    write_table(path, list(rows[0]), rows, digits)


def read_texts(path):
    """Returns the rows of a table as dictionaries of texts."""
    with open(path, newline="") as f:
        return list(csv.DictReader(f))


def read_rows(path):
    """Returns the rows of a table as dictionaries; cells are numbers where possible, NaN if empty, or texts."""

    def value(text):
        try:
            return float(text or "nan")
        except ValueError:
            return text

    return [{name: value(text) for name, text in row.items()} for row in read_texts(path)]


def write_numbers(path, numbers):
    """Writes numbers by name: (value, standard error, degrees of freedom)."""
    rows = [dict(zip(("name", "value", "standard_error", "degrees"), (name, *of))) for name, of in numbers.items()]
    write_rows(path, rows, 5)


def read_numbers(path):
    return {r["name"]: (r["value"], r["standard_error"], r["degrees"]) for r in read_rows(path)}


def where(rows, **equal):
    """Returns the rows that have these values."""
    return [row for row in rows if all(row[name] == value for name, value in equal.items())]


def first(rows, **equal):
    """Returns the first row that has these values."""
    return next(row for row in rows if all(row[name] == value for name, value in equal.items()))


def groups(rows, name):
    """Returns the rows by their value of a column, in the order of their first appearance."""
    found = {}
    for row in rows:
        found.setdefault(row[name], []).append(row)
    return found


def column(rows, name):
    return np.array([row[name] for row in rows], float)


def number(row, name):
    """Returns a number of a row and its standard error."""
    return row[name], row[f"{name}_error"]


def row_ratio(a, b, name):
    """Returns the ratio of a number in two independent rows, with its standard error."""
    return quotient(number(a, name), number(b, name))


def entries(name, pair):
    """Returns the entries of a row for a number and its standard error."""
    return {name: pair[0], f"{name}_error": pair[1]}


def number_text(pair, digits):
    """Returns a number and its standard error as text for a page."""
    return f"{pair[0]:.{digits}f} ± {pair[1]:.{digits}f}"


def columns_of(*names):
    """Returns the column names of numbers with their errors."""
    return [c for n in names for c in (n, f"{n}_error")]


def markdown_row(cells):
    """Returns a line of a table on a page."""
    return "|" + "|".join(f" {cell} " if cell != "" else " " for cell in cells) + "|"


def markdown_head(names):
    """Returns the two lines above a table on a page."""
    return f"{markdown_row(names)}\n|{'---|' * len(names)}"
