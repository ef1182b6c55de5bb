#!/usr/bin/python3
"""hostile_folder.py BIN [--quick] [--only PART] [--list]

Puts hostile objects into the folder of a campaign with some ended seeds: links to files, to folders and to
themselves, FIFOs, sockets, devices, folders in place of files, files in place of folders, a sparse terabyte,
rubbish, half files, names with escape sequences, crowds; in spool, requests, checkpoints, logs, failures,
backup, aside, lock and database. Then runs the campaign; the long form calls other verbs first. Each way must
end in the bytes of the undisturbed campaign, at once or, if the run refuses to begin, once the object is
removed. No program may crash, hang (60 s), take more than 200 MB or change files outside the folder. The
message is one line of at most 500 characters without control characters.

Finally tests targets of --output: devices, FIFOs, links and open descriptors are written to and stay.

Prints a table; the exit code is 1 if a way fails. Without root, ways that need it (devices, folders of another
user) are skipped and named. --quick is the part that runs with the tests.
"""
import argparse
import os
import shutil
import signal
import sys
import tempfile
import time

from hostile import outputs
from hostile.things import NotTried
from hostile.trial import Stock, Trial, Wrong
from hostile.ways import WAYS


def tried(stock, folder, way, short):
    """Returns a row of the table: True if the way passed, and its outcome in words."""
    trial = None
    started = time.monotonic()
    try:
        trial = Trial(stock, folder, way, short)
        line = trial.judge()
        word = True, f"{way.outcome}{': ' + line if line else ''}"
    except NotTried as why:
        word = True, f"not tried: {why}"
    except Wrong as wrong:
        word = False, f"WRONG: {str(wrong)[:1000]}"
    finally:
        shutil.rmtree(folder, ignore_errors=True)
    print(
        f"{way.title().encode('unicode_escape').decode()}  [{time.monotonic() - started:.1f} s, "
        f"{trial.most if trial else 0:.0f} MB]  "
        f"{word[1].replace(os.path.dirname(folder), '')}",
        flush=True,
    )
    return word[0]


def main():
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(1))  # runs the clean-up
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("bin")
    parser.add_argument("--quick", action="store_true", help="the part that runs with the tests, half a minute")
    parser.add_argument("--only", metavar="PART", help="only ways whose name has this in it")
    parser.add_argument("--list", action="store_true", help="names the ways")
    arguments = parser.parse_args()
    chosen = [way for way in WAYS if (way.quick or not arguments.quick) and (arguments.only or "") in way.title()]
    if arguments.list:
        print("\n".join(way.title().encode("unicode_escape").decode() for way in chosen))
        return 0
    memory = "/dev/shm" if os.path.isdir("/dev/shm") and os.access("/dev/shm", os.W_OK) else None
    with tempfile.TemporaryDirectory(prefix="hostile-folder-", dir=memory) as folder:
        os.chmod(folder, 0o755)  # some ways are run by an ordinary user
        stock = Stock(arguments.bin, folder)
        passed = [
            tried(stock, os.path.join(folder, str(number)), way, arguments.quick) for number, way in enumerate(chosen)
        ]
        if not arguments.only:
            passed.append(outputs.check(stock.peclet, stock.engine, stock.of(False)[0]))
    print(f"{sum(passed)} of {len(passed)} passed")
    return 0 if passed and all(passed) else 1


if __name__ == "__main__":
    sys.exit(main())
