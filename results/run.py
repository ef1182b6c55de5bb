#!/usr/bin/python3
"""Lists the studies of published statements, makes one again, or all of them.

run.py                             all of them, with their verdicts
run.py NAME --quick                half a minute of one, which fails where the physics is broken
run.py NAME --folder FOLDER        one, whole: hours, which may be interrupted
run.py --overnight [NAME ...]      every one, or these and those that they read, cheap ones first

A study remakes published figures with error bars and answers each published statement with a number and a criterion
that can fail. The list shows what was found, when and at what cost, and which studies read tables that are newer than
their own.

With --overnight the campaigns of a study are in FOLDER/NAME; FOLDER/NAME/made says that it ended well, so that the next
call leaves it. Points that take hours are among them. Ends with 0 when all ended well, with 1 when one did not, with
130 when it was interrupted; says then what remains.
"""
import argparse
import json
import math
import os
import shutil
import signal
import subprocess
import sys
from pathlib import Path

RESULTS = Path(__file__).resolve().parent
# Studies whose rows read tables of others, which are made before.
# flow-curve reads at-rest, too, and that one it: `flow-curve/study.py --from-table` judges it again afterwards.
READ = {
    "at-rest": ("flow-curve",),
    "divergence": ("at-rest", "flow-curve", "zero-shear"),
    "flow-curve": ("literature", "zero-shear"),
    "friction-repulsion": ("literature",),
    "learned-rheology": ("inhomogeneous-flow",),
    "oscillation": ("at-rest",),
    "steady-state": ("zero-shear",),
}


def found_by(name):
    """What study.json of a study has; nothing before it was made."""
    path = RESULTS / name / "study.json"
    if not path.exists():
        return {}
    try:
        found = json.loads(path.read_text())
        for key in ("title", "verdict", "processor_hours", "date", "statements"):
            found[key]
    except (ValueError, KeyError, TypeError) as fault:
        sys.exit(f"{path}: is not what a study leaves: {fault!r}")
    return found


def summaries():
    """Of each study, in alphabetical order, what the list has."""
    found = {path.parent.name: found_by(path.parent.name) for path in sorted(RESULTS.glob("*/study.py"))}
    for name, study in found.items():
        rows = study.get("statements", [])
        statements, checks = ([row["answer"] for row in rows if row["kind"] == kind] for kind in ("statement", "check"))
        yield {
            "study": name,
            "title": study.get("title"),
            "verdict": study.get("verdict", "not yet"),
            "statements": len(statements),
            "statements_that_hold": statements.count("holds"),
            "checks": len(checks),
            "checks_passed": checks.count("ok"),
            "processor_hours": study.get("processor_hours"),
            "date": study.get("date"),
            "older_than": [
                read for read in READ.get(name, ()) if study and found.get(read) and found[read]["date"] > study["date"]
            ],
        }


def table(studies):
    rows = [("study", "verdict", "statements that hold", "checks passed", "CPU h", "made", "older than")]
    for study in studies:
        numbers = ["-"] * 4
        if study["date"]:
            counts = "{statements_that_hold} of {statements}", "{checks_passed} of {checks}", "{processor_hours:.2g}"
            numbers = [text.format(**study) for text in (*counts, "{date}")]
        rows.append((study["study"], study["verdict"], *numbers, ", ".join(study["older_than"])))
    widths = [max(map(len, column)) for column in zip(*rows)]
    return "\n".join(
        "  ".join(f"{cell:{side}{width}}" for cell, side, width in zip(row, "<<>>>><", widths)).rstrip() for row in rows
    )


def programs_of(chosen):
    """The folder of the programs: as given; of the installation or the source that this file is part of; of PATH."""
    in_path = shutil.which("peclet")
    found = [chosen] if chosen else [RESULTS.parents[2] / "bin", RESULTS.parent / "build" / "release" / "bin"]
    if in_path and not chosen:
        found.append(Path(in_path).parent)
    for folder in found:
        if (folder / "peclet-engine").exists():
            return folder.absolute()
    sys.exit(f"no peclet-engine in {', '.join(map(str, found))}: --programs must name the folder of the programs")


def in_turn(hours):
    """Returns names and hours, the cheapest first, but after those that they read."""

    def place(name):
        """The longest of those that it stands over and its own, and how many storeys these are."""
        own = math.inf if hours.get(name) is None else hours[name]
        below = [place(read) for read in READ.get(name, ()) if read in hours]
        return max([own, *(longest for longest, _ in below)]), max((1 + storeys for _, storeys in below), default=0)

    return sorted(hours.items(), key=lambda study: place(study[0]))


def with_those_they_read(names):
    return {*names, *(read for name in names for read in with_those_they_read(READ.get(name, ())))}


def said_hours(studies):
    known = sum(hours for _, hours in studies if hours is not None)
    unknown = [name for name, hours in studies if hours is None]
    return f"{known:.2g} h of processor time" + (f" and an unknown one for {', '.join(unknown)}" if unknown else "")


def say_what_remains(left):
    if left:
        print(
            f"remain: {', '.join(name for name, _ in left)}: {said_hours(left)}; the same command goes on", flush=True
        )


def make(programs, folder, name):
    """The exit code of the study's driver. An interruption reaches all of its processes, which keep checkpoints."""
    place = folder / name
    place.mkdir(parents=True, exist_ok=True)
    command = [sys.executable, str(RESULTS / name / "study.py"), str(programs), str(place), "--long"]
    driver = subprocess.Popen(command, start_new_session=True)
    try:
        code = driver.wait()
    except KeyboardInterrupt:
        os.killpg(driver.pid, signal.SIGINT)
        driver.wait()
        raise
    if code == 0:
        (place / "made").touch()
    return code


def make_all(hours, programs, folder, names):
    wanted = with_those_they_read(names)
    studies = [study for study in in_turn(hours) if not names or study[0] in wanted]
    left = [study for study in studies if not (folder / study[0] / "made").exists()]
    print(f"{len(left)} of {len(studies)} studies are to be made: {said_hours(left)}", flush=True)
    failed = []
    for k, (name, own) in enumerate(left):
        print(f"\n== {k + 1} of {len(left)}: {name}, {said_hours([(name, own)])}", flush=True)
        try:
            code = make(programs, folder, name)
        except KeyboardInterrupt:
            say_what_remains(left[k:])
            return 130
        if code != 0:
            failed.append((name, own))
            print(f"== {name} ended with {code}", flush=True)
    print(f"\n{len(left) - len(failed)} of {len(left)} ended well", flush=True)
    say_what_remains(failed)
    return 1 if failed else 0


def become_driver(name, arguments):
    """This process becomes the driver: signals and exit code are its own."""
    words = [sys.executable, str(RESULTS / name / "study.py"), str(programs_of(arguments.programs))]
    words += [str(arguments.folder.absolute())] if arguments.folder else []
    words += [f"--{form}" for form in ("quick", "long") if getattr(arguments, form)]
    words += ["--times", str(arguments.times)] if arguments.times > 1 else []
    os.execv(sys.executable, words)


def interrupted(*_):
    raise KeyboardInterrupt


def read_arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("studies", help="which; the list unless given", nargs="*", metavar="NAME")
    how = parser.add_mutually_exclusive_group()
    how.add_argument("--quick", action="store_true", help="half a minute of it")
    how.add_argument("--long", action="store_true", help="also the points that take hours, where the study has such")
    how.add_argument("--overnight", action="store_true", help="whole, one after the other; goes on where it was")
    how.add_argument("--json", action="store_true", help="the list, for programs")
    parser.add_argument("--times", type=int, default=1, metavar="N", help="N times as many seeds")
    parser.add_argument(
        "--folder",
        type=Path,
        help="of the campaigns, with which a second call goes on; temporary unless given, with --overnight studies",
    )
    parser.add_argument("--programs", type=Path, help="folder of peclet and peclet-engine")
    arguments = parser.parse_args()
    known = [path.parent.name for path in sorted(RESULTS.glob("*/study.py"))]
    for name in arguments.studies:
        if name not in known:
            parser.error(f"{name}: must be one of: {', '.join(known)}")
    if len(arguments.studies) > 1 and not arguments.overnight:
        parser.error("several studies are made with --overnight")
    if arguments.json and arguments.studies:
        parser.error("--json: is of the list")
    is_list = not arguments.studies and not arguments.overnight
    if is_list and (arguments.quick or arguments.long or arguments.folder or arguments.times != 1):
        parser.error("--quick, --long, --folder and --times must stand with a study")
    if arguments.overnight and not os.access(RESULTS, os.W_OK):
        parser.error(
            f"{RESULTS}: whole studies write their tables there, and may not; copy the folder, and run COPY/run.py"
        )
    return arguments


def main():
    arguments = read_arguments()
    if arguments.overnight:
        signal.signal(signal.SIGTERM, interrupted)
        hours = {study["study"]: study["processor_hours"] for study in summaries()}
        folder = (arguments.folder or Path("studies")).absolute()
        sys.exit(make_all(hours, programs_of(arguments.programs), folder, arguments.studies))
    if arguments.studies:
        become_driver(arguments.studies[0], arguments)
    studies = list(summaries())
    print(json.dumps({"schema_version": 1, "studies": studies}, indent=2) if arguments.json else table(studies))


if __name__ == "__main__":
    main()
