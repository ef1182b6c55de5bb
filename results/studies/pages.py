"""The tables of rows on the page of a study, between two marks that it has."""
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


def with_rows(page, rows):
    """The page with these rows between its marks."""
    before, rest = page.split(BEGIN + "\n")
    _, after = rest.split(END)
    return f"{before}{BEGIN}\n{tables_of(rows)}\n{END}{after}"


def rewrite(path, rows):
    """Of a page that has the marks."""
    with open(path) as f:
        page = f.read()
    if BEGIN in page:
        with open(path, "w") as f:
            f.write(with_rows(page, rows))
