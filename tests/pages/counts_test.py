#!/usr/bin/python3
"""Counts on the pages equal the counted things."""
import os
import re
import sys
import unittest

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")
sys.path[:0] = [os.path.join(ROOT, "tests", folder) for folder in ("end_to_end", "mutations")]
import at_two_in_the_morning  # noqa: E402
import hostile_engine  # noqa: E402
import mutations  # noqa: E402


class Counts(unittest.TestCase):
    def said(self, pattern, *pages):
        """Yields the numbers at every match on these pages."""
        for page in pages:
            with open(os.path.join(ROOT, page), encoding="utf-8") as file:
                places = re.findall(pattern, file.read())
            self.assertTrue(places, f"{page}: has no {pattern}")
            for place in places:
                yield page, int(place)

    def test_of_ways_in_which_an_engine_lies(self):
        for page, count in self.said(r"(\d+) ways", "docs/guarantees.md", "tests/end_to_end/README.md"):
            self.assertEqual(count, len(hostile_engine.chosen_ways()), page)

    def test_of_mistakes_of_a_tired_person(self):
        cases = sum(len(module.CASES) for _, module in at_two_in_the_morning.CHAPTERS)
        pages = ("docs/guarantees.md", "tests/end_to_end/README.md")
        for page, count in self.said(r"(\d+) mistakes", *pages):
            self.assertEqual(count, cases, page)
        *_, (page, last) = self.said(r"(?m)^### (\d+)\. ", "tests/end_to_end/MISTAKES.md")
        self.assertEqual(last, cases, page)

    def test_of_broken_lines_of_the_engine(self):
        fine, both = len(mutations.NAMED), len(mutations.NAMED) + len(mutations.COARSE)
        for page, count in self.said(r"(\d+) errors put in", "docs/guarantees.md"):
            self.assertEqual(count, both, page)
        for page, count in self.said(r"(\d+) of them subtle", "docs/guarantees.md"):
            self.assertEqual(count, fine, page)


if __name__ == "__main__":
    unittest.main()
