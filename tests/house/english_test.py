#!/usr/bin/python3
"""english.py reports each fault, put into a small tree of its own."""
import json
import os
import tempfile
import unittest

import english

WALK = "| step | file | function |\n|---|---|---|\n| a seed ends | `runner/a.cpp` | `take` |\n"
SOUND = {
    "docs/architecture.md": WALK,
    "runner/a.cpp": "// Takes a result.\nvoid take() {}\n",
    "README.md": "Set `/fluid/viscosity` in `/tmp/scene.json`.\n",
    "schema/scene.schema.json": json.dumps(
        {"properties": {"fluid": {"properties": {"viscosity": {}}}, "sweep": {"items": {"properties": {"set": {}}}}}}
    ),
}


class English(unittest.TestCase):
    def faults(self, **files):
        with tempfile.TemporaryDirectory() as folder:
            for path, text in {**SOUND, **{key.replace("__", "/"): text for key, text in files.items()}}.items():
                os.makedirs(os.path.join(folder, os.path.dirname(path)), exist_ok=True)
                with open(os.path.join(folder, path), "w", encoding="utf-8") as file:
                    file.write(text)
            return list(english.faults_in(folder))

    def expect(self, fault, path, text):
        found = self.faults(**{path.replace("/", "__"): text})
        self.assertEqual(len(found), 1, found)
        self.assertIn(fault, found[0])

    def test_a_sound_tree_has_none(self):
        self.assertEqual(self.faults(), [])

    def test_openings_of_comments(self):
        self.expect(
            'engine/b.h:2: a comment begins with "Of"', "engine/b.h", "int a;\n// Of what save() has written.\n"
        )
        self.expect('begins with "What"', "python/b.py", "# What is left.\n")
        self.expect('begins with "Whose"', "schema/b.sql", "-- Whose sums these are.\n")

    def test_puzzling_words(self):
        self.expect('"nobody" in a comment', "engine/b.h", "// Returns true if\n// nobody waits.\n")
        self.expect('"to and fro" on a page', "docs/b.md", "A shear to and fro.\n")
        self.assertEqual(self.faults(docs__b="`sudo chown nobody`\n"), [])

    def test_long_sentences(self):
        words = "word " * english.MOST_WORDS
        self.assertEqual(self.faults(**{"docs__b.md": words + "\n"}), [])
        self.expect(f"a sentence of {english.MOST_WORDS + 1} words", "docs/b.md", words + "more\n")
        self.assertEqual(self.faults(**{"docs__b.md": f"| {words * 2} |\n\n```\n{words * 2}\n```\n"}), [])

    def test_keys_without_a_schema(self):
        self.expect("/fluid/density is in no schema", "docs/b.md", "Set `/fluid/density`.\n")
        self.assertEqual(self.faults(**{"docs__b.md": "Set `/sweep/*/set`.\n"}), [])

    def test_functions_that_have_gone(self):
        self.expect("docs/architecture.md:3: take() is not in", "runner/a.cpp", "void book() {}\n")


if __name__ == "__main__":
    unittest.main()
