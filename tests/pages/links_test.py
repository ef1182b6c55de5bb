#!/usr/bin/python3
"""Tests of links.py, on pages written for the purpose."""
import os
import sys
import tempfile
import unittest

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import links  # noqa: E402

OTHER = "# Other\n\n## A `code` heading, with commas\n\n## Twice\n\n## Twice\n\n```\n## not a heading\n```\n"


class Pages(unittest.TestCase):
    def faults(self, readme, **pages):
        with tempfile.TemporaryDirectory() as root:
            os.mkdir(os.path.join(root, "docs"))
            for name, text in {"README": readme, "docs/other": OTHER, **pages}.items():
                ending = ".txt" if name == "CMakeLists" else ".md"
                with open(os.path.join(root, name + ending), "w", encoding="utf-8") as file:
                    file.write(text)
            return list(links.faults(root))


class Links(Pages):
    def test_that_lead_somewhere_pass(self):
        for text in (
            "[a](docs/other.md)",
            "[a](docs/)",
            "[a](docs/other.md#other)",
            "[a](docs/other.md#a-code-heading-with-commas)",
            "[a](docs/other.md#twice-1)",
            "# Here\n[a](#here)",
            "[a\nb](docs/other.md)",
            "![a](README.md)",
            "[a](https://example.org/x)",
            '[a](docs/other.md "title")',
            "[a]: docs/other.md",
            "<img src='docs/other.md'>",
            "[![a](README.md)](docs/other.md)",
        ):
            with self.subTest(text):
                self.assertEqual(self.faults(text), [])

    def test_that_lead_nowhere_are_noticed(self):
        for text in (
            "[a](docs/none.md)",
            "[a](other.md)",
            "[a](docs/other.md#none)",
            "[a](docs/other.md#not-a-heading)",
            "[a](docs/other.md#twice-2)",
            "# Here\n[a](#there)",
            "[a\nb](none.md)",
            "![a](none.png)",
            "[a](/docs/other.md)",
            "[a]: none.md",
            "<img src='none.png'>",
            "[![a](none.png)](docs/other.md)",
            "- item\n\n  [a](none.md)",
            "| [a](none.md) |",
            "[`code`](none.md)",
        ):
            with self.subTest(text):
                self.assertEqual(len(self.faults(text)), 1, text)

    def test_in_code_are_none(self):
        for text in (
            "```\n[a](none.md)\n```",
            "text\n\n    [a](none.md)\n",
            "`[a](none.md)`",
            "``[a](none.md)``",
            "~~~\n[a](none.md)\n```\n~~~",
        ):
            with self.subTest(text):
                self.assertEqual(self.faults(text), [])

    def test_are_named_with_their_place(self):
        self.assertEqual(self.faults("# A\n\n[a](docs/none.md)"), ["README.md:3: docs/none.md: there is no such file"])


class Paths(Pages):
    def test_of_the_source_lead_somewhere(self):
        for text in (
            "`docs/other.md`",
            "`docs/`",
            "`docs/other.md --option`",
            "`my/own.py`",
            "`docs/NAME.md.`",
            "```\ndocs/none.md\n```",
        ):
            with self.subTest(text):
                self.assertEqual(self.faults(text, CMakeLists=""), [])
        for text in ("`docs/none.md`", "`tests/none.py BIN`", "`python3 tests/none.py`", "`tests/a/none.cpp`"):
            with self.subTest(text):
                self.assertEqual(len(self.faults(text, CMakeLists="")), 1)

    def test_of_an_installation_may_be_absent(self):
        self.assertEqual(self.faults("`tests/none.py`"), [])


class Commands(Pages):
    def said(self, page, mode):
        with tempfile.TemporaryDirectory() as root:
            os.mkdir(os.path.join(root, "tests"))
            for name, text in (("CMakeLists.txt", ""), ("tests/run.py", "#!/usr/bin/python3\n"), ("README.md", page)):
                with open(os.path.join(root, name), "w", encoding="utf-8") as file:
                    file.write(text)
            os.chmod(os.path.join(root, "tests/run.py"), mode)
            return list(links.faults(root))

    def test_are_scripts_that_may_be_executed(self):
        for page, line in (
            ("`tests/run.py BIN`", 1),
            ("| a |\n| `tests/run.py BIN` |", 2),
            ("text\n\n```\ntests/run.py \\\n  BIN\n```", 4),
            ("text\n\n    tests/run.py BIN\n", 3),
        ):
            with self.subTest(page):
                self.assertEqual(self.said(page, 0o755), [])
                fault = "tests/run.py: may not be executed; git update-index --chmod=+x tests/run.py"
                self.assertEqual(self.said(page, 0o644), [f"README.md:{line}: {fault}"])

    def test_are_not_names_and_arguments(self):
        for page in ("`tests/run.py`", "`python3 tests/run.py BIN`", "tests/run.py BIN"):
            with self.subTest(page):
                self.assertEqual(self.said(page, 0o644), [])


class Lengths(Pages):
    def test_of_the_readme_count_tables_and_code(self):
        self.assertEqual(self.faults("a\n" * 200), [])
        self.assertEqual(len(self.faults("a\n" * 201)), 1)
        for line in ("x", "| x", "    x"):
            self.assertEqual(self.faults(line + "é" * (120 - len(line))), [])
            self.assertEqual(len(self.faults(line + "é" * (121 - len(line)))), 1)

    def test_of_other_pages_do_not(self):
        wide = "x" * 141
        self.assertEqual(self.faults("", **{"docs/page": f"{wide}\n" * 10}), [])
        self.assertEqual(len(self.faults("", **{"docs/page": f"{wide}\n" * 11})), 1)
        for text in (f"| {wide} |\n" * 20, "```\n" + f"{wide}\n" * 20 + "```\n", "\n" + f"    {wide}\n" * 20):
            self.assertEqual(self.faults("", **{"docs/page": text}), [])


if __name__ == "__main__":
    unittest.main()
