"""What the studies of published statements share: statements that are judged, their verdict, pictures, and the command line.

A study is a folder with study.py (this module's main() with the folder's own functions), README.md, table.csv, a picture, and
study.json: what was found, which `peclet study --list` shows. Each published statement is answered by a number with its standard error
and a criterion that can fail:

    holds       the criterion is met
    fails       it is not
    open        the number is not known well enough to say: its interval of 95 % reaches across the bound

and the study's verdict follows: "holds" when every statement holds; "does not hold" when one that is marked essential fails; "not yet"
when one is open; "holds with a difference" otherwise.
"""
import argparse
import datetime
import json
import math
import os
import platform
import subprocess
import sys
import tempfile

from campaigns import Program, student_quantile


class Statement:
    """`value` with its standard error (of so many degrees of freedom) must lie between `low` and `high`."""

    def __init__(self, text, source, value, error, low=-math.inf, high=math.inf, degrees=30, essential=True):
        self.text, self.source, self.value, self.error = text, source, value, error
        self.low, self.high, self.essential = low, high, essential
        self.half_width = student_quantile(degrees, 0.975) * error

    def answer(self):
        if not math.isfinite(self.value) or not math.isfinite(self.half_width):
            return "open"
        if self.low <= self.value - self.half_width and self.value + self.half_width <= self.high:
            return "holds"
        if self.value + self.half_width < self.low or self.value - self.half_width > self.high:
            return "fails"
        return "open"

    def as_json(self):
        def number(x):
            return float(f"{x:.5g}") if math.isfinite(x) else None

        return {
            "statement": self.text,
            "source": self.source,
            "value": number(self.value),
            "standard_error": number(self.error),
            "low": number(self.low),
            "high": number(self.high),
            "essential": self.essential,
            "answer": self.answer(),
        }

    def row(self):
        bound = (
            f"{self.low:g} to {self.high:g}"
            if math.isfinite(self.low) and math.isfinite(self.high)
            else f"at least {self.low:g}"
            if math.isfinite(self.low)
            else f"at most {self.high:g}"
        )
        return f"| {self.text} | {self.source} | {self.value:.4g} ± {self.error:.2g} | {bound} | {self.answer()} |"


def verdict(statements):
    answers = [s.answer() for s in statements]
    if any(a == "fails" and s.essential for a, s in zip(answers, statements)):
        return "does not hold"
    if "open" in answers:
        return "not yet"
    return "holds" if all(a == "holds" for a in answers) else "holds with a difference"


def processor():
    with open("/proc/cpuinfo") as f:
        names = [line.split(":", 1)[1].strip() for line in f if line.startswith("model name")]
    return names[0] if names else platform.processor()


def gnuplot(lines):
    subprocess.run(["gnuplot"], input="\n".join(lines) + "\n", text=True, check=True)


def data_block(name, rows):
    """A gnuplot data block; NaN where a number is missing."""
    yield f"${name} << EOD"
    for row in rows:
        yield " ".join(f"{v:.7g}" if isinstance(v, (int, float)) and math.isfinite(v) else "NaN" for v in row)
    yield "EOD"


def weighted_mean(values, errors):
    """Of independent numbers: mean with weights 1 / error^2, and its standard error."""
    weights = [1 / e**2 for e in errors]
    return sum(w * v for w, v in zip(weights, values)) / sum(weights), 1 / math.sqrt(sum(weights))


def line_through(x, y, errors):
    """Least squares with weights 1 / error^2: intercept, slope, and the slope's standard error."""
    weights = [1 / e**2 for e in errors]
    mean_x, mean_y = (sum(w * v for w, v in zip(weights, values)) / sum(weights) for values in (x, y))
    spread = sum(w * (v - mean_x) ** 2 for w, v in zip(weights, x))
    slope = sum(w * (a - mean_x) * (b - mean_y) for w, a, b in zip(weights, x, y)) / spread
    return mean_y - slope * mean_x, slope, 1 / math.sqrt(spread)


def main(folder, title, measure, quick_measure):
    """The command line of a study. measure(program) runs it whole, writes its table and picture beside study.py and returns its
    statements; quick_measure(program) is a version of half a minute, whose statements must all hold: the tests run it.
    """
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
        help="N times as many seeds everywhere, for error bars that are smaller by the root of N; goes on with FOLDER",
    )
    arguments = parser.parse_args()
    if arguments.times < 1:
        parser.error("--times: must be at least 1")
    if not arguments.quick and not os.access(folder, os.W_OK):
        # Said before hours of work, not after them.
        parser.error(
            f"{folder}: a whole study writes its table there, and may not; copy the folder above it, and name the copy: "
            "peclet study --results COPY"
        )
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
            json.dump(
                {
                    "title": title,
                    "verdict": found,
                    "processor_hours": float(f"{program.processor_seconds / 3600:.2g}"),
                    "date": datetime.date.today().isoformat(),
                    "engine": sorted(program.commits),
                    "machine": processor(),
                    "statements": [s.as_json() for s in statements],
                },
                f,
                indent=1,
                ensure_ascii=False,
            )
            f.write("\n")
