#!/usr/bin/python3
"""Verdicts of studies on published statements, and the findings on their pages."""
import contextlib
import glob
import io
import json
import math
import os
import subprocess
import sys
import tempfile
import unittest
import unittest.mock

RESULTS = os.path.join(os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__)))), "results")
sys.path.insert(0, RESULTS)
from studies.command_line import main
from studies.tables import read_numbers, read_rows, write_numbers
from studies.verdicts import BEGIN, END, LEGEND, Check, Finding, Statement, rows_of, tables_of, verdict, with_rows

STUDIES = sorted(name for name in os.listdir(RESULTS) if os.path.exists(os.path.join(RESULTS, name, "study.json")))


def study_of(name):
    with open(os.path.join(RESULTS, name, "study.json")) as f:
        return json.load(f)


def page_of(name):
    with open(os.path.join(RESULTS, name, "README.md")) as f:
        return f.read()


def statement(value, error, low=-math.inf, high=math.inf, degrees=7, essential=True):
    return Statement("", "", value, error, low, high, degrees, essential)


class Answers(unittest.TestCase):
    """Half-widths are those of Student's t with 7 degrees of freedom, 2.365 standard errors."""

    def test_are_those_of_the_value(self):
        for value, answer in ((1.02, "holds"), (0.98, "holds"), (1.07, "does not hold"), (0.93, "does not hold")):
            self.assertEqual(statement(value, 0.005, 0.95, 1.05).answer(), answer)
        self.assertEqual(statement(1.3, 0.1, low=1).answer(), "holds")
        self.assertEqual(statement(0.7, 0.1, high=1).answer(), "holds")
        self.assertEqual(statement(0.7, 0.1, low=1).answer(), "does not hold")

    def test_whose_interval_contains_a_bound_are_open(self):
        self.assertEqual(statement(1.03, 0.0084, 0.95, 1.05).answer(), "holds")  # half-width 0.0199
        self.assertEqual(statement(1.03, 0.0085, 0.95, 1.05).answer(), "open")  # 0.0201
        self.assertEqual(statement(1.07, 0.0085, 0.95, 1.05).answer(), "open")
        self.assertEqual(statement(1.07, 0.0084, 0.95, 1.05).answer(), "does not hold")
        self.assertEqual(statement(1.02, 0.0085, low=1).answer(), "open")
        self.assertEqual(statement(0.98, 0.0085, low=1).answer(), "open")

    def test_without_an_error_are_those_of_the_number(self):
        self.assertEqual(statement(1, 0, 1, 1).answer(), "holds")
        self.assertEqual(statement(0.6, 1.1e-16, 0.6, 0.8).answer(), "holds")
        self.assertEqual(statement(2, 0, high=1).answer(), "does not hold")

    def test_of_what_is_infinite_are_given(self):
        self.assertEqual(statement(math.inf, 0, low=5).answer(), "holds")
        self.assertEqual(statement(math.inf, 0, high=5).answer(), "does not hold")
        self.assertEqual(statement(math.inf, math.inf, low=5).answer(), "open")

    def test_beyond_a_bound_are_given_however_wide_the_interval_is(self):
        self.assertEqual(statement(5, 1, 0.95, 1.05).answer(), "does not hold")
        self.assertEqual(statement(64, 11, low=1).answer(), "holds")

    def test_say_whether_the_whole_interval_agrees(self):
        for value, sure in ((1.02, True), (1.04, False), (1.06, False), (1.08, True)):
            self.assertEqual(statement(value, 0.01, 0.95, 1.05).sure(), sure)  # half-width 0.0237

    def test_few_degrees_of_freedom_widen_the_interval(self):
        self.assertEqual(statement(1.3, 0.11, low=1, degrees=30).answer(), "holds")
        self.assertEqual(statement(1.3, 0.11, low=1, degrees=4).answer(), "open")

    def test_of_what_was_not_measured_are_open(self):
        self.assertEqual(statement(math.nan, math.inf, 0.9, 1.1).answer(), "open")
        self.assertEqual(statement(1, math.inf, 0.9, 1.1).answer(), "open")
        self.assertEqual(statement(1, 0.001, 0.9, 1.1, degrees=0).answer(), "open")

    def test_of_checks_have_words_of_their_own(self):
        for value, answer in ((1, "ok"), (2, "failed")):
            self.assertEqual(Check("", "", value, 0.01, 0.9, 1.1).answer(), answer)
        self.assertEqual(Check("", "", 1, 1, 0.9, 1.1).answer(), "open")


class Verdicts(unittest.TestCase):
    holds, fails, open_ = (statement(v, e, 0.9, 1.1) for v, e in ((1, 0.01), (2, 0.01), (1.1, 0.2)))
    fails_beside, open_beside = (statement(v, e, 0.9, 1.1, essential=False) for v, e in ((2, 0.01), (1.1, 0.2)))
    failed, finding = Check("", "", 2, 0.01, 0.9, 1.1), Finding("", "", 2, 0.01)

    def test_follow_from_the_statements(self):
        self.assertEqual(verdict([self.holds, self.holds]), "holds")
        self.assertEqual(verdict([self.holds, self.fails_beside]), "holds with a difference")
        self.assertEqual(verdict([self.holds, self.open_beside]), "holds with a difference")
        self.assertEqual(verdict([self.holds, self.open_]), "not yet")
        self.assertEqual(verdict([self.holds, self.fails_beside, self.open_]), "not yet")
        self.assertEqual(verdict([self.holds, self.open_, self.fails]), "does not hold")

    def test_do_not_follow_from_findings(self):
        self.assertEqual(verdict([self.holds, self.finding]), "holds")
        self.assertEqual(verdict([self.finding]), "findings only")

    def test_count_the_checks_that_failed(self):
        self.assertEqual(verdict([self.holds, self.failed]), "holds (1 check failed)")
        self.assertEqual(verdict([self.holds, self.failed, self.failed]), "holds (2 checks failed)")
        self.assertEqual(verdict([self.failed, self.finding]), "findings only (1 check failed)")

    def test_of_the_studies_follow_from_their_rows(self):
        self.assertGreaterEqual(len(STUDIES), 13)
        for name in STUDIES:
            with self.subTest(name):
                study = study_of(name)
                rows = list(rows_of(study))
                self.assertEqual(study["verdict"], verdict(rows))
                for row, entry in zip(rows, study["statements"]):
                    if row.kind != "finding":
                        self.assertEqual((row.answer(), row.sure()), (entry["answer"], entry["sure"]), row.text)

    def test_of_the_studies_do_not_rest_on_an_interval_that_contains_its_bound(self):
        for name in STUDIES:
            for row in study_of(name)["statements"]:
                if row["kind"] == "finding" or row["answer"] == "open" or row["value"] == "infinite":
                    continue
                low, high = row["value"] - row["half_width"], row["value"] + row["half_width"]
                with self.subTest(name, row=row["statement"]):
                    for bound in (row["low"], row["high"]):
                        self.assertFalse(bound is not None and low < bound < high)


class Numbers(unittest.TestCase):
    def test_are_written_with_an_error_that_seeds_make(self):
        for value, error, text in (
            (1.23456, 0.123, "1.235 ± 0.12"),
            (0.6, 1.1e-16, "0.6"),
            (1, 0, "1"),
            (math.inf, 0, "infinite"),
            (-math.inf, 0, "-infinite"),
            (math.nan, math.nan, "not measured"),
            (1.5, math.inf, "1.5, error unknown"),
        ):
            row = Finding("", "", value, error)
            self.assertEqual(row.cells()[2], text)
            (again,) = rows_of({"statements": [json.loads(json.dumps(row.as_json()))]})
            self.assertEqual((again.cells(), again.as_json()), (row.cells(), row.as_json()))

    def test_of_the_studies_have_no_error_of_rounding_and_no_number_for_infinity(self):
        for name in STUDIES:
            with self.subTest(name):
                self.assertNotRegex(page_of(name), r"± (0|nan|inf|\S*e-1[0-9]) |1e\+06")


class Pages(unittest.TestCase):
    def test_have_the_rows_that_were_found(self):
        for name in STUDIES:
            with self.subTest(name):
                page = page_of(name)
                self.assertEqual(with_rows(page, list(rows_of(study_of(name)))), page)

    def test_have_a_table_for_each_kind(self):
        rows = [Finding("b", "y", 2, 0.1), Statement("a", "x", 1.23456, 0.123, 0, 2), Check("c", "z", 3, 1, low=1)]
        page = with_rows(f"before\n{BEGIN}\nold\n{END}\nafter", rows)
        self.assertEqual(
            page.split("\n"),
            [
                "before",
                BEGIN,
                *LEGEND.split("\n"),
                "",
                "| published statement | source | value ± standard error | must be | answer |",
                "|---|---|---|---|---|",
                "| a | x | 1.235 ± 0.12 | 0 to 2 | holds |",
                "",
                "| check | of | value ± standard error | must be | answer |",
                "|---|---|---|---|---|",
                "| c | z | 3 ± 1 | at least 1 | open |",
                "",
                "| finding | about | value ± standard error |",
                "|---|---|---|",
                "| b | y | 2 ± 0.1 |",
                END,
                "after",
            ],
        )
        self.assertEqual(tables_of([]), "")


class Tables(unittest.TestCase):
    def test_of_numbers_are_read_as_they_were_written(self):
        numbers = {"a, b": (1.5, 0.25, 7), "c": (-2e-5, 1e-6, 95)}
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "numbers.csv")
            write_numbers(path, numbers)
            self.assertEqual(read_numbers(path), numbers)

    def test_may_have_texts_and_empty_cells(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "table.csv")
            with open(path, "w", newline="") as f:
                f.write("name,x\r\na,1e3\r\nb,\r\n")
            first, second = read_rows(path)
        self.assertEqual(first, {"name": "a", "x": 1000})
        self.assertTrue(math.isnan(second["x"]))


class Folders(unittest.TestCase):
    def test_a_study_that_may_not_write_what_it_finds_says_so_before_it_computes(self):
        said = io.StringIO()
        with unittest.mock.patch("sys.argv", ["study.py", "/nowhere"]), unittest.mock.patch(
            "os.access", return_value=False
        ), contextlib.redirect_stderr(said), self.assertRaises(SystemExit) as ending:
            main("/installed/results/some-study", "Some study", self.fail, self.fail)
        self.assertEqual(ending.exception.code, 2)
        self.assertIn("/installed/results/some-study", said.getvalue())


class Drivers(unittest.TestCase):
    def test_that_lack_a_module_say_what_to_install(self):
        absent = "raise ModuleNotFoundError(\"No module named 'numpy'\", name='numpy')"
        scripts = [path for path in glob.glob(os.path.join(RESULTS, "*", "*.py")) if "/studies/" not in path]
        self.assertGreaterEqual(len(scripts), 20)
        with tempfile.TemporaryDirectory() as folder:
            with open(os.path.join(folder, "numpy.py"), "w") as f:
                f.write(absent)
            for script in scripts:
                with self.subTest(os.path.relpath(script, RESULTS)):
                    done = subprocess.run(
                        ["/usr/bin/python3", script],
                        env={**os.environ, "PYTHONPATH": folder},
                        stdin=subprocess.DEVNULL,
                        capture_output=True,
                        text=True,
                    )
                    self.assertEqual(done.returncode, 1)
                    said = "studies need the Python module numpy: install python3-numpy and python3-scipy\n"
                    self.assertEqual(done.stderr, said)


if __name__ == "__main__":
    unittest.main()
