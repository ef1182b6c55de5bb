#!/usr/bin/python3
"""Tests that studies reach the same verdicts again from their tables alone; some also draw their figures."""
import os
import shutil
import subprocess
import tempfile
import unittest

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
RESULTS = os.path.join(ROOT, "results")
JUDGED = sorted(name for name in os.listdir(RESULTS) if os.path.exists(os.path.join(RESULTS, name, "study.json")))


def again(results, name):
    command = ["/usr/bin/python3", os.path.join(results, name, "study.py"), "--from-table"]
    return subprocess.run(command, capture_output=True, text=True)


class Judging(unittest.TestCase):
    def test_again_gives_what_study_json_and_the_page_have(self):
        """Works on a copy, so that nothing is written to the source."""
        self.assertGreaterEqual(len(JUDGED), 13)
        with tempfile.TemporaryDirectory() as folder:
            copy = os.path.join(folder, "results")
            shutil.copytree(RESULTS, copy, ignore=shutil.ignore_patterns("__pycache__", "*.png"))
            shutil.copytree(os.path.join(ROOT, "python"), os.path.join(folder, "python"))
            for name in JUDGED:
                with self.subTest(name):
                    done = again(copy, name)
                    self.assertEqual(done.returncode, 0, done.stderr)
                    for file in ("study.json", "README.md"):
                        with open(os.path.join(copy, name, file)) as a, open(os.path.join(RESULTS, name, file)) as b:
                            self.assertEqual(a.read(), b.read())

    def test_without_what_rows_are_made_of_is_refused(self):
        """Tests a study that judges the return values of its runs."""
        with tempfile.TemporaryDirectory() as folder:
            copy = os.path.join(folder, "results")
            shutil.copytree(os.path.join(RESULTS, "studies"), os.path.join(copy, "studies"))
            shutil.copytree(os.path.join(ROOT, "python"), os.path.join(folder, "python"))
            os.mkdir(os.path.join(copy, "bare"))
            with open(os.path.join(copy, "bare", "study.py"), "w") as f:
                f.write(
                    "import sys\nfrom pathlib import Path\nHERE = Path(__file__).resolve().parent\n"
                    "sys.path.insert(0, str(HERE.parent))\nfrom studies.command_line import main\n"
                    "main(HERE, 'A study', lambda program: [], lambda program: [])\n"
                )
            done = again(copy, "bare")
        self.assertEqual(done.returncode, 2)
        self.assertIn("--from-table: the tables of this study do not have all that its rows are made of", done.stderr)


if __name__ == "__main__":
    unittest.main()
