#!/usr/bin/python3
"""layering.py [--picture FILE.svg]

Checks the includes between rooms, the folders of engine/ and runner/. A room may include contract/ and the
rooms before it in add_rooms() of their CMakeLists.txt. Reports includes that run upward, circles of
headers, classes whose functions are in several files, and SQL outside runner/store. --picture draws the
rooms and their includes (needs graphviz). A file of more than 600 lines is named on standard error,
because it may hide a second subject.
"""
import argparse
import collections
import os
import re
import subprocess
import sys

SOURCE = os.path.abspath(os.path.join(os.path.dirname(__file__), "..", ".."))
PROGRAMS = ("engine", "runner")
LONG = 600
CXX = (".h", ".cpp", ".in")
ROOMS = re.compile(r'^add_rooms\(\w+\s+"[^"]*"\s+([^)]*)\)', re.MULTILINE)
SQL = re.compile(r'"(?:SELECT|INSERT|REPLACE|UPDATE|DELETE FROM|PRAGMA|CREATE) ')
INCLUDE = re.compile(r'\s*#\s*include\s+"((?:contract|engine|runner)/[^"]+)"')
MEMBER = re.compile(r"^(?=\w)(?!using |namespace |static |return )[\w:<>,&*\[\] ]*?\b([A-Z]\w*)::~?\w+\(", re.MULTILINE)


def read(source, path):
    with open(os.path.join(source, path), encoding="utf-8") as f:
        return f.read()


def layers(source, program):
    """Returns the folders of a program's files, from below to above."""
    rooms = ROOMS.search(read(source, f"{program}/CMakeLists.txt"))[1].split()
    return ["contract", *(f"{program}/{room}" for room in rooms), program]


def sources(source, top):
    """Yields the paths of the C++ files below a folder."""
    for folder, _, names in os.walk(os.path.join(source, top)):
        for name in sorted(names):
            if name.endswith(CXX):
                yield os.path.relpath(os.path.join(folder, name), source)


def includes(source, top):
    """Yields each include of our own files below a folder: path, line number, included path."""
    for path in sources(source, top):
        for number, line in enumerate(read(source, path).splitlines(), 1):
            found = INCLUDE.match(line)
            if found:
                yield path, number, found[1]


def upward(source):
    """Yields faults: includes of rooms above, and of folders that are not rooms."""
    for program in PROGRAMS:
        place = {layer: i for i, layer in enumerate(layers(source, program))}
        for path, number, included in includes(source, program):
            here, there = os.path.dirname(path), os.path.dirname(included)
            if here not in place:
                yield f"{path}: its folder is no room of {program}/CMakeLists.txt"
            elif there not in place:
                yield f"{path}:{number}: {included}: {there} is no layer that {program} may include"
            elif place[there] > place[here]:
                yield f"{path}:{number}: {included}: {here} may not include {there}, which is above it"


def absent(source):
    """Yields rooms without a file, whose other checks would pass unnoticed."""
    for program in PROGRAMS:
        for layer in layers(source, program)[:-1]:
            if not any(os.path.dirname(path) == layer for path in sources(source, layer)):
                yield f"{layer}: is a room without a file"


def circles(source):
    """Yields headers that include each other, by removing all others one after the other."""
    below = collections.defaultdict(set)
    for top in ("contract", *PROGRAMS):
        for path, _, included in includes(source, top):
            if path.endswith(".h"):
                below[path].add(included)
    while free := [path for path, headers in below.items() if not headers & below.keys()]:
        for path in free:
            del below[path]
    while ends := [path for path in below if not any(path in headers for headers in below.values())]:
        for path in ends:
            del below[path]
    for path in sorted(below):
        yield f"{path}: is in a circle of includes"


def scattered(source):
    """Yields classes whose functions are in several files."""
    for top in ("contract", *PROGRAMS):
        files = collections.defaultdict(set)
        for path in sources(source, top):
            if path.endswith(".cpp"):
                for name in MEMBER.findall(read(source, path)):
                    files[os.path.dirname(path), name].add(path)
        for (_, name), paths in sorted(files.items()):
            if len(paths) > 1:
                yield f"{name}: has functions in {', '.join(sorted(paths))}"


def sql_elsewhere(source):
    for path in sources(source, "runner"):
        if os.path.dirname(path) != "runner/store":
            for number, line in enumerate(read(source, path).splitlines(), 1):
                if SQL.search(line):
                    yield f"{path}:{number}: SQL outside of runner/store"


def long_files(source):
    for top in ("contract", *PROGRAMS):
        for path in sources(source, top):
            lines = read(source, path).count("\n")
            if lines > LONG:
                yield f"{path}: {lines} lines: it may have a second subject"


def picture(source):
    """Returns the rooms from below to above and their includes, for dot."""
    text = (
        'digraph rooms {\n  node [shape=box, style=filled, fillcolor="#eef3f8", fontname="sans"]; '
        'edge [color="#7090b0"];\n'
    )
    for program in PROGRAMS:
        between = collections.Counter(
            (os.path.dirname(path), os.path.dirname(included)) for path, _, included in includes(source, program)
        )
        for folder in layers(source, program):
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
    for remark in long_files(arguments.source):
        print(remark, file=sys.stderr)
    checks = (absent, upward, circles, scattered, sql_elsewhere)
    faults = [fault for check in checks for fault in check(arguments.source)]
    for fault in faults:
        print(fault)
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
