#!/usr/bin/python3
"""english.py [--source FOLDER]

Checks what a machine can see of the rules for comments and pages:

comment   does not begin with a word that continues the name below it, or leaves its subject open
word      is none of those that puzzle readers
sentence  of a page has at most 45 words
key       that a page names as a JSON pointer is in a schema
function  in the walk of docs/architecture.md is in the file beside it
"""
import argparse
import json
import os
import re
import sys

SOURCE = os.path.abspath(os.path.join(os.path.dirname(__file__), "..", ".."))
CODE = ("contract", "engine", "runner", "schema", "adapters", "python", "results", "tests")
PAGES = ("README.md", "CHANGELOG.md", "CONTRIBUTING.md", "docs", "engine", "runner", "schema", "results", "tests")
MOST_WORDS = 45
FOLDERS = ("tmp", "usr", "proc", "dev", "var", "scratch", "home", "etc")  # of Unix, which look like pointers

OPENING = re.compile(
    r"(Of|That|Those|The same|Likewise|Whose|Who|Whoever|Nobody|Nothing|None|So|As (?:much|many)|Also|And|But|Which"
    r"|What|False:|True:)\b"
)
PUZZLE = re.compile(
    r"\b(whoever|nobody|somebody|in vain|is none that|comes? and goe?s?|to and fro|foretells?|so many|that much)\b",
    re.IGNORECASE,
)
POINTER = re.compile(r"`(/[a-z_]+(?:/[a-z_*]+)*)`")


def files(source, tops, endings):
    """Yields the paths of files with these endings, below folders or named themselves."""
    for top in tops:
        if os.path.isfile(os.path.join(source, top)):
            yield top
        for folder, folders, names in os.walk(os.path.join(source, top)):
            folders[:] = sorted(name for name in folders if not name.startswith((".", "__")))
            for name in sorted(names):
                if name.endswith(endings):
                    yield os.path.relpath(os.path.join(folder, name), source)


def read(source, path):
    with open(os.path.join(source, path), encoding="utf-8") as file:
        return file.read()


def comments(text, mark):
    """Yields each block of comment lines: the number of its first line, and its words."""
    block, begin = [], 0
    for number, line in enumerate([*text.splitlines(), ""], 1):
        stripped = line.strip()
        if stripped.startswith(mark):
            begin = begin or number
            block.append(stripped.lstrip("/#!<- ").strip())
        elif block:
            yield begin, " ".join(block)
            block, begin = [], 0


def faults_of_comments(source):
    for path in files(source, CODE, (".h", ".cpp", ".js", ".py", ".sql")):
        mark = {".py": "#", ".sql": "--"}.get(os.path.splitext(path)[1], "//")
        for number, words in comments(read(source, path), mark):
            if found := OPENING.match(words):
                yield f'{path}:{number}: a comment begins with "{found[0]}"'
            if found := PUZZLE.search(words):
                yield f'{path}:{number}: "{found[0]}" in a comment'


def prose(text):
    """Yields the paragraphs of a page without code, tables and headings: first line number, words."""
    text = re.sub(r"```.*?```", lambda block: "\n" * block[0].count("\n"), text, flags=re.DOTALL)
    block, begin = [], 0
    for number, line in enumerate([*text.splitlines(), ""], 1):
        stripped = line.strip()
        if stripped and not stripped.startswith(("|", "#", "<", "    ", "$$")):
            if re.match(r"([-*]|\d+\.) ", stripped) and block:
                yield begin, " ".join(block)
                block, begin = [], 0
            begin = begin or number
            block.append(stripped)
        elif block:
            yield begin, " ".join(block)
            block, begin = [], 0


def faults_of_pages(source):
    for path in files(source, PAGES, ".md"):
        for number, paragraph in prose(read(source, path)):
            paragraph = re.sub(r"\]\([^)]*\)|`[^`]*`|\$[^$]*\$", " x ", paragraph)
            for sentence in re.split(r"(?<=[.!?:;])\s+", paragraph):
                if len(sentence.split()) > MOST_WORDS:
                    yield f"{path}:{number}: a sentence of {len(sentence.split())} words: {sentence[:60]}..."
            if found := PUZZLE.search(paragraph):
                yield f'{path}:{number}: "{found[0]}" on a page'


def pointers(schema, at=""):
    """Yields the JSON pointers of all keys below a schema."""
    for name, below in schema.get("properties", {}).items():
        yield f"{at}/{name}"
        yield from pointers(below, f"{at}/{name}")
    for below in (*schema.get("oneOf", ()), *schema.get("anyOf", ())):
        yield from pointers(below, at)
    if isinstance(schema.get("items"), dict):
        yield f"{at}/*"
        yield from pointers(schema["items"], f"{at}/*")


def faults_of_keys(source):
    known = set()
    for path in files(source, ("schema",), ".schema.json"):
        known.update(pointers(json.loads(read(source, path))))
    for path in files(source, ("README.md", "docs"), ".md"):
        for number, line in enumerate(read(source, path).splitlines(), 1):
            for pointer in POINTER.findall(line):
                if pointer not in known and pointer.split("/")[1] not in FOLDERS:
                    yield f"{path}:{number}: {pointer} is in no schema"


def faults_of_walk(source):
    page = "docs/architecture.md"
    for number, line in enumerate(read(source, page).splitlines(), 1):
        cells = [re.findall(r"`([^`]+)`", cell) for cell in line.split("|")[1:-1]]
        if len(cells) == 3 and cells[1] and "/" in cells[1][0]:
            text = "".join(read(source, path) for path in cells[1])
            for name in cells[2]:
                if not re.search(rf"\b{name}\(", text):
                    yield f"{page}:{number}: {name}() is not in {', '.join(cells[1])}"


def faults_in(source):
    for check in (faults_of_comments, faults_of_pages, faults_of_keys, faults_of_walk):
        yield from check(source)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--source", default=SOURCE, help="another checkout")
    faults = list(faults_in(parser.parse_args().source))
    for fault in faults:
        print(fault)
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
