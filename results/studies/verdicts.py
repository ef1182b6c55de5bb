"""Statements that are judged, and the verdict of a study.

Each published statement is answered by a number with its standard error and a criterion that can fail:

    holds       the criterion is met
    fails       it is not
    open        the number is not known well enough to say: its interval of 95 % reaches across the bound

and the study's verdict follows: "holds" when every statement holds; "does not hold" when one that is marked essential
fails; "not yet" when one is open; "holds with a difference" otherwise.
"""
import math

from studies.estimates import student_quantile


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

    def bounds(self):
        if not math.isfinite(self.high):
            return f"at least {self.low:g}"
        if not math.isfinite(self.low):
            return f"at most {self.high:g}"
        return f"{self.low:g} to {self.high:g}"

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
        found = f"{self.value:.4g} ± {self.error:.2g}"
        return f"| {self.text} | {self.source} | {found} | {self.bounds()} | {self.answer()} |"


def verdict(statements):
    answers = [s.answer() for s in statements]
    if any(a == "fails" and s.essential for a, s in zip(answers, statements)):
        return "does not hold"
    if "open" in answers:
        return "not yet"
    return "holds" if all(a == "holds" for a in answers) else "holds with a difference"
