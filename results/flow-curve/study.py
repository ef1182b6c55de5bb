#!/usr/bin/python3
"""The published flow curves, split by term, at three volume fractions, and with other contact stiffnesses.

study.py BIN [FOLDER] [--quick] [--long]
"""
import math
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from studies.command_line import main
from studies.estimates import estimate, propagated, quotient
from studies.figure import BLACK, BLUE, GREEN, GREY, RED, Figure
from studies.fits import log_minimum
from studies.green_kubo import table_at_rest
from studies.published import JAMMED_AT_REST, JAMMED_IN_STRONG_FLOW, diverging
from studies.scenes import TABLE_SCENE, during, merged
from studies.tables import columns_of, entries, number, write_table
from studies.verdicts import Statement
from studies.viscosities import completed, pair_viscosity, term, viscosity_row

import numpy as np

TITLE = "Flow curves of Brownian suspensions"
FRACTIONS = (0.45, 0.50, 0.55)
SOURCES = {0.45: "L4.5a", 0.50: "L4.5b", 0.55: "L4.5c"}
# Campaigns: Peclet numbers, seeds, seeds with --long, and Brownian times of production; those without seeds take hours.
CAMPAIGNS = {
    "flow-curve": ((1, 4.6, 22, 100, 460, 2200, 1e4), 8, 16, 40),
    "flow-curve-0.22": ((0.22,), 6, 16, 60),
    "flow-curve-0.046": ((0.046,), 0, 16, 200),
    "flow-curve-0.01": ((0.01,), 0, 8, 400),
}
STIFFNESSES, STIFFNESS_PECLET = (2.5e3, 1e4, 4e4), (1, 1e4)
UNKNOWN = math.nan, math.inf


def structural_over(means, contact_of):
    """Ratio of the means of the structural Brownian stress and of a contact stress; its error from the seeds' pairs of
    values."""
    contact = np.array([contact_of(m) for m in means])
    structural = np.array([m["brownian_structural"][3] for m in means])
    ratio = structural.sum() / contact.sum()
    return float(ratio), float(estimate(structural - ratio * contact)[1] / abs(contact.mean()))


def plain_contact(mean):
    return term(mean, "contact_normal")


def controlled_contact(mean):
    """The contact stress with the control variate, whose mean is zero: all that the pairs have beside lubrication."""
    return pair_viscosity(mean) - term(mean, "lubrication")


def rows_of(program, name, cases, seeds, patch=None):
    """Rows of (fraction, stiffness, Peclet number)."""
    settings = [{"/volume_fraction": f, "/contact/normal_stiffness": k, "/peclet": p} for f, k, p in cases]
    rows = []
    for case, point in zip(cases, program.run(name, merged(TABLE_SCENE, patch or {}), settings, seeds)):
        means = completed(point)
        row = dict(zip(("fraction", "stiffness", "peclet"), case)) | viscosity_row(point)
        row |= entries("controlled_contact", estimate([controlled_contact(m) for m in means]))
        row |= entries("structural_over_contact", structural_over(means, controlled_contact))
        rows.append(row | entries("structural_over_plain_contact", structural_over(means, plain_contact)))
    return rows


def at_rest():
    """By volume fraction: the structural Brownian viscosity at rest over the solvent's, by Green and Kubo, and its
    standard error."""
    rows = {fraction: number(row, "viscosity") for fraction, row in table_at_rest().items()}
    # 0.55 lies between two: their geometric mean.
    (low, low_error), (high, high_error) = rows[0.54], rows[0.56]
    middle = math.sqrt(low * high)
    return {**rows, 0.55: (middle, middle / 2 * math.hypot(low_error / low, high_error / high))}


def pick(rows, **keys):
    return next((r for r in rows if all(r[k] == v for k, v in keys.items())), None)


def curve_of(rows, fraction):
    return sorted((r for r in rows if r["fraction"] == fraction), key=lambda r: r["peclet"])


def curve_statements(rows, fraction):
    curve = curve_of(rows, fraction)
    at = {r["peclet"]: r for r in curve}
    slowest = curve[0]["peclet"]

    def statement(text, found, low=-math.inf, high=math.inf, peclet=1e4, essential=True):
        degrees = at[peclet]["seeds"] - 1
        return Statement(f"φ = {fraction:g}: {text}", SOURCES[fraction], *found, low, high, degrees, essential)

    def ratio(name, a, b):
        return quotient(number(at[a], name), number(at[b], name))

    yield statement("η_r of pairs at Pe = 0.22 over that at 1 (thinning)", ratio("pairs", 0.22, 1), low=1)
    yield statement("at Pe = 1 over that at 4.6 (thinning)", ratio("pairs", 1, 4.6), low=1)
    known = [r for r in curve if r["peclet"] >= 0.22]  # below, errors are as large as the differences
    numbers, x = [number(r, "pairs") for r in known], [r["peclet"] for r in known]
    minimum = propagated(numbers, lambda values: log_minimum(x, values))
    yield statement("log10 Pe of the minimum (4.6 within a step of the table)", minimum, 0, math.log10(22))
    yield statement("at Pe = 10⁴ over that at 4.6 (thickening)", ratio("pairs", 1e4, 4.6), low=1)
    text = "lubrication at Pe = 10⁴ over that at 1 (rises weakly: at most twice)"
    yield statement(text, ratio("lubrication", 1e4, 1), 1, 2, essential=False)
    text = "structural Brownian stress over contact stress at Pe = "
    yield statement(f"{text}0.22", number(at[0.22], "structural_over_contact"), 0.8, 1.2, 0.22, essential=False)
    over_contact, over_plain = (
        number(at[0.01], f"structural_over_{contact}") if 0.01 in at else UNKNOWN
        for contact in ("contact", "plain_contact")
    )
    yield statement(f"{text}0.01", over_contact, 0.8, 1.2, slowest)
    text = "the same with the contact stress as it is, without the control variate, at Pe = 0.01"
    yield statement(text, over_plain, 0.8, 1.2, slowest, essential=False)
    rest = at_rest()[fraction]
    rising = fraction == 0.55
    for peclet in (0.22, 0.046):
        if peclet in at:
            share = quotient(number(at[peclet], "structural"), rest)
            text = f"structural Brownian stress at Pe = {peclet} over that at rest by Green and Kubo"
            if rising:
                yield statement(f"{text} (still rising)", share, high=0.9, peclet=peclet, essential=False)
            else:
                yield statement(f"{text} (plateau)", share, 0.8, 1.2, peclet, essential=False)
    last = ratio("pairs", 0.01, 0.046) if 0.01 in at else UNKNOWN
    if rising:
        yield statement("at Pe = 0.01 over that at 0.046 (still rising)", last, low=1.1, peclet=slowest)
    else:
        yield statement("at Pe = 0.01 over that at 0.046 (plateau)", last, 0.9, 1.1, slowest)


def comparison(text, source, a, b, width, degrees, essential=True):
    """That the viscosities of two rows are the same within `width`."""
    ratio = quotient(number(a, "viscosity"), number(b, "viscosity"))
    return Statement(text, source, *ratio, 1 - width, 1 + width, degrees, essential)


def comparisons(rows, stiffness, large, methods):
    for row in stiffness:
        text = f"φ = 0.5, Pe = {row['peclet']:g}: η_r at k_n = {row['stiffness']:g} over that at 10⁴"
        standard = pick(rows, fraction=0.5, peclet=row["peclet"])
        yield comparison(text, "L4.5b", row, standard, 0.05, row["seeds"] - 1)
    for row in large:
        text = f"φ = 0.45, Pe = {row['peclet']:g}: η_r with N = 1000 over that with 250"
        standard = pick(rows, fraction=0.45, peclet=row["peclet"])
        yield comparison(text, "method", row, standard, 0.05, row["seeds"] - 1, essential=False)
    text = "φ = 0.45, Pe = 100, rate 0.045: η_r with implicit steps over that with explicit ones"
    implicit, explicit = methods["implicit"], methods["explicit"]
    yield comparison(text, "method", implicit, explicit, 0.1, explicit["seeds"] - 1)


def measure(program):
    rows = []
    for name, (peclets, few, many, times) in CAMPAIGNS.items():
        seeds = many if program.long else few
        if seeds:
            patch = {"duration": {"production": {"brownian_times": times}}}
            rows += rows_of(program, name, [(f, 1e4, p) for f in FRACTIONS for p in peclets], seeds, patch)
    cases = [(0.5, k, p) for k in STIFFNESSES if k != 1e4 for p in STIFFNESS_PECLET]
    stiffness = rows_of(program, "stiffness", cases, 16 if program.long else 8)
    large = rows_of(program, "large", [(0.45, 1e4, p) for p in (100, 1e4)], 8, {"particles": {"count": 1000}})
    methods = {}
    for method in ("implicit", "explicit"):
        patch = {"limits": {"shear_rate": 0.045}, "integrator": {"method": method}}
        methods[method] = rows_of(program, method, [(0.45, 1e4, 100)], 6, patch)[0]

    table = [{"method": "implicit", "count": 250, **r} for r in rows + stiffness]
    table += [{"method": "implicit", "count": 1000, **r} for r in large]
    table += [{"method": f"{m} at rate 0.045", "count": 250, **r} for m, r in methods.items()]
    stresses = ("viscosity", "pairs", "lubrication", "contact", "controlled_contact", "structural")
    ratios = ("structural_over_contact", "structural_over_plain_contact")
    names = ["method", "count", "fraction", "stiffness", "peclet", "seeds", "lost", "transient"]
    write_table(HERE / "table.csv", [*names, *columns_of(*stresses, *ratios)], table, 4)
    draw(rows)
    return [*(s for f in FRACTIONS for s in curve_statements(rows, f)), *comparisons(rows, stiffness, large, methods)]


def draw(rows):
    terms = {
        "pairs": (BLACK, 7, "all pairs"),
        "controlled_contact": (RED, 5, "contact"),
        "lubrication": (BLUE, 9, "lubrication"),
        "structural": (GREEN, 4, "structural Brownian"),
    }
    figure = Figure(HERE / "chart.png", columns=3, size=(1400, 460))
    rest = at_rest()
    for fraction, largest in zip(FRACTIONS, (100, 200, 600)):
        ends = {"x_range": (5e-3, 3e4), "y_range": (0.1, largest)}
        panel = figure.panel("Pe", "σ / (η γ̇)", f"φ = {fraction:g}", log="xy", powers="x", **ends)
        for name, (colour, mark, title) in terms.items():
            curve = [(r["peclet"], *number(r, name)) for r in curve_of(rows, fraction)]
            panel.points(curve, title, colour, mark, 0.8, joined=True)
        title = "published fits of both ends"
        for jammed, span in ((JAMMED_AT_REST, (5e-3, 0.02)), (JAMMED_IN_STRONG_FLOW, (3e3, 3e4))):
            panel.level(diverging(fraction, jammed), title, GREY, span, width=3)
            title = None
        panel.level(rest[fraction][0], "structural Brownian at rest", GREEN, (5e-3, 0.1), width=2, dash=2)
    figure.draw()


def quick_measure(program):
    parts = during({"brownian_times": 10}, {"brownian_times": 20, "strain": 3})
    cases = [(0.5, 1e4, p) for p in (0.22, 4.6, 1e4)]
    low, middle, high = rows_of(program, "quick", cases, 8, {"particles": {"count": 100}, **parts})
    thickening = quotient(number(high, "pairs"), number(middle, "pairs"))
    lubrication = quotient(number(middle, "lubrication"), number(high, "lubrication"))
    structural = number(low, "structural_over_contact")
    name = "φ = 0.5: η_r of pairs at Pe"
    text = "φ = 0.5: structural Brownian stress over contact stress at Pe = 0.22"
    return [
        Statement(f"{name} = 10⁴ over that at 4.6 (thickening)", "L4.5b", *thickening, 1.1, 2.5, 7),
        Statement(f"{name} = 4.6", "L4.5b", *number(middle, "pairs"), 4, 10, 7),
        Statement("φ = 0.5: lubrication at Pe = 4.6 over that at 10⁴", "L4.5b", *lubrication, 0.1, 0.8, 7),
        Statement(text, "L4.5b", *structural, 0.25, 2, 7),
    ]


main(HERE, TITLE, measure, quick_measure)
