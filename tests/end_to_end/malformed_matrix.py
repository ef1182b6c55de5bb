#!/usr/bin/python3
"""malformed_matrix.py BIN SCHEMAS [--unbounded]

Spoils a campaign and its scene key by key by the schemas in SCHEMAS (each key with every kind of wrong
value), the text of the file, the file itself and the options of every verb, and gives it all to the programs
in BIN. Each must be refused with exit code 2 and one line of less than 500 characters without control
characters. There may be no standard output, no change in the folder, and at most four seconds of processor
time and 200 MB. Allowed extreme values may be valid instead.

--unbounded leaves out time and memory, for programs slowed down by a sanitizer.
"""
import argparse
import concurrent.futures
import json
import os
import subprocess
import sys
import tempfile
import threading

from malformed_cases import every_case

MOST_SECONDS, MOST_BYTES, LONGEST_LINE = 4.0, 200e6, 500  # 0.9 to 1.3 s on a busy machine


def contents(folder):
    return sorted(
        (entry.name, about.st_size, about.st_mtime_ns) for entry in os.scandir(folder) for about in [os.lstat(entry)]
    )


class Trial:
    def __init__(self, programs, is_bounded):
        self.programs, self.is_bounded = os.path.abspath(programs), is_bounded
        self.lock = threading.Lock()
        self.faults, self.refused, self.valid, self.dearest = [], 0, 0, (0, "")

    def work(self, cases):
        """Runs cases one by one: a list would take more memory than the programs, which inherit the peak."""
        while True:
            with self.lock:
                case = next(cases, None)
            if case is None:
                return
            self.run(case)

    def run(self, case):
        files = tempfile.TemporaryFile
        with tempfile.TemporaryDirectory() as folder, files() as output, files() as errors:
            if case.text is not None:
                with open(os.path.join(folder, "input.json"), "wb") as file:
                    file.write(case.text if isinstance(case.text, bytes) else case.text.encode())
            if case.prepare:
                case.prepare(folder)
            before = contents(folder)
            process = subprocess.Popen(
                [os.path.join(self.programs, case.program), *case.words],
                cwd=folder,
                stdin=subprocess.PIPE,
                stdout=output,
                stderr=errors,
            )
            for feed in (lambda: process.stdin.write(case.sent), process.stdin.close):
                try:
                    feed()
                except BrokenPipeError:
                    pass  # the program stopped reading
            _, status, used = os.wait4(process.pid, 0)
            process.returncode = os.waitstatus_to_exitcode(status)
            output.seek(0)
            errors.seek(0)
            self.judge(case, process.returncode, output.read(), errors.read(), used, contents(folder) != before)

    def judge(self, case, code, output, errors, used, has_changed):
        said = errors.decode(errors="replace")
        seconds, size = used.ru_utime + used.ru_stime, 1024 * used.ru_maxrss
        faults = []
        if code not in case.codes:
            faults.append(f"exit code {code}")
        if code != 0:
            if said.count("\n") != 1 or not said.endswith("\n") or len(said) > LONGEST_LINE:
                faults.append(f"{said.count(chr(10))} lines of {len(said)} characters")
            if any(ord(c) < 32 or 127 <= ord(c) < 160 or c in "\u202e\ufffd" for c in said[:-1]):
                faults.append("control characters, or no UTF-8")
            if output:
                faults.append("something on standard output")
        if self.is_bounded and (seconds > MOST_SECONDS or size > MOST_BYTES):
            faults.append(f"{seconds:.2f} s of processor time, {1e-6 * size:.0f} MB")
        if has_changed:
            faults.append("the folder has changed")
        with self.lock:
            self.refused += code == 2
            self.valid += code == 0
            self.dearest = max(self.dearest, (seconds, case.name))
            if faults:
                self.faults.append(f"{case.name}: {'; '.join(faults)}\n    {said[:300]!r}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("programs")
    parser.add_argument("schemas")
    parser.add_argument("--unbounded", action="store_true")
    arguments = parser.parse_args()
    schemas = {}
    for name in ("scene", "campaign"):
        with open(os.path.join(arguments.schemas, f"{name}.schema.json")) as file:
            schemas[name] = json.load(file)
    trial = Trial(arguments.programs, not arguments.unbounded)
    cases = every_case(schemas, os.path.join(trial.programs, "peclet"))
    with concurrent.futures.ThreadPoolExecutor(max_workers=2) as pool:
        for worker in [pool.submit(trial.work, cases) for _ in range(2)]:
            worker.result()
    for fault in trial.faults:
        print(fault)
    seconds, name = trial.dearest
    print(
        f"{trial.refused} refused, {trial.valid} extreme but valid, {len(trial.faults)} not as they should be; "
        f"the dearest took {seconds:.2f} s: {name}"
    )
    assert trial.refused >= 250, "the schemas list too few keys"
    return 1 if trial.faults else 0


if __name__ == "__main__":
    sys.exit(main())
