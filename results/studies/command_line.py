"""The command lines of the drivers."""
import argparse
import datetime
import json
import os
import platform
import sys
import tempfile

from studies.campaigns import Program
from studies.verdicts import verdict


def processor():
    with open("/proc/cpuinfo") as f:
        names = [line.split(":", 1)[1].strip() for line in f if line.startswith("model name")]
    return names[0] if names else platform.processor()


def read_arguments(folder, title):
    parser = argparse.ArgumentParser(description=title)
    parser.add_argument("binaries", help="folder of peclet and peclet-engine")
    parser.add_argument(
        "folder", nargs="?", help="of the campaigns, with which a second call goes on; a temporary one unless given"
    )
    parser.add_argument("--quick", action="store_true", help="half a minute; fails where the physics is broken")
    parser.add_argument(
        "--long",
        action="store_true",
        help="also the points that take hours, where the study has such; goes on with FOLDER",
    )
    parser.add_argument(
        "--times",
        type=int,
        default=1,
        metavar="N",
        help="N times as many seeds everywhere, for error bars smaller by the root of N; goes on with FOLDER",
    )
    arguments = parser.parse_args()
    if arguments.times < 1:
        parser.error("--times: must be at least 1")
    if not arguments.quick and not os.access(folder, os.W_OK):
        # Said before hours of work, not after them.
        parser.error(
            f"{folder}: a whole study writes its table there, and may not; copy the folder above it, and name the "
            "copy: peclet study --results COPY"
        )
    return arguments


def study_as_json(title, found, statements, program):
    return {
        "title": title,
        "verdict": found,
        "processor_hours": float(f"{program.processor_seconds / 3600:.2g}"),
        "date": datetime.date.today().isoformat(),
        "engine": sorted(program.commits),
        "machine": processor(),
        "statements": [s.as_json() for s in statements],
    }


def main(folder, title, measure, quick_measure):
    """The command line of a study. measure(program) runs it whole, writes its table and picture beside study.py and
    returns its statements; quick_measure(program) is a version of half a minute, whose statements must all hold: the
    tests run it."""
    arguments = read_arguments(folder, title)
    with tempfile.TemporaryDirectory() as temporary:
        program = Program(arguments.binaries, arguments.folder or temporary)
        program.long, program.times = arguments.long, arguments.times
        statements = list((quick_measure if arguments.quick else measure)(program))
    print("| statement | source | value ± standard error | must be | answer |\n|---|---|---|---|---|")
    for statement in statements:
        print(statement.row())
    found = verdict(statements)
    print(f"\n{title}: {found}")
    if arguments.quick:
        sys.exit(0 if found == "holds" else 1)
    with open(os.path.join(folder, "study.json"), "w") as f:
        json.dump(study_as_json(title, found, statements, program), f, indent=1, ensure_ascii=False)
        f.write("\n")


def drive(description, panels, remake):
    """Reads the command line of a study that is a table of panels, and calls remake(arguments, folder)."""
    parser = argparse.ArgumentParser(description=description)
    parser.add_argument("binaries")
    parser.add_argument("folder", nargs="?", help="of the campaigns; a temporary one unless given")
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--panel", choices=panels, help="this one alone, into the folder")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as temporary:
        remake(arguments, arguments.folder or temporary)
