"""The tables of rows, and other parts that a program writes, on the page of a study, between two marks that it has."""
from studies.tables import markdown_head, markdown_row
from studies.verdicts import HEADS

BEGIN, END = "<!-- rows, written by study.py -->", "<!-- end of rows -->"


def tables_of(rows):
    """A table for each kind of rows that there is."""
    parts = []
    for kind, head in HEADS.items():
        lines = [markdown_row(row.cells()) for row in rows if row.kind == kind]
        if lines:
            parts.append("\n".join([markdown_head(head), *lines]))
    return "\n\n".join(parts)


def with_part(page, begin, end, text):
    """The page with this text between two marks."""
    before, rest = page.split(begin + "\n")
    _, after = rest.split(end)
    return f"{before}{begin}\n{text}\n{end}{after}"


def with_rows(page, rows):
    """The page with these rows between its marks."""
    return with_part(page, BEGIN, END, tables_of(rows))


def rewrite(path, rows):
    """Of a page that has the marks."""
    with open(path) as f:
        page = f.read()
    if BEGIN in page:
        with open(path, "w") as f:
            f.write(with_rows(page, rows))


def rewrite_part(path, name, text):
    """Another part, which has this name in its marks."""
    with open(path) as f:
        page = f.read()
    with open(path, "w") as f:
        f.write(with_part(page, f"<!-- {name}, written by study.py -->", f"<!-- end of {name} -->", text))
