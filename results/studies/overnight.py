#!/usr/bin/python3
"""Makes every study in turn, cheap ones first, and goes on where it was after an interruption.

overnight.py BIN FOLDER [STUDY ...]        only these, and those that they read

The campaigns of a study are in FOLDER/NAME; FOLDER/NAME/made says that it ended well, so that the next call leaves it.
Points that take hours are among them. Ends with 0 when all ended well, with 1 when one did not, with 130 when it was
interrupted; says then what remains.
"""
import argparse
import json
import math
import os
import signal
import subprocess
import sys
from pathlib import Path

RESULTS = Path(__file__).resolve().parents[1]
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


def hours_of(results, name):
    """Processor time of the study when it was last made; None before."""
    found = results / name / "study.json"
    return json.loads(found.read_text())["processor_hours"] if found.exists() else None


def depth(name):
    """Over how many others a study stands."""
    return max((1 + depth(read) for read in READ.get(name, ())), default=0)


def studies_of(results):
    """Names and hours, the cheapest first, but after those that they read."""
    hours = {path.parent.name: hours_of(results, path.parent.name) for path in sorted(results.glob("*/study.py"))}

    def longest(name):
        own = math.inf if hours.get(name) is None else hours[name]
        return max([own, *(longest(read) for read in READ.get(name, ()) if read in hours)])

    return sorted(hours.items(), key=lambda study: (longest(study[0]), depth(study[0])))


def with_those_they_read(names):
    return {*names, *(read for name in names for read in with_those_they_read(READ.get(name, ())))}


def said_hours(studies):
    known = sum(hours for _, hours in studies if hours is not None)
    unknown = [name for name, hours in studies if hours is None]
    return f"{known:.2g} h of processor time" + (f" and an unknown one for {', '.join(unknown)}" if unknown else "")


def remaining(studies, folder):
    return [(name, hours) for name, hours in studies if not (folder / name / "made").exists()]


def say_what_remains(left):
    if left:
        print(
            f"remain: {', '.join(name for name, _ in left)}: {said_hours(left)}; the same command goes on", flush=True
        )


def make(results, binaries, folder, name):
    """The exit code of the study's driver. An interruption reaches all of its processes, which keep checkpoints."""
    place = folder / name
    place.mkdir(parents=True, exist_ok=True)
    command = ["/usr/bin/python3", str(results / name / "study.py"), str(binaries), str(place), "--long"]
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


def make_all(results, binaries, folder, names=()):
    wanted = with_those_they_read(names)
    studies = [study for study in studies_of(results) if not names or study[0] in wanted]
    left = remaining(studies, folder)
    print(f"{len(left)} of {len(studies)} studies are to be made: {said_hours(left)}", flush=True)
    failed = []
    for k, (name, hours) in enumerate(left):
        print(f"\n== {k + 1} of {len(left)}: {name}, {said_hours([(name, hours)])}", flush=True)
        try:
            code = make(results, binaries, folder, name)
        except KeyboardInterrupt:
            say_what_remains(left[k:])
            return 130
        if code != 0:
            failed.append((name, hours))
            print(f"== {name} ended with {code}", flush=True)
    print(f"\n{len(left) - len(failed)} of {len(left)} ended well", flush=True)
    say_what_remains(failed)
    return 1 if failed else 0


def interrupted(*_):
    raise KeyboardInterrupt


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("binaries", help="folder of peclet and peclet-engine", type=Path)
    parser.add_argument("folder", help="of the campaigns; a second call goes on with it", type=Path)
    known = sorted(name for name, _ in studies_of(RESULTS))
    parser.add_argument("studies", help="these alone, and those that they read", nargs="*", metavar="STUDY")
    arguments = parser.parse_args()
    for name in arguments.studies:
        if name not in known:
            parser.error(f"{name}: must be one of: {', '.join(known)}")
    if not os.access(RESULTS, os.W_OK):
        parser.error(
            f"{RESULTS}: whole studies write their tables there, and may not; copy the folder, and name the copy: "
            "peclet study --results COPY"
        )
    signal.signal(signal.SIGTERM, interrupted)
    sys.exit(make_all(RESULTS, arguments.binaries.absolute(), arguments.folder.absolute(), arguments.studies))


if __name__ == "__main__":
    main()
