"""Rows of a study, and its verdict.

    Statement   a published sentence, by a number with its standard error and a bound that the sentence gives:
                "holds", or "does not hold"
    Check       of our own methods and their consistency: "ok" or "failed"; it says nothing about the publication
    Finding     a number where nothing is published, or where what is tested is a reading of ours: no answer

The value itself answers as soon as it is known well enough (Judged.known); until then the answer is "open". The study's
verdict follows from its statements: "does not hold" when one that is marked essential does not; "not yet" when one is
open; "holds with a difference" when another one does not hold; "holds" when all do; "findings only" without any. A
statement is not essential when its bound hangs on a number, a definition or a word like "weakly" that is not in print.
"""
import math

from studies.estimates import student_quantile

HEADS = {
    "statement": ("published statement", "source", "value ± standard error", "must be", "answer"),
    "check": ("check", "of", "value ± standard error", "must be", "answer"),
    "finding": ("finding", "about", "value ± standard error"),
}


def five_digits(x):
    return float(f"{x:.5g}") if math.isfinite(x) else None


class Row:
    """`value` with its standard error, of so many degrees of freedom."""

    kind = None

    def __init__(self, text, source, value, error, degrees=30):
        self.text, self.source, self.value, self.error = text, source, value, error
        self.half_width = student_quantile(degrees, 0.975) * error

    def as_json(self):
        return {
            "kind": self.kind,
            "statement": self.text,
            "source": self.source,
            "value": five_digits(self.value),
            "standard_error": five_digits(self.error),
            "half_width": five_digits(self.half_width),
        }

    def cells(self):
        # Of what study.json has, so that a page can be held to it.
        value, error = (math.nan if x is None else x for x in (five_digits(self.value), five_digits(self.error)))
        return [self.text, self.source, f"{value:.4g} ± {error:.2g}"]


class Finding(Row):
    kind = "finding"


class Judged(Row):
    """A value that must lie between `low` and `high`."""

    yes, no = None, None

    def __init__(self, text, source, value, error, low=-math.inf, high=math.inf, degrees=30, essential=True):
        super().__init__(text, source, value, error, degrees)
        self.low, self.high, self.essential = low, high, essential

    def within(self):
        return self.low <= self.value <= self.high

    def sure(self):
        """Whether the whole interval of 95 % lies on the side of the bounds that the value lies on."""
        ends = self.value - self.half_width, self.value + self.half_width
        if self.within():
            return bool(self.low <= ends[0] and ends[1] <= self.high)
        return bool(ends[1] < self.low or ends[0] > self.high)

    def known(self):
        """Whether the value may answer: it is sure, or its interval of 95 % is no wider than the range between the
        bounds; where there is one bound, no wider than a fifth (ratios about 1, decades and powers about 0)."""
        if not math.isfinite(self.value) or not math.isfinite(self.half_width):
            return False
        range_ = self.high - self.low
        return self.sure() or 2 * self.half_width <= (range_ if math.isfinite(range_) else 0.2)

    def answer(self):
        if not self.known():
            return "open"
        return self.yes if self.within() else self.no

    def bounds(self):
        low, high = five_digits(self.low), five_digits(self.high)
        if high is None:
            return f"at least {low:.4g}"
        if low is None:
            return f"at most {high:.4g}"
        return f"{low:.4g} to {high:.4g}"

    def as_json(self):
        more = {"low": five_digits(self.low), "high": five_digits(self.high)}
        if self.kind == "statement":
            more["essential"] = self.essential
        return {**super().as_json(), **more, "answer": self.answer(), "sure": self.sure()}

    def cells(self):
        return [*super().cells(), self.bounds(), self.answer()]


class Statement(Judged):
    kind, yes, no = "statement", "holds", "does not hold"


class Check(Judged):
    kind, yes, no = "check", "ok", "failed"


def rows_of(study):
    """The rows that a study.json is made of, to five digits."""
    kinds = {row.kind: row for row in (Statement, Check, Finding)}
    for entry in study["statements"]:
        bounds = {}
        if entry["kind"] != "finding":
            bounds["low"] = -math.inf if entry["low"] is None else entry["low"]
            bounds["high"] = math.inf if entry["high"] is None else entry["high"]
            bounds["essential"] = entry.get("essential", True)
        value, error, half_width = (
            math.nan if entry[name] is None else entry[name] for name in ("value", "standard_error", "half_width")
        )
        row = kinds[entry["kind"]](entry["statement"], entry["source"], value, error, **bounds)
        row.half_width = half_width
        yield row


def verdict(rows):
    statements = [row for row in rows if row.kind == "statement"]
    answers = [row.answer() for row in statements]
    if not statements:
        return "findings only"
    if any(answer == "does not hold" and row.essential for answer, row in zip(answers, statements)):
        return "does not hold"
    if "open" in answers:
        return "not yet"
    return "holds" if all(answer == "holds" for answer in answers) else "holds with a difference"
