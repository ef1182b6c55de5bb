#!/usr/bin/python3
"""Tests of mutations.py, with programs and sources written for the purpose."""
import os
import sys
import tempfile
import unittest

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import mutations  # noqa: E402

# Lists its tests that match the filter, and ends as told.
PROGRAM = """#!/bin/bash
filter=${1#--gtest_filter=}
if [ "$2" = --gtest_list_tests ]; then
  case "A.b A.c A.d" in *"$filter"*) printf 'A.\\n  b\\n  c\\n' ;; esac
  exit 0
fi
%s
"""


class Verdicts(unittest.TestCase):
    def noticed(self, end, names=("tests:A.b",)):
        with tempfile.TemporaryDirectory() as folder:
            bin = os.path.join(folder, "build/release/bin")
            os.makedirs(bin)
            with open(os.path.join(bin, "tests"), "w") as f:
                f.write(PROGRAM % end)
            os.chmod(os.path.join(bin, "tests"), 0o755)
            return mutations.who_of_the_named(folder, list(names))

    def test_tests_that_fail_have_noticed(self):
        self.assertEqual(self.noticed("echo '[  FAILED  ] A.b (3 ms)'; exit 1"), ["tests: A.b"])

    def test_tests_that_pass_have_not(self):
        self.assertEqual(self.noticed("exit 0"), [])

    def test_a_crash_is_told_apart(self):
        self.assertEqual(self.noticed("kill -SEGV $$"), [f"tests: {mutations.CRASH} 11"])

    def test_a_name_without_a_test_is_an_error_though_another_has_several(self):
        with self.assertRaisesRegex(SystemExit, "tests has no A.x"):
            self.noticed("exit 0", ("tests:A.b", "tests:A.x"))


class Compiling(unittest.TestCase):
    def faults(self, *changes):
        with tempfile.TemporaryDirectory() as root:
            with open(os.path.join(root, "a.cpp"), "w") as f:
                f.write("int one() { return 1; }\nint two() { return 2; }\n")
            named = [(name, "a.cpp", old, new) for name, old, new in changes]
            return [name for name, _ in mutations.not_compiled(named, root, ["c++"], 1)]

    def test_mutations_that_compile_pass(self):
        self.assertEqual(self.faults(("a", "return 1", "return 3"), ("b", "return 2", "return 4")), [])

    def test_the_one_that_does_not_is_named(self):
        self.assertEqual(self.faults(("a", "return 1", "return x"), ("b", "return 2", "return 4")), ["a"])

    def test_those_that_overlap_are_compiled_apart(self):
        self.assertEqual(self.faults(("a", "return 1;", "return 3;"), ("b", "1; }", "x; }")), ["b"])
        self.assertEqual(self.faults(("a", "return 1;", "return 3;"), ("b", "1; }", "4; }")), [])


if __name__ == "__main__":
    unittest.main()
