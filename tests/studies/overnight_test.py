#!/usr/bin/python3
"""That all studies are made in turn, go on after an interruption, and say what remains."""
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
from studies.overnight import READ, RESULTS, studies_of

OVERNIGHT = SOURCE / "results" / "studies" / "overnight.py"
# A driver that says that it ran; it fails, or waits, while there is a file of that name beside it.
DRIVER = """#!/usr/bin/python3
import sys, time
from pathlib import Path
here, binaries, folder, kind = Path(__file__).parent, *sys.argv[1:]
assert kind == "--long" and binaries == "/bin"
with open(here.parent / "ran", "a") as f:
    f.write(here.name + "\\n")
while (here / "waits").exists():
    time.sleep(0.02)
sys.exit(3 if (here / "fails").exists() else 0)
"""


class Results:
    """A folder of studies, each with the hours that it took before; None: it was never made."""

    def __init__(self, folder, **hours):
        self.root, self.campaigns = Path(folder) / "results", Path(folder) / "campaigns"
        (self.root / "studies").mkdir(parents=True)
        (self.root / "studies" / "overnight.py").write_text(OVERNIGHT.read_text())
        for name, value in hours.items():
            (self.root / name).mkdir()
            (self.root / name / "study.py").write_text(DRIVER)
            if value is not None:
                (self.root / name / "study.json").write_text(json.dumps({"processor_hours": value}))

    def command(self):
        return [sys.executable, str(self.root / "studies" / "overnight.py"), "/bin", str(self.campaigns)]

    def make(self, *names):
        return subprocess.run([*self.command(), *names], capture_output=True, text=True)

    def ran(self):
        return (self.root / "ran").read_text().split()


class Overnight(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)

    def test_makes_cheap_ones_first_and_those_of_unknown_cost_last(self):
        results = Results(self.folder.name, dear=1.5, unknown=None, cheap=0.25)
        done = results.make()
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(results.ran(), ["cheap", "dear", "unknown"])
        self.assertIn(
            "3 of 3 studies are to be made: 1.8 h of processor time and an unknown one for unknown", done.stdout
        )

    def test_makes_those_alone_that_are_named_after_those_that_they_read(self):
        results = Results(self.folder.name, **{"learned-rheology": 0.1, "inhomogeneous-flow": 2, "other": 1})
        done = results.make("learned-rheology")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(results.ran(), ["inhomogeneous-flow", "learned-rheology"])
        self.assertIn("2 of 2 studies are to be made: 2.1 h", done.stdout)
        done = results.make("nothing")
        self.assertEqual(done.returncode, 2)
        self.assertIn("nothing: must be one of: inhomogeneous-flow, learned-rheology, other", done.stderr)

    def test_makes_none_again_that_was_made(self):
        results = Results(self.folder.name, a=1, b=2)
        results.make()
        done = results.make()
        self.assertEqual(done.returncode, 0)
        self.assertEqual(results.ran(), ["a", "b"])

    def test_goes_on_beyond_one_that_fails_and_says_that_it_remains(self):
        results = Results(self.folder.name, a=1, b=2)
        (results.root / "a" / "fails").touch()
        done = results.make()
        self.assertEqual(done.returncode, 1)
        self.assertEqual(results.ran(), ["a", "b"])
        self.assertIn("remain: a: 1 h of processor time; the same command goes on", done.stdout)
        (results.root / "a" / "fails").unlink()
        self.assertEqual(results.make().returncode, 0)
        self.assertEqual(results.ran(), ["a", "b", "a"])

    def test_says_what_remains_when_it_is_interrupted_and_goes_on_there(self):
        results = Results(self.folder.name, a=1, b=2, c=4)
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
        order = [name for name, _ in studies_of(RESULTS)]
        self.assertGreaterEqual(len(order), 14)
        for name, read in READ.items():
            for other in read:
                self.assertLess(order.index(other), order.index(name), f"{name} reads {other}")
                drivers = [RESULTS / name / "study.py", *(RESULTS / "studies").glob("*.py")]
                self.assertTrue(any(f'"{other}"' in path.read_text() for path in drivers), f"{name} reads {other}")


if __name__ == "__main__":
    unittest.main()
