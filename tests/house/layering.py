#!/usr/bin/python3
"""layering.py [--picture FILE.svg]      may every folder include what it includes?

A folder may include those before it in its list below, and itself. An include that runs upward is an error; so are a
folder of the lists that has no file, a file of more than 600 lines and a folder of more than 60 files, which hide a
second subject. Lines and files count in tests, too, in Python as in C++. SQL stands in runner/store alone. --picture
draws the folders and their includes (needs graphviz).
"""
import argparse
import collections
import os
import re
import subprocess
import sys

SOURCE = os.path.abspath(os.path.join(os.path.dirname(__file__), "..", ".."))

# From below to above.
RUNNER = [
    "contract",
    *(
        "runner/" + room
        for room in (
            "text",
            "campaign",
            "statistics",
            "store",
            "engines",
            "events",
            "owner",
            "requests",
            "batch",
            "care",
            "reports",
            "page",
            "live",
            "figure",
            "jamming",
            "archive",
            "verbs",
            "command_line",
        )
    ),
]
ENGINE = [
    "contract",
    *(
        "engine/" + room
        for room in (
            "document",
            "threads",
            "state",
            "gsd",
            "snapshots",
            "pictures",
            "flow",
            "random",
            "terms",
            "scene",
            "sizes",
            "kernels/lanes",
            "kernels/bodies",
            "kernels/pairs",
            "kernels/links",
            "kernels",
            "stability",
            "integrators",
            "start",
            "observables",
            "realisation",
            "output",
            "jobs",
            "evaluation",
        )
    ),
    "engine",
]
LAYERS = {"engine": ENGINE, "runner": RUNNER}
MOST_LINES, MOST_FILES = 600, 60
CXX, WRITTEN_BY_HAND = (".h", ".cpp", ".in"), (".h", ".cpp", ".in", ".py")
SQL = re.compile(r'"(?:SELECT|INSERT|REPLACE|UPDATE|DELETE FROM|PRAGMA|CREATE) ')
INCLUDE = re.compile(r'\s*#\s*include\s+"((?:contract|engine|runner)/[^"]+)"')


def sources(source, top, endings=CXX):
    """Paths of files below a folder, unless told otherwise of C++."""
    for folder, _, names in os.walk(os.path.join(source, top)):
        for name in sorted(names):
            if name.endswith(endings):
                yield os.path.relpath(os.path.join(folder, name), source)


def includes(source, top):
    """Of every file below a folder: path, line number, path that it includes."""
    for path in sources(source, top):
        with open(os.path.join(source, path), encoding="utf-8") as f:
            for number, line in enumerate(f, 1):
                found = INCLUDE.match(line)
                if found:
                    yield path, number, found[1]


def upward(source):
    for top, layers in LAYERS.items():
        place = {layer: i for i, layer in enumerate(layers)}
        for path, number, included in includes(source, top):
            here, there = os.path.dirname(path), os.path.dirname(included)
            if here not in place:
                yield f"{path}: its folder has no place in the list of layers"
            elif there not in place:
                yield f"{path}:{number}: {included}: {there} is no layer that {top} may include"
            elif place[there] > place[here]:
                yield f"{path}:{number}: {included}: {here} may not include {there}, which is above it"


def absent(source):
    """Else a check of another place, or of a folder that was renamed, would find nothing to say."""
    for top, layers in LAYERS.items():
        for layer in layers:
            if not any(os.path.dirname(path) == layer for path in sources(source, layer)):
                yield f"{layer}: is a layer of {top} without a file"


def too_large(source):
    for top in ("contract", "engine", "runner", "tests"):
        files = collections.Counter()
        for path in sources(source, top, WRITTEN_BY_HAND):
            files[os.path.dirname(path)] += 1
            with open(os.path.join(source, path), encoding="utf-8") as f:
                lines = sum(1 for _ in f)
            if lines > MOST_LINES:
                yield f"{path}: {lines} lines; at most {MOST_LINES}"
        for folder, count in files.items():
            if count > MOST_FILES:
                yield f"{folder}: {count} files; at most {MOST_FILES}"


def sql_elsewhere(source):
    """Statements outside of the folder that knows the tables."""
    for path in sources(source, "runner"):
        if os.path.dirname(path) == "runner/store":
            continue
        with open(os.path.join(source, path), encoding="utf-8") as f:
            for number, line in enumerate(f, 1):
                if SQL.search(line):
                    yield f"{path}:{number}: SQL outside of runner/store"


def picture(source):
    """The folders from below to above and their includes, for dot."""
    text = (
        'digraph layers {\n  node [shape=box, style=filled, fillcolor="#eef3f8", fontname="sans"]; '
        'edge [color="#7090b0"];\n'
    )
    for top, layers in LAYERS.items():
        between = collections.Counter(
            (os.path.dirname(path), os.path.dirname(included)) for path, _, included in includes(source, top)
        )
        for folder in layers:
            count = sum(1 for path in sources(source, folder) if os.path.dirname(path) == folder)
            text += f'  "{folder}" [label="{folder}\\n{count} files"];\n'
        for (here, there), count in sorted(between.items()):
            if here != there:
                text += f'  "{here}" -> "{there}" [penwidth={1 + min(count, 40) / 10:.1f}];\n'
    return text + "}\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--picture", metavar="FILE.svg")
    parser.add_argument("--source", default=SOURCE, help="another checkout")
    arguments = parser.parse_args()
    if arguments.picture:
        kind = os.path.splitext(arguments.picture)[1][1:]
        subprocess.run(
            ["dot", f"-T{kind}", "-o", arguments.picture], input=picture(arguments.source), text=True, check=True
        )
    checks = (absent, upward, too_large, sql_elsewhere)
    faults = [fault for check in checks for fault in check(arguments.source)]
    for fault in faults:
        print(fault)
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
