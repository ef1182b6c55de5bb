#!/usr/bin/python3
"""Lists the studies of published statements, or repeats one or all of them.

run.py                             lists all studies with their verdicts
run.py NAME --quick                runs half a minute of one; fails if the physics is wrong
run.py NAME --folder FOLDER        runs one completely: hours, which may be interrupted
run.py --overnight [NAME ...]      runs all, or these and the studies whose tables they read, cheap ones first

A study reproduces published figures with error bars, and tests each published statement by a number and a criterion
that can fail. The list shows the result of each study, its date and its cost, and the studies with older tables than
those that they read.

With --overnight the campaigns of a study are in FOLDER/NAME. The file FOLDER/NAME/made marks a finished study, which
the next call skips. Points that take hours are included. Exits with 0 if all studies succeed, 1 if one fails, 130 if
interrupted, and then lists what remains.
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
# Studies, and the studies whose tables they read and which run before them. flow-curve also reads at-rest, which reads
# flow-curve: `flow-curve/study.py --from-table` judges it again afterwards.
READ = {
    "at-rest": ("flow-curve", "zero-shear"),
    "convergence": ("flow-curve",),
    "divergence": ("at-rest", "flow-curve", "zero-shear"),
    "flow-curve": ("literature", "zero-shear"),
    "learned-rheology": ("inhomogeneous-flow",),
    "oscillation": ("at-rest",),
}


def found_by(name):
    """Returns the content of a study's study.json, or {} if there is none. Exits if the file lacks a key."""
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
    """Yields the entries of the list, a dictionary for each study, in alphabetical order."""
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
    """Returns the folder of the programs: the chosen one, or that of this installation or source tree, or of PATH."""
    in_path = shutil.which("peclet")
    found = [chosen] if chosen else [RESULTS.parents[2] / "bin", RESULTS.parent / "build" / "release" / "bin"]
    if in_path and not chosen:
        found.append(Path(in_path).parent)
    for folder in found:
        if (folder / "peclet-engine").exists():
            return folder.absolute()
    sys.exit(f"no peclet-engine in {', '.join(map(str, found))}: --programs must name the folder of the programs")


def in_turn(hours):
    """Returns names and hours, the cheapest first, but each after the studies that it reads."""

    def place(name):
        """Returns the longest hours among the study and those that it reads, and the depth of its reading."""
        own = math.inf if hours.get(name) is None else hours[name]
        below = [place(read) for read in READ.get(name, ()) if read in hours]
        return max([own, *(longest for longest, _ in below)]), max((1 + storeys for _, storeys in below), default=0)

    return sorted(hours.items(), key=lambda study: place(study[0]))


def with_those_they_read(names):
    """Returns the names, and those of all studies that they read, directly or indirectly."""
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
    """Runs a study and returns its exit code. An interrupt is sent to all of its processes, which write checkpoints."""
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
    """Runs the studies that have not been made, by name or all; returns the exit code of this program."""
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
    """Replaces this process by the driver of a study, which then gets its signals and gives the exit code."""
    words = [sys.executable, str(RESULTS / name / "study.py"), str(programs_of(arguments.programs))]
    words += [str(arguments.folder.absolute())] if arguments.folder else []
    words += [f"--{form}" for form in ("quick", "long") if getattr(arguments, form)]
    words += ["--times", str(arguments.times)] if arguments.times > 1 else []
    os.execv(sys.executable, words)


def interrupted(*_):
    raise KeyboardInterrupt


def read_arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("studies", help="studies to run; by default all are listed", nargs="*", metavar="NAME")
    how = parser.add_mutually_exclusive_group()
    how.add_argument("--quick", action="store_true", help="run half a minute of the study")
    how.add_argument("--long", action="store_true", help="include points that take hours, if the study has any")
    how.add_argument("--overnight", action="store_true", help="run complete studies in turn; continues earlier calls")
    how.add_argument("--json", action="store_true", help="print the list as JSON")
    parser.add_argument("--times", type=int, default=1, metavar="N", help="N times as many seeds")
    parser.add_argument(
        "--folder",
        type=Path,
        help="folder of the campaigns, which a second call continues; a temporary one by default, with --overnight "
        "studies",
    )
    parser.add_argument("--programs", type=Path, help="folder of peclet and peclet-engine")
    arguments = parser.parse_args()
    known = [path.parent.name for path in sorted(RESULTS.glob("*/study.py"))]
    for name in arguments.studies:
        if name not in known:
            parser.error(f"{name}: must be one of: {', '.join(known)}")
    if len(arguments.studies) > 1 and not arguments.overnight:
        parser.error("several studies need --overnight")
    if arguments.json and arguments.studies:
        parser.error("--json: prints the list, and must stand without a study")
    is_list = not arguments.studies and not arguments.overnight
    if is_list and (arguments.quick or arguments.long or arguments.folder or arguments.times != 1):
        parser.error("--quick, --long, --folder and --times must stand with a study")
    if arguments.overnight and not os.access(RESULTS, os.W_OK):
        parser.error(
            f"{RESULTS}: cannot be written, and studies write their tables there; copy the folder, and run COPY/run.py"
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
