#!/usr/bin/python3
"""Does layering.py see what it is for? Each fault is put into a small tree of its own."""
import os
import subprocess
import sys
import tempfile
import unittest

SCRIPT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "layering.py")


class Layering(unittest.TestCase):
    def said(self, files):
        with tempfile.TemporaryDirectory() as folder:
            for path, text in files.items():
                os.makedirs(os.path.join(folder, os.path.dirname(path)), exist_ok=True)
                with open(os.path.join(folder, path), "w", encoding="utf-8") as f:
                    f.write(text)
            done = subprocess.run(
                [sys.executable, SCRIPT, "--source", folder], capture_output=True, text=True, check=False
            )
        return done.returncode, done.stdout

    def test_downward_is_allowed(self):
        self.assertEqual(
            self.said({"runner/owner/a.cpp": '#include "runner/text/b.h"\n#include "contract/json.h"\n'}), (0, "")
        )

    def test_upward_is_not(self):
        code, text = self.said({"runner/text/a.cpp": '\n#include "runner/owner/b.h"\n'})
        self.assertEqual(code, 1)
        self.assertIn("runner/text/a.cpp:2: runner/owner/b.h: runner/text may not include runner/owner", text)

    def test_the_runner_knows_no_engine(self):
        self.assertEqual(self.said({"runner/verbs/a.cpp": '#include "engine/scene.h"\n'})[0], 1)

    def test_a_folder_without_a_place(self):
        code, text = self.said({"runner/attic/a.cpp": '#include "contract/json.h"\n'})
        self.assertEqual(code, 1)
        self.assertIn("runner/attic/a.cpp: its folder has no place", text)

    def test_a_long_file(self):
        code, text = self.said({"runner/text/a.cpp": "\n" * 351})
        self.assertEqual(code, 1)
        self.assertIn("runner/text/a.cpp: 351 lines", text)

    def test_a_crowded_folder(self):
        code, text = self.said({f"runner/text/a{i}.h": "" for i in range(31)})
        self.assertEqual(code, 1)
        self.assertIn("runner/text: 31 files", text)


if __name__ == "__main__":
    unittest.main()
