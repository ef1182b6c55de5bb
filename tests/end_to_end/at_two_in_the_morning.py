#!/usr/bin/python3
"""at_two_in_the_morning.py BIN [--quick] [--only WORD] [--page FILE]

Makes common mistakes with real commands: wrong files and folders, a second owner, a deleted database, a full
disk, a closed laptop. Every answer must have the right exit code and the important phrases. A command that an
answer names is typed literally and must work. Results counted before and after must not be lost. --page
writes the transcript, MISTAKES.md.
"""
import argparse
import subprocess
import sys
import tempfile
import time

from mistakes import databases, files, folders, machine, processes, typing_errors
from mistakes.night import Night, NotTried, Wrong
from mistakes.transcript import page

CHAPTERS = [
    ("Typed wrong", typing_errors),
    ("Files", files),
    ("Folders and owners", folders),
    ("Databases", databases),
    ("Processes", processes),
    ("The machine", machine),
]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("bin")
    parser.add_argument("--quick", action="store_true", help="leave out what takes seconds")
    parser.add_argument("--only", metavar="WORD", help="the cases with this in their title")
    parser.add_argument("--page", metavar="FILE", help="write the transcript as Markdown")
    arguments = parser.parse_args()
    told, faults, untried, kinds = [], [], 0, 0
    for chapter, module in CHAPTERS:
        cases = []
        for case in module.CASES:
            title = case.__doc__.strip()
            if arguments.only and arguments.only not in title or arguments.quick and case in module.SLOW:
                continue
            kinds += 1
            night = Night(arguments.bin, tempfile.mkdtemp(prefix="night-"))
            began = time.monotonic()
            try:
                case(night)
                verdict = "ok"
            except NotTried as lack:
                verdict = f"NOT TRIED: {lack}"
                night.remarks(f"(not tried: {lack})")
                untried += 1
            except (Wrong, OSError, subprocess.SubprocessError, UnicodeError) as wrong:
                verdict = f"WRONG: {wrong}"
                faults.append(title)
            finally:
                night.close()
            print(f"{time.monotonic() - began:5.1f} s  {title}: {verdict}", flush=True)
            cases.append((title, night))
        told.append((chapter, cases))
    if arguments.page and not faults:
        with open(arguments.page, "w") as f:
            f.write(page(told))
    print(f"{kinds} mistakes, {len(faults)} answered badly" + (f", {untried} NOT TRIED" if untried else ""))
    return 1 if faults or kinds == untried else 0


if __name__ == "__main__":
    sys.exit(main())
