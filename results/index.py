#!/usr/bin/python3
"""index.py [--check]: writes README.md of this folder, the index of the studies, from their pages.

With --check writes nothing, and exits with 1 if the index is not that of the pages.
"""
import json
import re
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
LONGEST = 190  # characters of an answer
HEAD = """# Studies

Each page begins with its question, its picture and its answer. [How studies are repeated and
judged, and what their symbols mean](../docs/studies.md); [the published statements](../docs/statements.md) one by one.
*Hours* are the processor hours that the numbers of the study took; – where a page has no such count.

<!-- written by index.py -->
"""


def found_in(page, pattern, what):
    """Returns the group of a pattern in a page as one line; exits if the page lacks it."""
    found = re.search(pattern, page.read_text(), re.DOTALL)
    if found is None:
        sys.exit(f"{page}: has no {what}")
    return " ".join(found[1].split())


def without_links(text):
    return re.sub(r"\[([^]]*)\]\([^)]*\)", r"\1", text)


def first_sentences(text):
    """Returns as many sentences as fit, one at least; a colon before a table ends as a full stop."""
    sentences = re.split(r"(?<=[.!?:;]) (?=[A-Z])", text)
    answer = sentences[0]
    for sentence in sentences[1:]:
        if len(answer) + 1 + len(sentence) > LONGEST:
            break
        answer += " " + sentence
    return re.sub(r"[:;]$", ".", answer)


def hours_of(folder):
    judged = folder / "study.json"
    hours = json.loads(judged.read_text()).get("processor_hours") if judged.is_file() else None
    return "–" if hours is None else f"{hours:.2g}"


def row_of(folder):
    page, name = folder / "README.md", folder.name
    picture = found_in(page, r"!\[[^]]*\]\(([^)]*)\)", "picture")
    question, answer = (
        without_links(found_in(page, rf"\*\*{what}\.\*\* (.*?)(?:\n\n|\Z)", what.lower()))
        for what in ("Question", "Answer")
    )
    image = f'<img src="{name}/{picture}" width="220" alt="">'
    links = f"| [{image}]({name}/README.md) | [{name}]({name}/README.md)"
    return f"{links} | {question} | {first_sentences(answer)} | {hours_of(folder)} |\n"


def has_statements(folder):
    judged = folder / "study.json"
    return judged.is_file() and any(row["kind"] == "statement" for row in json.loads(judged.read_text())["statements"])


def index():
    folders = sorted(page.parent for page in HERE.glob("*/README.md"))
    text = HEAD
    for title, of_print in (("What is in print", True), ("Our own methods", False)):
        text += f"\n## {title}\n\n| | study | question | answer | hours |\n|---|---|---|---|---|\n"
        text += "".join(row_of(folder) for folder in folders if has_statements(folder) == of_print)
    return text


def main():
    path, text = HERE / "README.md", index()
    if sys.argv[1:] == ["--check"]:
        if path.read_text() != text:
            sys.exit(f"{path}: is not that of the pages: run {Path(__file__).name}")
    elif sys.argv[1:]:
        sys.exit(__doc__)
    else:
        path.write_text(text)


if __name__ == "__main__":
    main()
