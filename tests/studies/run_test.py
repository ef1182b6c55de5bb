#!/usr/bin/python3
"""Tests that studies are listed with their findings, and run alone or all, also after an interruption."""
import json
import signal
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

SOURCE = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(SOURCE / "results"))
from run import READ, RESULTS, in_turn, summaries

RUN = SOURCE / "results" / "run.py"
# A driver that reports its run; it fails, or waits, while a file of that name is beside it.
DRIVER = """#!/usr/bin/python3
import sys, time
from pathlib import Path
here, binaries, folder, kind = Path(__file__).parent, *sys.argv[1:]
assert kind == "--long" and binaries == str(here.parent.parent / "bin"), sys.argv
with open(here.parent / "ran", "a") as f:
    f.write(here.name + "\\n")
while (here / "waits").exists():
    time.sleep(0.02)
sys.exit(3 if (here / "fails").exists() else 0)
"""


class Results:
    """A folder of studies, each with the hours of its last run; None if it never ran."""

    def __init__(self, folder, **hours):
        self.root, self.campaigns = Path(folder) / "results", Path(folder) / "campaigns"
        self.root.mkdir(parents=True)
        self.programs = Path(folder) / "bin"
        self.programs.mkdir()
        (self.programs / "peclet-engine").touch()
        (self.root / "run.py").write_text(RUN.read_text())
        for name, value in hours.items():
            self.add(name, value and {"processor_hours": value})

    def add(self, name, found, driver=DRIVER):
        (self.root / name).mkdir()
        (self.root / name / "study.py").write_text(driver)
        if found:
            study = {"title": name.title(), "verdict": "holds", "date": "2026-01-31", "statements": [], **found}
            (self.root / name / "study.json").write_text(json.dumps(study))

    def run(self, *words):
        command = [sys.executable, str(self.root / "run.py"), *words]
        return subprocess.run(command, capture_output=True, text=True)

    def command(self):
        where = ["--folder", str(self.campaigns), "--programs", str(self.programs)]
        return [sys.executable, str(self.root / "run.py"), "--overnight", *where]

    def make(self, *names):
        return subprocess.run([*self.command(), *names], capture_output=True, text=True)

    def ran(self):
        return (self.root / "ran").read_text().split()


# Three published statements, two of which hold; two checks, one of which passed; and a finding.
ROWS = [
    {"kind": kind, "answer": answer}
    for kind, answers in {"statement": ["holds", "does not hold", "holds"], "check": ["ok", "failed"]}.items()
    for answer in answers
] + [{"kind": "finding", "value": 1}]


class InAFolder(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.results = Results(self.folder.name)


class TheList(InAFolder):
    def test_is_in_order_and_says_what_was_found(self):
        self.results.add("zero-shear", None)
        self.results.add(
            "diffusion", {"verdict": "holds with a difference", "processor_hours": 0.25, "statements": ROWS}
        )
        (self.results.root / "no-study").mkdir()
        self.assertEqual(
            self.results.run().stdout,
            "study       verdict                  statements that hold  checks passed  CPU h        made  older than\n"
            "diffusion   holds with a difference                2 of 3         1 of 2   0.25  2026-01-31\n"
            "zero-shear  not yet                                     -              -      -           -\n",
        )
        first, second = json.loads(self.results.run("--json").stdout)["studies"]
        self.assertEqual((first["statements"], first["statements_that_hold"]), (3, 2))
        self.assertEqual((first["checks"], first["checks_passed"], first["title"]), (2, 1, "Diffusion"))
        self.assertIsNone(second["processor_hours"])

    def test_says_which_read_newer_tables(self):
        for name, date in (("inhomogeneous-flow", "2026-01-31"), ("learned-rheology", "2026-01-30")):
            self.results.add(name, {"processor_hours": 1, "date": date})
        studies = json.loads(self.results.run("--json").stdout)["studies"]
        self.assertEqual([study["older_than"] for study in studies], [[], ["inhomogeneous-flow"]])

    def test_names_a_file_that_no_study_leaves(self):
        self.results.add("diffusion", {"processor_hours": 1})
        (self.results.root / "diffusion" / "study.json").write_text('{"title": "Diffusion"}')
        done = self.results.run()
        self.assertEqual(done.returncode, 1)
        self.assertIn(str(self.results.root / "diffusion" / "study.json") + ": is not what a study leaves", done.stderr)


class OneStudy(InAFolder):
    def test_ends_as_its_driver_which_is_told_what_was_asked(self):
        expected = [str(self.results.programs), "/campaigns", "--long", "--times", "4"]
        self.results.add("diffusion", None, f"import sys\nsys.exit(7 if sys.argv[1:] == {expected} else 8)\n")
        words = ["--programs", str(self.results.programs), "--folder", "/campaigns", "--long", "--times", "4"]
        self.assertEqual(self.results.run("diffusion", *words).returncode, 7)

    def test_that_is_not_there_is_refused_with_the_names_of_those_that_are(self):
        self.results.add("diffusion", None)
        done = self.results.run("difusion")
        self.assertEqual(done.returncode, 2)
        self.assertIn("difusion: must be one of: diffusion", done.stderr)

    def test_is_needed_by_options_that_are_not_of_the_list(self):
        self.assertEqual(self.results.run("--folder", "/campaigns").returncode, 2)
        self.assertEqual(self.results.run("--quick").returncode, 2)


class Overnight(InAFolder):
    def test_makes_cheap_ones_first_and_those_of_unknown_cost_last(self):
        results = Results(self.folder.name + "/own", dear=1.5, unknown=None, cheap=0.25)
        done = results.make()
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(results.ran(), ["cheap", "dear", "unknown"])
        self.assertIn(
            "3 of 3 studies are to be made: 1.8 h of processor time and an unknown one for unknown", done.stdout
        )

    def test_makes_those_alone_that_are_named_after_those_that_they_read(self):
        results = Results(self.folder.name + "/own", **{"learned-rheology": 0.1, "inhomogeneous-flow": 2, "other": 1})
        done = results.make("learned-rheology")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(results.ran(), ["inhomogeneous-flow", "learned-rheology"])
        self.assertIn("2 of 2 studies are to be made: 2.1 h", done.stdout)
        done = results.make("nothing")
        self.assertEqual(done.returncode, 2)
        self.assertIn("nothing: must be one of: inhomogeneous-flow, learned-rheology, other", done.stderr)

    def test_makes_none_again_that_was_made(self):
        results = Results(self.folder.name + "/own", a=1, b=2)
        results.make()
        done = results.make()
        self.assertEqual(done.returncode, 0)
        self.assertEqual(results.ran(), ["a", "b"])

    def test_goes_on_beyond_one_that_fails_and_says_that_it_remains(self):
        results = Results(self.folder.name + "/own", a=1, b=2)
        (results.root / "a" / "fails").touch()
        done = results.make()
        self.assertEqual(done.returncode, 1)
        self.assertEqual(results.ran(), ["a", "b"])
        self.assertIn("remain: a: 1 h of processor time; the same command goes on", done.stdout)
        (results.root / "a" / "fails").unlink()
        self.assertEqual(results.make().returncode, 0)
        self.assertEqual(results.ran(), ["a", "b", "a"])

    def test_says_what_remains_when_it_is_interrupted_and_goes_on_there(self):
        results = Results(self.folder.name + "/own", a=1, b=2, c=4)
        waits = results.root / "b" / "waits"
        waits.touch()
        for sent in (signal.SIGINT, signal.SIGTERM):
            running = subprocess.Popen(results.command(), stdout=subprocess.PIPE, text=True)
            while not (results.root / "ran").exists() or results.ran()[-1:] != ["b"]:
                time.sleep(0.02)
            running.send_signal(sent)
            said, _ = running.communicate(timeout=60)
            self.assertEqual(running.returncode, 130)
            self.assertIn("remain: b, c: 6 h of processor time; the same command goes on", said)
            (results.root / "ran").write_text("")
        waits.unlink()
        self.assertEqual(results.make().returncode, 0)
        self.assertEqual(results.ran(), ["b", "c"])

    def test_makes_studies_after_those_that_they_read(self):
        hours = {study["study"]: study["processor_hours"] for study in summaries()}
        order = [name for name, _ in in_turn(hours)]
        self.assertGreaterEqual(len(order), 14)
        for name, read in READ.items():
            for other in read:
                self.assertLess(order.index(other), order.index(name), f"{name} reads {other}")
                drivers = [RESULTS / name / "study.py", *(RESULTS / "studies").glob("*.py")]
                self.assertTrue(any(f'"{other}"' in path.read_text() for path in drivers), f"{name} reads {other}")


if __name__ == "__main__":
    unittest.main()
