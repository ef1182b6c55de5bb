#!/usr/bin/python3
"""layering.py [--picture]

Checks the includes between rooms, the folders of engine/ and runner/. A room may include contract/ and the
rooms before it in add_rooms() of their CMakeLists.txt. Reports includes that run upward, circles of
headers, classes whose functions are in several files, SQL outside runner/store, and an outdated picture of
the rooms, which --picture draws again. A file of more than 600 lines is named on standard error, because
it may hide a second subject.
"""
import argparse
import collections
import os
import re
import sys

SOURCE = os.path.abspath(os.path.join(os.path.dirname(__file__), "..", ".."))
PROGRAMS = ("engine", "runner")
LONG = 600
PICTURE = "docs/pictures/rooms.svg"
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


def storeys(source, program):
    """Returns the rooms of a program by storey, from below, and their includes without those that others imply."""
    below = collections.defaultdict(set)
    for path, _, included in includes(source, program):
        below[os.path.dirname(path)].add(os.path.dirname(included))
    level, reach = {}, {}
    for room in layers(source, program):
        below[room] &= level.keys()  # rooms below; upward() reports others
        level[room] = 1 + max((level[other] for other in below[room]), default=-1)
        reach[room] = below[room].union(*(reach[other] for other in below[room]))
    shown = [room for room in level if any(os.path.dirname(path) == room for path in sources(source, room))]
    rows = [[room for room in shown if level[room] == storey] for storey in range(1 + max(level.values()))]
    direct = [
        (room, other)
        for room in shown
        for other in sorted(below[room])
        if not any(other in reach[between] for between in below[room])
    ]
    return rows, direct


def picture(source):
    """Returns an SVG picture of the rooms: each stands above those that it includes."""
    width, height, step, boxes, arrows = 118, 30, 74, [], []
    drawings = [storeys(source, program) for program in PROGRAMS]
    storey_count = max(len(rows) for rows, _ in drawings)
    left = 20
    for program, (rows, direct) in zip(PROGRAMS, drawings):
        span = max(len(row) for row in rows) * (width + 24)
        place = {}
        for storey, row in enumerate(rows):
            y = 20 + (storey_count - 1 - storey) * step
            for i, room in enumerate(row):
                x = left + span * (i + 0.5) / len(row)
                place[room] = (x, y)
                name = {program: f"{program}/main.cpp", "contract": "contract"}.get(room, room.split("/")[-1])
                boxes.append(
                    f'<rect x="{x - width / 2:g}" y="{y}" width="{width}" height="{height}" rx="4"/>'
                    f'<text x="{x:g}" y="{y + 20}">{name}</text>'
                )
        for room, other in direct:
            (x, y), (x_other, y_other) = place[room], place[other]
            arrows.append(f'<path d="M{x:g} {y + height}L{x_other:g} {y_other - 2}"/>')
        left += span + 30
    font = 'font-family="sans-serif" font-size="13" text-anchor="middle"'
    size = f'width="{left:g}" height="{storey_count * step}"'
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" {size} {font}>\n'
        '<defs><marker id="tip" markerWidth="8" markerHeight="8" refX="6" refY="3" orient="auto">'
        '<path d="M0 0L6 3L0 6Z" fill="#5878a0"/></marker></defs>\n'
        '<rect width="100%" height="100%" fill="white"/>\n'
        '<g stroke="#5878a0" marker-end="url(#tip)">' + "\n".join(arrows) + "</g>\n"
        '<g fill="#e8eff7" stroke="#5878a0">'
        + "\n".join(boxes).replace("<text", '<text fill="black" stroke="none"')
        + "</g>\n"
        "</svg>\n"
    )


def outdated(source):
    path = os.path.join(source, PICTURE)
    if not os.path.exists(path) or read(source, PICTURE) != picture(source):
        yield f"{PICTURE}: shows other rooms or includes; tests/house/layering.py --picture draws it again"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--picture", action="store_true", help=f"draw {PICTURE} again")
    parser.add_argument("--source", default=SOURCE, help="another checkout")
    arguments = parser.parse_args()
    if arguments.picture:
        path = os.path.join(arguments.source, PICTURE)
        os.makedirs(os.path.dirname(path), exist_ok=True)
        with open(path, "w", encoding="utf-8") as file:
            file.write(picture(arguments.source))
        return 0
    for remark in long_files(arguments.source):
        print(remark, file=sys.stderr)
    checks = (absent, upward, circles, scattered, sql_elsewhere, outdated)
    faults = [fault for check in checks for fault in check(arguments.source)]
    for fault in faults:
        print(fault)
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
