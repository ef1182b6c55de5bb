#!/usr/bin/python3
"""Does layering.py see what it is for? Each fault is put into a small tree of its own."""
import os
import subprocess
import sys
import tempfile
import unittest

import layering

SCRIPT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "layering.py")
EVERY_LAYER = {f"{layer}/here.h": "" for layers in layering.LAYERS.values() for layer in layers}


class Layering(unittest.TestCase):
    def said(self, files, others=EVERY_LAYER):
        with tempfile.TemporaryDirectory() as folder:
            for path, text in {**others, **files}.items():
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
        code, text = self.said({"runner/text/a.cpp": "\n" * 601})
        self.assertEqual(code, 1)
        self.assertIn("runner/text/a.cpp: 601 lines", text)

    def test_a_long_file_of_tests(self):
        for path in ("tests/runner/text/a.cpp", "tests/end_to_end/a.py"):
            self.assertEqual(self.said({path: "\n" * 600}), (0, ""))
            code, text = self.said({path: "\n" * 601})
            self.assertEqual(code, 1)
            self.assertIn(f"{path}: 601 lines", text)

    def test_a_layer_without_files(self):
        code, text = self.said({}, {path: text for path, text in EVERY_LAYER.items() if "random" not in path})
        self.assertEqual((code, text), (1, "engine/random: is a layer of engine without a file\n"))

    def test_an_empty_tree(self):
        code, text = self.said({}, {})
        self.assertEqual(code, 1)
        self.assertIn("runner/verbs: is a layer of runner without a file", text)

    def test_a_crowded_folder(self):
        code, text = self.said({f"runner/text/a{i}.h": "" for i in range(60)})
        self.assertEqual(code, 1)
        self.assertIn("runner/text: 61 files", text)


if __name__ == "__main__":
    unittest.main()
