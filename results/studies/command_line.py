"""The command line of the drivers of studies."""
import argparse
import datetime
import json
import os
import platform
import sys
import tempfile

from peclet.program import PecletError

from studies.campaigns import Program
from studies.verdicts import rewrite, tables_of, verdict


def processor():
    with open("/proc/cpuinfo") as f:
        names = [line.split(":", 1)[1].strip() for line in f if line.startswith("model name")]
    return names[0] if names else platform.processor()


def read_arguments(folder, title, from_table):
    """Returns the arguments of the driver in `folder`; `from_table` is true if it can judge its tables alone."""
    parser = argparse.ArgumentParser(description=title)
    parser.add_argument("binaries", help="folder of peclet and peclet-engine", nargs="?")
    text = "folder of the campaigns, which a second call continues; a temporary one by default"
    parser.add_argument("folder", nargs="?", help=text)
    how = parser.add_mutually_exclusive_group()
    for form, text in (
        ("quick", "run half a minute; fails if the physics is wrong"),
        ("long", "include points that take hours, if the study has any; continues with FOLDER"),
        ("from-table", "judge the tables beside study.py, without running anything"),
    ):
        how.add_argument(f"--{form}", action="store_true", help=text)
    text = "N times as many seeds, for error bars smaller by the root of N; continues with FOLDER"
    parser.add_argument("--times", type=int, default=1, metavar="N", help=text)
    arguments = parser.parse_args()
    if arguments.times < 1:
        parser.error("--times: must be at least 1")
    if arguments.from_table and not from_table:
        parser.error("--from-table: the tables of this study do not have all that its rows are made of")
    if not arguments.binaries and not arguments.from_table:
        parser.error("binaries: missing; must be the folder of peclet and peclet-engine, or --from-table")
    if not arguments.quick and not os.access(folder, os.W_OK):
        # Reported before hours of work, not after them.
        parser.error(
            f"{folder}: cannot be written, and a study writes its table there; copy the folder above it, and run "
            f"COPY/{os.path.basename(folder)}/study.py"
        )
    return arguments


def provenance(program):
    """Returns the provenance of a study that was run now: cost, date, commits and processor."""
    return {
        "processor_hours": float(f"{program.processor_seconds / 3600:.2g}"),
        "date": datetime.date.today().isoformat(),
        "engine": sorted(program.commits),
        "machine": processor(),
    }


def earlier_provenance(path):
    """Returns the provenance in a study.json, that of the runs behind the tables."""
    with open(path) as f:
        found = json.load(f)
    return {name: found[name] for name in ("processor_hours", "date", "engine", "machine")}


def write_study(folder, title, rows, of_runs):
    """Writes study.json, and the rows into the study's README.md. `of_runs` is the provenance."""
    study = {"title": title, "verdict": verdict(rows), **of_runs, "statements": [row.as_json() for row in rows]}
    with open(os.path.join(folder, "study.json"), "w") as f:
        f.write(json.dumps(study, indent=1, ensure_ascii=False) + "\n")
    rewrite(os.path.join(folder, "README.md"), rows)


def with_program(arguments, run):
    """Returns run(program), and the Program of the arguments. Exits if a campaign fails."""
    with tempfile.TemporaryDirectory() as temporary:
        program = Program(arguments.binaries, arguments.folder or temporary)
        program.long, program.times = arguments.long, arguments.times
        try:
            return run(program), program
        except PecletError as error:
            sys.exit(str(error))


def quick(title, rows):
    """Prints the rows, and exits with 0 if every interval lies within its bounds, else with 1."""
    print(tables_of(rows))
    unsure = [row.text for row in rows if not (row.within() and row.sure())]
    for text in unsure:
        print(f"\nnot surely within its bounds: {text}")
    print(f"\n{title}: {len(rows) - len(unsure)} of {len(rows)}")
    sys.exit(1 if unsure else 0)


def main(folder, title, measure, quick_measure, judge=None, draw=None):
    """Runs a study from its command line.

    measure(program)          runs the complete study and writes its tables and its figure beside study.py; returns the
                              rows if there is no `judge`
    quick_measure(program)    runs for half a minute and returns rows, whose intervals must lie within their bounds; the
                              tests call it
    judge()                   returns the rows from the tables alone
    draw()                    draws the figure from the tables alone
    """
    arguments = read_arguments(folder, title, judge)
    if arguments.quick:
        quick(title, with_program(arguments, lambda program: list(quick_measure(program)))[0])
    if arguments.from_table:
        rows, of_runs = list(judge()), earlier_provenance(os.path.join(folder, "study.json"))
    else:
        found, program = with_program(arguments, lambda program: list(measure(program) or ()))
        rows, of_runs = list(judge() if judge else found), provenance(program)
    if draw:
        draw()
    print(tables_of(rows))
    print(f"\n{title}: {verdict(rows)}")
    write_study(folder, title, rows, of_runs)
