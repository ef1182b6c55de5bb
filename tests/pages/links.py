#!/usr/bin/python3
"""links.py [ROOT]: checks relative links and lengths of all pages below ROOT, by default the source.

    links      the file exists; the anchor is that of one of its headings
    `paths`    in code spans, from the folders of the source: the file exists (installations lack some);
               a script that begins a span or a line of code with its arguments is executable
    README.md  at most 200 lines of at most 120 characters, tables and code included
    .md        at most ten lines of more than 140 characters outside tables and code

Prints one line per fault with its place, and exits with 1 if there is any. Ignores links to other hosts.
"""
import os
import re
import stat
import sys
import urllib.parse

README_LINES, README_WIDTH = 200, 120
PAGE_WIDTH, WIDE_LINES = 140, 10
NOT_OURS = {".git", "build", "node_modules", "__pycache__"}

FENCE = re.compile(r"\s*(```+|~~~+)")
HEADING = re.compile(r"(#{1,6})\s+(.*?)\s*#*$")
# [text](target "title"); the text may hold an image, the target a pair of parentheses.
INLINE = re.compile(
    r"\[(?:[^\[\]]|\[[^\]]*\](?:\([^()]*\))?)*\]"
    r"\(\s*<?([^()\s<>]*(?:\([^()]*\)[^()\s<>]*)*)>?(?:\s+[\"'][^\"']*[\"'])?\s*\)"
)
IMAGE_IN_LINK = re.compile(r"!\[[^\[\]]*\]\(\s*<?([^()\s<>]+)>?\s*\)")
REFERENCE = re.compile(r"^ {0,3}\[[^\]]+\]:\s*<?([^\s>]+)>?", re.MULTILINE)
HTML = re.compile(r"<(?:a|img)\b[^>]*?(?:href|src)=[\"']([^\"']+)[\"']", re.IGNORECASE)
EXPLICIT = re.compile(r"<a\b[^>]*?(?:id|name)=[\"']([^\"']+)[\"']", re.IGNORECASE)
OWN_FILE = re.compile(
    r"(?:adapters|cmake|contract|docs|engine|results|runner|schema|templates|tests)/[\w./-]*\w\.[a-z]{1,5}"
)
CODE_SPAN = re.compile(r"(`+)(?:(?!\n\n).)+?(?<!`)\1(?!`)", re.DOTALL)


def pages(root):
    for folder, below, files in os.walk(root):
        below[:] = sorted(name for name in below if name not in NOT_OURS and not name.endswith(".peclet"))
        yield from (os.path.join(folder, name) for name in sorted(files) if name.endswith(".md"))


def prose(text):
    """Yields the lines outside fenced and indented code, with their numbers."""
    fence, blank_before = None, True
    for number, line in enumerate(text.split("\n"), 1):
        mark = FENCE.match(line)
        if fence:
            if mark and mark[1].startswith(fence):
                fence = None
        elif mark:
            fence = mark[1]
        elif not (blank_before and re.match(r"(    |\t)(?!\s*([-*+]|\d+\.)\s)", line)):
            yield number, line
            blank_before = not line.strip()
        # An indented block ends at a line without indent, so blank_before stays.


def anchors(text):
    """Returns GitHub's anchors of headings: lower case, no punctuation, hyphens, numbered repetitions."""
    found = set()
    for _, line in prose(text):
        found.update(EXPLICIT.findall(line))
        heading = HEADING.match(line)
        if not heading:
            continue
        words = re.sub(r"!?\[([^\]]*)\]\([^)]*\)", r"\1", heading[2]).replace("`", "").lower()
        base = re.sub(r"[^\w\- ]", "", words).replace(" ", "-")
        name, repetition = base, 0
        while name in found:
            repetition += 1
            name = f"{base}-{repetition}"
        found.add(name)
    return found


def joined(text):
    """Returns the prose with blank lines in place of code; links and spans may extend over lines."""
    lines = dict(prose(text))
    return "\n".join(lines.get(number, "") for number in range(1, max(lines, default=0) + 1))


def links(text):
    """Yields (line, target) of every link."""
    whole = CODE_SPAN.sub(lambda span: re.sub(r"[^\n]", " ", span[0]), joined(text))
    for pattern in (INLINE, IMAGE_IN_LINK, REFERENCE, HTML):
        for found in pattern.finditer(whole):
            yield whole.count("\n", 0, found.start()) + 1, found[1]


def read(path):
    with open(path, encoding="utf-8") as file:
        return file.read()


def link_faults(path, text):
    for number, target in sorted(set(links(text))):
        if re.match(r"[a-zA-Z][a-zA-Z0-9+.-]*:|//", target):
            continue
        name, _, anchor = target.partition("#")
        goal = os.path.normpath(os.path.join(os.path.dirname(path), urllib.parse.unquote(name))) if name else path
        if name.startswith("/"):
            yield number, f"{target}: begins with /, which is no place beside the page"
        elif not os.path.exists(goal):
            yield number, f"{target}: there is no such file"
        elif anchor and goal.endswith(".md") and urllib.parse.unquote(anchor) not in anchors(read(goal)):
            yield number, f"{target}: no heading of that page has this anchor"


def path_faults(root, text):
    whole = joined(text)
    for span in CODE_SPAN.finditer(whole):
        for word in span[0].strip("`").split():
            if OWN_FILE.fullmatch(word) and not os.path.exists(os.path.join(root, word)):
                yield whole.count("\n", 0, span.start()) + 1, f"{word}: there is no such file in the source"


def commands(text):
    """Yields (line, command) of every code span, and of every line of fenced and indented code."""
    whole = joined(text)
    for span in CODE_SPAN.finditer(whole):
        yield whole.count("\n", 0, span.start()) + 1, span[0].strip("`")
    outside = dict(prose(text))
    for number, line in enumerate(text.split("\n"), 1):
        if number not in outside:
            yield number, line


def is_script(path):
    if not os.path.isfile(path):
        return False
    with open(path, "rb") as file:
        return file.read(2) == b"#!"


def command_faults(root, text):
    for number, command in commands(text):
        word, *arguments = command.split() or [""]
        path = os.path.join(root, word)
        # Not os.access(), which answers differently for root.
        if arguments and OWN_FILE.fullmatch(word) and is_script(path) and not os.stat(path).st_mode & stat.S_IXOTH:
            yield number, f"{word}: may not be executed; git update-index --chmod=+x {word}"


def readme_faults(text):
    lines = text.rstrip("\n").split("\n")
    if len(lines) > README_LINES:
        yield len(lines), f"{len(lines)} lines; at most {README_LINES}, the rest belongs to docs/"
    for number, line in enumerate(lines, 1):
        if len(line) > README_WIDTH:
            yield number, f"{len(line)} characters; at most {README_WIDTH}"


def width_faults(text):
    wide = [number for number, line in prose(text) if len(line) > PAGE_WIDTH and not line.lstrip().startswith("|")]
    if len(wide) > WIDE_LINES:
        yield wide[0], (
            f"{len(wide)} lines of more than {PAGE_WIDTH} characters outside tables and code, at most {WIDE_LINES}: "
            + ", ".join(map(str, wide))
        )


def faults(root):
    is_source = os.path.exists(os.path.join(root, "CMakeLists.txt"))
    for path in pages(root):
        text, name = read(path), os.path.relpath(path, root)
        of_readme = readme_faults(text) if name == "README.md" else ()
        # The changelog names files as they were then.
        is_of_source = is_source and name != "CHANGELOG.md"
        of_source = [*path_faults(root, text), *command_faults(root, text)] if is_of_source else ()
        for number, fault in [*link_faults(path, text), *of_source, *width_faults(text), *of_readme]:
            yield f"{name}:{number}: {fault}"


def main():
    root = sys.argv[1] if len(sys.argv) > 1 else os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")
    root = os.path.abspath(root)
    count = sum(1 for _ in pages(root))
    found = list(faults(root))
    for fault in found:
        print(fault)
    if not count:
        sys.exit(f"{root}: has no pages")
    print(f"{count} pages, {len(found)} faults")
    sys.exit(1 if found else 0)


if __name__ == "__main__":
    main()
