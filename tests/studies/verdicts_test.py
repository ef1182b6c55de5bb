#!/usr/bin/python3
"""How studies answer published statements, and whether their pages say what was found."""
import contextlib
import glob
import io
import json
import math
import os
import re
import subprocess
import sys
import tempfile
import unittest
import unittest.mock

RESULTS = os.path.join(os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__)))), "results")
sys.path.insert(0, RESULTS)
from studies.command_line import main
from studies.verdicts import Statement, verdict

STUDIES = sorted(name for name in os.listdir(RESULTS) if os.path.exists(os.path.join(RESULTS, name, "study.json")))


class Found:
    """A statement of study.json, as verdict() sees one."""

    def __init__(self, entry):
        self.essential, self.found = entry["essential"], entry["answer"]

    def answer(self):
        return self.found


def within_bounds(found):
    """Whether the value itself is what it must be: the error only decides whether that is known."""
    return (found["low"] is None or found["low"] <= found["value"]) and (
        found["high"] is None or found["value"] <= found["high"]
    )


def statement(value, error, low=-math.inf, high=math.inf, degrees=7, essential=True):
    return Statement("", "", value, error, low, high, degrees, essential)


class Answers(unittest.TestCase):
    def test_an_interval_within_the_bounds_holds(self):
        self.assertEqual(statement(1.02, 0.01, 0.95, 1.05).answer(), "holds")  # to 1.0437

    def test_an_interval_across_a_bound_is_open(self):
        self.assertEqual(statement(1.02, 0.013, 0.95, 1.05).answer(), "open")  # to 1.0507
        self.assertEqual(statement(1.08, 0.013, 0.95, 1.05).answer(), "open")  # from 1.0493
        self.assertEqual(statement(0.98, 0.1, 0.95, 1.05).answer(), "open")

    def test_an_interval_beyond_a_bound_fails(self):
        self.assertEqual(statement(1.08, 0.012, 0.95, 1.05).answer(), "fails")  # from 1.0516
        self.assertEqual(statement(0.9, 0.02, 0.95, 1.05).answer(), "fails")

    def test_few_degrees_of_freedom_widen_the_interval(self):
        self.assertEqual(statement(1.3, 0.11, low=1, degrees=30).answer(), "holds")
        self.assertEqual(statement(1.3, 0.11, low=1, degrees=4).answer(), "open")

    def test_bounds_may_be_on_one_side(self):
        self.assertEqual(statement(1.3, 0.1, low=1).answer(), "holds")
        self.assertEqual(statement(0.7, 0.1, high=1).answer(), "holds")
        self.assertEqual(statement(0.7, 0.1, low=1).answer(), "fails")

    def test_what_was_not_measured_is_open(self):
        self.assertEqual(statement(math.nan, math.inf, 0.9, 1.1).answer(), "open")
        self.assertEqual(statement(1, math.inf, 0.9, 1.1).answer(), "open")
        self.assertEqual(statement(1, 0.001, 0.9, 1.1, degrees=0).answer(), "open")


class Verdicts(unittest.TestCase):
    holds, fails, open_ = (statement(v, 0.01, 0.9, 1.1) for v in (1, 2, 1.1))
    fails_beside = statement(2, 0.01, 0.9, 1.1, essential=False)
    open_beside = statement(1.1, 0.01, 0.9, 1.1, essential=False)

    def test_follow_from_the_answers(self):
        self.assertEqual(verdict([self.holds, self.holds]), "holds")
        self.assertEqual(verdict([self.holds, self.fails_beside]), "holds with a difference")
        self.assertEqual(verdict([self.holds, self.open_]), "not yet")
        self.assertEqual(verdict([self.holds, self.fails_beside, self.open_beside]), "not yet")
        self.assertEqual(verdict([self.holds, self.open_, self.fails]), "does not hold")

    def test_of_the_studies_follow_from_their_answers(self):
        self.assertGreaterEqual(len(STUDIES), 11)
        for name in STUDIES:
            with self.subTest(name):
                with open(os.path.join(RESULTS, name, "study.json")) as f:
                    study = json.load(f)
                self.assertEqual(study["verdict"], verdict([Found(s) for s in study["statements"]]))
                for found in study["statements"]:
                    if found["answer"] != "open":
                        self.assertEqual(found["answer"] == "holds", within_bounds(found), found["statement"])


def numbers_of(cell):
    """Value and standard error of "1.02 ± 0.03", and half a unit of the last digit of each."""
    for text in re.split("±", cell.replace("−", "-").replace("*", "")):
        digits = re.fullmatch(r"\s*(-?[0-9.]+)(e[-+]?[0-9]+)?\s*", text)
        if not digits:
            yield math.nan, math.inf
            continue
        power = int(digits[2][1:]) if digits[2] else 0
        places = len(digits[1].split(".")[1]) if "." in digits[1] else 0
        yield float(text), 0.5 * 10.0 ** (power - places)


class Pages(unittest.TestCase):
    def test_have_the_numbers_and_answers_that_were_found(self):
        for name in STUDIES:
            with open(os.path.join(RESULTS, name, "study.json")) as f:
                found = json.load(f)["statements"]
            with open(os.path.join(RESULTS, name, "README.md")) as f:
                rows = [
                    line.strip().strip("|").split("|")
                    for line in f
                    if re.search(r"\| (holds|fails|open) \|$", line.strip())
                ]
            with self.subTest(name):
                self.assertEqual(len(rows), len(found))
            for row, entry in zip(rows, found):
                with self.subTest(f"{name}: {row[0].strip()}"):
                    self.assertEqual(row[-1].strip(), entry["answer"])
                    numbers = list(numbers_of(row[-3]))
                    self.assertEqual(len(numbers), 2)
                    for (printed, half), key in zip(numbers, ("value", "standard_error")):
                        if entry[key] is None:
                            self.assertTrue(math.isnan(printed))
                        else:
                            # What is stored has five digits itself.
                            self.assertLessEqual(abs(printed - entry[key]), half * 1.001 + abs(entry[key]) * 5e-5)
                    bounds = [float(number) for number in re.findall("-?[0-9.]+", row[-2].replace("−", "-"))]
                    self.assertEqual(
                        [f"{b:.4g}" for b in bounds],
                        [f"{entry[key]:.4g}" for key in ("low", "high") if entry[key] is not None],
                    )


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
