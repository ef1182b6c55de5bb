#!/usr/bin/python3
"""fault_drill.py BIN [--quick] [--case NAME ...] [--seed 1] [--every-allocation] [--list]

Runs campaigns, disturbs them as programs that run for weeks are disturbed, runs them to their end, and
compares them with an undisturbed run by one worker. Prints a table: the fault, the number of tries,
acknowledged results lost, results counted twice, canonical exports that differ, other faults (a wrong exit
code, a damaged database, a seed blamed wrongly), and seconds. All faults must be zero, otherwise the exit
code is 1. A result is acknowledged when its spool file is complete or it is committed.

BIN holds peclet, peclet-engine, fake_engine and fault_shim.so. --quick is the part that runs with the tests.
"""
import argparse
import os
import random
import shutil
import signal
import sys
import tempfile
import time
import traceback

from drill import cases
from drill.campaign import Lab
from drill.tally import Tally

HEADINGS = ["fault", "tried", "lost", "double", "different", "other", "seconds"]


def print_table(tallies):
    rows = [HEADINGS] + [[str(cell) for cell in tally.row()] for tally in tallies]
    widths = [max(len(row[column]) for row in rows) for column in range(len(HEADINGS))]
    for row in rows:
        print(
            "  ".join(
                cell.ljust(width) if column == 0 else cell.rjust(width)
                for column, (cell, width) in enumerate(zip(row, widths))
            )
        )


def main():
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(1))  # runs the clean-up
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("bin")
    parser.add_argument("--quick", action="store_true", help="the part that runs with the tests, about half a minute")
    parser.add_argument("--case", action="append", metavar="NAME", help="only these; a part of the name is enough")
    parser.add_argument("--seed", type=int, default=1, help="of the random moments")
    parser.add_argument(
        "--every-allocation", action="store_true", help="only this: every allocation of SQLite fails in turn"
    )
    parser.add_argument("--list", action="store_true", help="names the cases")
    arguments = parser.parse_args()
    chosen = [case for case in cases.CASES if not arguments.case or any(part in case.name for part in arguments.case)]
    if arguments.every_allocation:
        chosen, arguments.quick = [cases.every_allocation()], False
    if arguments.list:
        print("\n".join(case.name for case in chosen))
        return 0
    # Uses a file system in memory if possible: the shim makes a power cut, not the disk.
    memory = "/dev/shm" if os.path.isdir("/dev/shm") and os.access("/dev/shm", os.W_OK) else None
    folder = tempfile.mkdtemp(prefix="fault-drill-", dir=memory)
    tallies = []
    try:
        lab = Lab(arguments.bin, folder)
        for case in chosen:
            started = time.monotonic()
            tally = Tally(case.name)
            try:
                case.run(lab, tally, random.Random(f"{arguments.seed} {case.name}"), arguments.quick)
            except Exception:  # runs the other cases
                tally.other += 1
                tally.complaints.append(traceback.format_exc())
            tally.seconds = time.monotonic() - started
            tallies.append(tally)
            print(f"{case.name}: {'passed' if tally.passed() else 'FAILED'} in {tally.seconds:.1f} s", file=sys.stderr)
            for complaint in tally.complaints[:5]:
                print(complaint, file=sys.stderr)
    finally:
        shutil.rmtree(folder, ignore_errors=True)
    print_table(tallies)
    for tally in tallies:
        for remark in tally.remarks:
            print(f"{tally.name}: {remark}")
    return 0 if tallies and all(tally.passed() for tally in tallies) else 1


if __name__ == "__main__":
    sys.exit(main())
