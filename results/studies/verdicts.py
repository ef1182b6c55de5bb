"""Rows of a study, its verdict, and the parts of its page that a program writes between two marks.

    Statement   a published sentence, tested by a number with its standard error and a bound from the sentence:
                "holds" or "does not hold"
    Check       a test of our own methods, independent of the publication: "ok" or "failed"
    Finding     a number without a published one, or with an interpretation of ours: no answer

A row has an answer if its whole 95 % interval lies on one side of each bound; otherwise the answer is "open". The
verdict of a study follows from its statements, by the first rule that applies:

    "findings only"             there are no statements
    "does not hold"             an essential statement does not hold
    "not yet"                   an essential statement is open
    "holds"                     all statements hold
    "holds with a difference"   a statement that is not essential does not hold or is open

Failed checks are counted behind it: "holds (2 checks failed)". A statement is not essential if its bound depends on a
number or a definition that is not published, or on a vague word such as "weakly"; of two published definitions the
nearer reading is essential.
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
LEGEND = """\
A row is *open* while its 95 % interval contains a bound ([rules and symbols](../../docs/studies.md)). L and M are
[the publications](../../docs/statements.md)."""
# Bounds of d ln η / d ln k_n: above the first a point is jammed but soft, below the second it flows.
JAMMED, FLOWING = 0.5, 0.2
ROUNDING = 1e-12  # a relative error below this is due to floating point


def five_digits(x):
    return float(f"{x:.5g}") if math.isfinite(x) else None


def value_in_json(value):
    """Returns a number with five digits; "infinite" or "-infinite" (a jammed viscosity); None if not measured."""
    if math.isinf(value):
        return "infinite" if value > 0 else "-infinite"
    return five_digits(value)


def value_of_json(entry):
    named = {"infinite": math.inf, "-infinite": -math.inf, None: math.nan}
    return named[entry] if entry is None or isinstance(entry, str) else entry


def with_error(value, error):
    """Returns "1.235 ± 0.12", or the value alone if its error is 0."""
    if math.isnan(value):
        return "not measured"
    if math.isinf(value):
        return value_in_json(value)
    if not math.isfinite(error):
        return f"{value:.4g}, error unknown"
    return f"{value:.4g} ± {error:.2g}" if error > 0 else f"{value:.4g}"


class Row:
    """A row: a text, its source, and a value with its standard error and degrees of freedom.

    The error is 0 for numbers without scatter: a count, a time, a place on a grid, a difference in standard errors.
    """

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
        # Rounded as in study.json, with which tests compare the page.
        value, error = value_of_json(value_in_json(self.value)), five_digits(self.error)
        return [self.text, self.source, with_error(value, math.nan if error is None else error)]


class Finding(Row):
    kind = "finding"


class Judged(Row):
    """A row whose value must lie between `low` and `high`."""

    yes, no = None, None

    def __init__(self, text, source, value, error, low=-math.inf, high=math.inf, degrees=30, essential=True):
        super().__init__(text, source, value, error, degrees)
        self.low, self.high, self.essential = low, high, essential

    def within(self):
        return self.low <= self.value <= self.high

    def sure(self):
        """Returns True if the whole 95 % interval lies on the same side of the bounds as the value."""
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
    """Yields the rows of a study.json, with five digits."""
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
    if not statements:
        return "findings only"
    essential = [row.answer() for row in statements if row.essential]
    if "does not hold" in essential:
        return "does not hold"
    if "open" in essential:
        return "not yet"
    return "holds" if all(row.answer() == "holds" for row in statements) else "holds with a difference"


def with_failed_checks(text, rows):
    """Returns a verdict with the number of failed checks, if any: "holds (2 checks failed)"."""
    failed = sum(row.kind == "check" and row.answer() == "failed" for row in rows)
    return f"{text} ({failed} check{'s' if failed > 1 else ''} failed)" if failed else text


def verdict(rows):
    return with_failed_checks(verdict_of_statements(rows), rows)


def tables_of(rows):
    """Returns a Markdown table for each kind of rows that is present."""
    parts = []
    for kind, head in HEADS.items():
        lines = [markdown_row(row.cells()) for row in rows if row.kind == kind]
        if lines:
            parts.append("\n".join([markdown_head(head), *lines]))
    return "\n\n".join(parts)


def with_part(page, begin, end, text):
    """Returns the page with `text` between two marks."""
    before, rest = page.split(begin + "\n")
    _, after = rest.split(end)
    return f"{before}{begin}\n{text}\n{end}{after}"


def with_rows(page, rows):
    """Returns the page with these rows between its marks, and what their columns mean."""
    return with_part(page, BEGIN, END, f"{LEGEND}\n\n{tables_of(rows)}")


def rewrite(path, rows):
    """Writes the rows into a page, if it has the marks."""
    with open(path) as f:
        page = f.read()
    if BEGIN in page:
        with open(path, "w") as f:
            f.write(with_rows(page, rows))


def rewrite_part(path, name, text):
    """Writes another part of a page, with this name in its marks."""
    with open(path) as f:
        page = f.read()
    with open(path, "w") as f:
        f.write(with_part(page, f"<!-- {name}, written by study.py -->", f"<!-- end of {name} -->", text))
