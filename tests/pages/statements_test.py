#!/usr/bin/python3
"""docs/statements.md agrees with study.json files about every published source, and omits none."""
import json
import re
import sys
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "results"))
from studies.verdicts import rows_of, verdict_of_statements, with_failed_checks

PAGE = ROOT / "docs" / "statements.md"
LINES, CELL = 45, 130  # as read: without the targets of links
# | where in print | what it says | what was found | verdict | statements that hold | study |
ROW = re.compile(
    r"\| (?P<sources>[^|]+?) \| (?P<says>[^|]+?) \| (?P<found>[^|]+?) \| (?P<verdict>[^|]+?) "
    r"\| (?P<holding>\d+) of (?P<count>\d+) \| \[(?P<study>[\w-]+)\]\(\.\./results/(?P=study)/README\.md\) \|"
)


def study_of(name):
    return json.loads((ROOT / "results" / name / "study.json").read_text())


def rows_with_kinds(name):
    """Returns the rows of a study, or none if its rows have no kinds yet."""
    study = study_of(name)
    return list(rows_of(study)) if "kind" in study["statements"][0] else []


def statements_of(name):
    return [row for row in rows_with_kinds(name) if row.kind == "statement"]


def found_of(rows, checks):
    """Returns verdict and counts for some of a study's statements; if none holds, the verdict is negative."""
    holding = sum(row.answer() == "holds" for row in rows)
    none_holds = rows and all(row.answer() == "does not hold" for row in rows)
    of_rows = "does not hold" if none_holds else verdict_of_statements(rows)
    return with_failed_checks(of_rows, checks), str(holding), str(len(rows))


def faults(page):
    """Returns differences between the page and the studies, and omissions."""
    said = set()
    for row in map(ROW.fullmatch, page.split("\n")):
        if not row:
            continue
        name, sources = row["study"], row["sources"].split(", ")
        said.update((name, source) for source in sources)
        rows = [r for r in statements_of(name) if r.source in sources]
        found = found_of(rows, rows_with_kinds(name))
        if (row["verdict"], row["holding"], row["count"]) != found:
            yield f"{name}, {row['sources']}: the page has {row['verdict']}, the study {', '.join(found)}"
    there = {
        (path.parent.name, row.source)
        for path in (ROOT / "results").glob("*/study.json")
        for row in statements_of(path.parent.name)
    }
    yield from (f"{name}, {source}: not on the page" for name, source in sorted(there - said))
    yield from (f"{name}, {source}: of no study" for name, source in sorted(said - there))


class Statements(unittest.TestCase):
    def test_of_the_page_are_those_of_the_studies(self):
        self.assertEqual(list(faults(PAGE.read_text())), [])

    def test_that_say_something_else_are_noticed(self):
        lines = PAGE.read_text().split("\n")
        rows = [k for k, line in enumerate(lines) if ROW.fullmatch(line)]
        self.assertGreaterEqual(len(rows), 20)
        for k in rows:
            verdict_of = ROW.fullmatch(lines[k])["verdict"]
            other = "does not hold" if verdict_of == "holds" else "holds"
            for line in (lines[k].replace(f"| {verdict_of} |", f"| {other} |"), ""):
                self.assertTrue(list(faults("\n".join([*lines[:k], line, *lines[k + 1 :]]))), lines[k])

    def test_take_a_screen_at_most(self):
        lines = PAGE.read_text().rstrip("\n").split("\n")
        self.assertLessEqual(len(lines), LINES)
        read = [re.sub(r"\]\([^)]*\)", "]", line) for line in lines]
        cells = [cell.strip() for line in read for cell in line.split("|")]
        self.assertEqual([cell for cell in cells if len(cell) > CELL], [])


if __name__ == "__main__":
    unittest.main()
