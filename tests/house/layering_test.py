#!/usr/bin/python3
"""layering.py reports each fault, put into a small tree of its own."""
import os
import subprocess
import sys
import tempfile
import unittest

import layering

SCRIPT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "layering.py")
LISTS = {
    f"{program}/CMakeLists.txt": layering.read(layering.SOURCE, f"{program}/CMakeLists.txt")
    for program in layering.PROGRAMS
}
EVERY_LAYER = {
    **LISTS,
    **{f"{layer}/here.h": "" for program in layering.PROGRAMS for layer in layering.layers(layering.SOURCE, program)},
}


class Layering(unittest.TestCase):
    def said(self, files, others=EVERY_LAYER):
        with tempfile.TemporaryDirectory() as folder:
            for path, text in {**others, **files}.items():
                os.makedirs(os.path.join(folder, os.path.dirname(path)), exist_ok=True)
                with open(os.path.join(folder, path), "w", encoding="utf-8") as f:
                    f.write(text)
            command = [sys.executable, SCRIPT, "--source", folder]
            if layering.PICTURE not in files:
                subprocess.run([*command, "--picture"], check=True)
            done = subprocess.run(command, capture_output=True, text=True, check=False)
        return done.returncode, done.stdout

    def test_downward_is_allowed(self):
        self.assertEqual(
            self.said({"runner/owner/a.cpp": '#include "runner/campaign/b.h"\n#include "contract/json.h"\n'}), (0, "")
        )

    def test_upward_is_not(self):
        code, text = self.said({"runner/campaign/a.cpp": '\n#include "runner/owner/b.h"\n'})
        self.assertEqual(code, 1)
        self.assertIn("runner/campaign/a.cpp:2: runner/owner/b.h: runner/campaign may not include runner/owner", text)

    def test_the_runner_knows_no_engine(self):
        self.assertEqual(self.said({"runner/command_line/a.cpp": '#include "engine/scene.h"\n'})[0], 1)

    def test_a_folder_without_a_place(self):
        code, text = self.said({"runner/attic/a.cpp": '#include "contract/json.h"\n'})
        self.assertEqual(code, 1)
        self.assertIn("runner/attic/a.cpp: its folder is no room", text)

    def test_a_picture_of_other_rooms(self):
        code, text = self.said({layering.PICTURE: "<svg/>"})
        self.assertEqual(code, 1)
        self.assertIn(f"{layering.PICTURE}: shows other rooms or includes", text)

    def test_a_layer_without_files(self):
        code, text = self.said({}, {path: text for path, text in EVERY_LAYER.items() if "terms" not in path})
        self.assertEqual((code, text), (1, "engine/terms: is a room without a file\n"))

    def test_an_empty_tree(self):
        code, text = self.said({}, LISTS)
        self.assertEqual(code, 1)
        self.assertIn("runner/command_line: is a room without a file", text)

    def test_a_circle_of_headers(self):
        code, text = self.said(
            {
                "runner/owner/a.h": '#include "runner/owner/b.h"\n#include "runner/store/c.h"\n',
                "runner/owner/b.h": '#include "runner/owner/a.h"\n',
                "runner/store/c.h": '#include "contract/json.h"\n',
            }
        )
        self.assertEqual(code, 1)
        self.assertIn("runner/owner/a.h: is in a circle of includes\nrunner/owner/b.h: is in a circle", text)
        self.assertNotIn("c.h", text)

    def test_a_class_in_two_files(self):
        one, other = "int Board::count() const {\n  return 1;\n}\n", "Board::~Board() {}\n"
        code, text = self.said({"runner/owner/a.cpp": one, "runner/owner/b.cpp": other})
        self.assertEqual(code, 1)
        self.assertIn("Board: has functions in runner/owner/a.cpp, runner/owner/b.cpp", text)
        self.assertEqual(self.said({"runner/owner/a.cpp": one, "runner/store/b.cpp": other}), (0, ""))


if __name__ == "__main__":
    unittest.main()
