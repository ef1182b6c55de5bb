"""Rows of a study, its verdict, and what a program writes on the page of a study, between two marks that it has.

    Statement   a published sentence, by a number with its standard error and a bound that the sentence gives:
                "holds", or "does not hold"
    Check       of our own methods and their consistency: "ok" or "failed"; it says nothing about the publication
    Finding     a number where nothing is published, or where what is tested is a reading of ours: no answer

A row answers when its whole interval of 95 % lies on one side of each bound; until then the answer is "open". The
study's verdict follows from its statements: "does not hold" when one that is marked essential does not; "not yet"
when one is open; "holds with a difference" when another one does not hold; "holds" when all do; "findings only"
without any. Checks that failed are counted behind it: "holds (2 checks failed)". A statement is not essential when
its bound hangs on a number, a definition or a word like "weakly" that is not in print.
"""
import math

from studies.estimates import student_quantile
from studies.tables import markdown_head, markdown_row

HEADS = {
    "statement": ("published statement", "source", "value ± standard error", "must be", "answer"),
    "check": ("check", "of", "value ± standard error", "must be", "answer"),
    "finding": ("finding", "about", "value ± standard error"),
}
BEGIN, END = "<!-- rows, written by study.py -->", "<!-- end of rows -->"
ROUNDING = 1e-12  # an error below this share of its value is that of floating point


def five_digits(x):
    return float(f"{x:.5g}") if math.isfinite(x) else None


def value_in_json(value):
    """To five digits; "infinite" or "-infinite", as of a viscosity that jams; None where it was not measured."""
    if math.isinf(value):
        return "infinite" if value > 0 else "-infinite"
    return five_digits(value)


def value_of_json(entry):
    named = {"infinite": math.inf, "-infinite": -math.inf, None: math.nan}
    return named[entry] if entry is None or isinstance(entry, str) else entry


def with_error(value, error):
    """ "1.235 ± 0.12"; the value alone where it has no error."""
    if math.isnan(value):
        return "not measured"
    if math.isinf(value):
        return value_in_json(value)
    if not math.isfinite(error):
        return f"{value:.4g}, error unknown"
    return f"{value:.4g} ± {error:.2g}" if error > 0 else f"{value:.4g}"


class Row:
    """`value` with its standard error, of so many degrees of freedom. An error of 0 is that of a number that seeds do
    not change: a count, a time, a place on a grid, a difference in standard errors."""

    kind = None

    def __init__(self, text, source, value, error, degrees=30):
        self.text, self.source, self.value = text, source, value
        is_rounding = math.isfinite(error) and error <= ROUNDING * abs(value)
        self.error = 0.0 if is_rounding else error
        self.half_width = 0.0 if is_rounding else student_quantile(degrees, 0.975) * error

    def as_json(self):
        return {
            "kind": self.kind,
            "statement": self.text,
            "source": self.source,
            "value": value_in_json(self.value),
            "standard_error": five_digits(self.error),
            "half_width": five_digits(self.half_width),
        }

    def cells(self):
        # Of what study.json has, so that a page can be held to it.
        value, error = value_of_json(value_in_json(self.value)), five_digits(self.error)
        return [self.text, self.source, with_error(value, math.nan if error is None else error)]


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

    def answer(self):
        if not self.sure():
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
        value = value_of_json(entry["value"])
        error, half_width = (
            math.inf if entry[name] is None else entry[name] for name in ("standard_error", "half_width")
        )
        row = kinds[entry["kind"]](entry["statement"], entry["source"], value, error, **bounds)
        row.half_width = half_width
        yield row


def verdict_of_statements(rows):
    statements = [row for row in rows if row.kind == "statement"]
    answers = [row.answer() for row in statements]
    if not statements:
        return "findings only"
    if any(answer == "does not hold" and row.essential for answer, row in zip(answers, statements)):
        return "does not hold"
    if "open" in answers:
        return "not yet"
    return "holds" if all(answer == "holds" for answer in answers) else "holds with a difference"


def with_failed_checks(text, rows):
    """ "holds (2 checks failed)" """
    failed = sum(row.kind == "check" and row.answer() == "failed" for row in rows)
    return f"{text} ({failed} check{'s' if failed > 1 else ''} failed)" if failed else text


def verdict(rows):
    return with_failed_checks(verdict_of_statements(rows), rows)


def tables_of(rows):
    """A table for each kind of rows that there is."""
    parts = []
    for kind, head in HEADS.items():
        lines = [markdown_row(row.cells()) for row in rows if row.kind == kind]
        if lines:
            parts.append("\n".join([markdown_head(head), *lines]))
    return "\n\n".join(parts)


def with_part(page, begin, end, text):
    """The page with this text between two marks."""
    before, rest = page.split(begin + "\n")
    _, after = rest.split(end)
    return f"{before}{begin}\n{text}\n{end}{after}"


def with_rows(page, rows):
    """The page with these rows between its marks."""
    return with_part(page, BEGIN, END, tables_of(rows))


def rewrite(path, rows):
    """Of a page that has the marks."""
    with open(path) as f:
        page = f.read()
    if BEGIN in page:
        with open(path, "w") as f:
            f.write(with_rows(page, rows))


def rewrite_part(path, name, text):
    """Another part, which has this name in its marks."""
    with open(path) as f:
        page = f.read()
    with open(path, "w") as f:
        f.write(with_part(page, f"<!-- {name}, written by study.py -->", f"<!-- end of {name} -->", text))
