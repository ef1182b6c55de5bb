#!/usr/bin/python3
"""The published flow curves, split by term, at three volume fractions, and with other contact stiffnesses."""
import math
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from studies.driver import BLACK, BLUE, Check, Figure, Finding, GREEN, GREY, JAMMED_AT_REST, JAMMED_IN_STRONG_FLOW, RED
from studies.driver import SLOWEST, Statement, TABLE_SCENE, diverging, during, entries, estimate, first, log_minimum
from studies.driver import logarithm, main, merged, number, over, propagated, propagated_lists, quotient, read_rows
from studies.driver import row_ratio, rows_at_rest, table_at_rest, term, viscosity_row, where, write_table
import costs
import numpy as np
from scipy.stats import t

TITLE = "Flow curves of Brownian suspensions"
FRACTIONS = (0.45, 0.50, 0.55)
SOURCES = {0.45: "L4.5a", 0.50: "L4.5b", 0.55: "L4.5c"}
CURVES, WITHOUT_NOISE = ("curves", "curve-55"), "without-noise"  # campaigns in this folder, of 1000 spheres
STIFFNESSES, STIFFNESS_PECLET = (2.5e3, 1e4, 4e4), (1, 1e4)


def structural_over(means, contact_of):
    """Returns the mean structural Brownian stress over a mean contact stress, and its error from values by seed."""
    contact = np.array([contact_of(m) for m in means])
    structural = np.array([m["brownian_structural"][3] for m in means])
    ratio = structural.sum() / contact.sum()
    return float(ratio), float(estimate(structural - ratio * contact)[1] / abs(contact.mean()))


def plain_contact(mean):
    return term(mean, "contact_normal")


def controlled_contact(mean):
    """Returns the contact stress plus that of the random forces, whose mean is 0: everything except lubrication."""
    return mean["relative_viscosity_pair"] - term(mean, "lubrication")


def row_of(point, fraction, stiffness, peclet):
    means = point.means
    row = {"fraction": fraction, "stiffness": stiffness, "peclet": peclet} | viscosity_row(point)
    row |= entries("controlled_contact", estimate([controlled_contact(m) for m in means]))
    row |= entries("structural_over_contact", structural_over(means, controlled_contact))
    return row | entries("structural_over_plain_contact", structural_over(means, plain_contact))


def rows_of(program, name, cases, seeds, patch=None):
    """Returns rows for cases (fraction, stiffness, Peclet number)."""
    settings = [{"/volume_fraction": f, "/contact/normal_stiffness": k, "/peclet": p} for f, k, p in cases]
    points = program.run(name, merged(TABLE_SCENE, patch or {}), settings, seeds)
    return [row_of(point, *case) for case, point in zip(cases, points)]


def rows_of_curves(program):
    """Returns the rows of the curves, without their points at rest."""
    points = [point for name in CURVES for point in program.run_file(HERE / f"{name}.json")]
    places = [(point["settings"]["/volume_fraction"], 1e4, point["settings"]["/peclet"]) for point in points]
    return [row_of(point, *place) for place, point in zip(places, points) if place[-1] > 0]


def rows_without_noise(program):
    points = program.run_file(HERE / f"{WITHOUT_NOISE}.json")
    return [row_of(point, point["settings"]["/volume_fraction"], 1e4, math.inf) for point in points]


USUAL = {"method": "implicit", "stiffness": 1e4}
LOWEST = 4.6  # Peclet number of the published minimum
FOSS_AND_BRADY = 0.45  # volume fraction compared with theirs, up to 0.49 (abstract): J. Fluid Mech. 407, 167 (2000)
KNOWN = 0.22  # below this Peclet number errors are as large as the differences between points


class Curve:
    """The rows of one volume fraction by Peclet number, and statements about them."""

    def __init__(self, rows, fraction):
        curve = sorted(where(rows, fraction=fraction), key=lambda r: r["peclet"])
        self.fraction, self.at = fraction, {r["peclet"]: r for r in curve}

    def row(self, kind, text, found, peclet=LOWEST, **bounds):
        degrees = self.at[peclet]["seeds"] - 1
        return kind(f"φ = {self.fraction:g}: {text}", SOURCES[self.fraction], *found, degrees=degrees, **bounds)

    def ratio(self, name, a, b):
        return row_ratio(self.at[a], self.at[b], name)

    def known(self, name):
        return [number(row, name) for peclet, row in self.at.items() if peclet >= KNOWN]


def shape_rows(curve):
    thinning = curve.ratio("pairs", 0.22, 1)
    yield curve.row(Statement, "η_r of pairs at Pe = 0.22 over that at 1: thinning", thinning, low=1)
    stresses = {"pairs": "η_r of pairs", "contact": "contact stress"}
    for name, what in stresses.items():
        least = min((p for p in curve.at if p != LOWEST), key=lambda p: curve.at[p][name])
        text = f"{what} at Pe = 4.6 over the least of all other Pe (at {least:g}): 4.6 is lowest"
        yield curve.row(Statement, text, curve.ratio(name, LOWEST, least), high=1)
    for name, what in stresses.items():
        text = f"{what} at Pe = 10⁴ over that at 4.6: thickening"
        yield curve.row(Statement, text, curve.ratio(name, 1e4, LOWEST), low=1)
    x = [p for p in curve.at if p >= KNOWN]
    minimum = propagated(curve.known("pairs"), lambda values: log_minimum(x, values))
    yield curve.row(Finding, "log10 Pe of the minimum, by a parabola", minimum)
    if curve.fraction == FOSS_AND_BRADY:
        for a, b, what in ((KNOWN, LOWEST, "thinning below Pe = 10"), (22, LOWEST, "thickening beyond")):
            text = f"φ = {curve.fraction:g}: η_r of pairs at Pe = {a:g} over that at {b:g}: {what} (Foss & Brady 2000)"
            yield Statement(text, "L4.7", *curve.ratio("pairs", a, b), low=1, degrees=curve.at[a]["seeds"] - 1)
    following = propagated_lists(
        [curve.known(name) for name in stresses], lambda both: float(np.corrcoef(np.log(np.maximum(both, 1e-9)))[0, 1])
    )
    yield curve.row(Finding, "correlation of ln contact stress with ln η_r of pairs from Pe = 0.22 on", following)


def lubrication_rows(curve):
    """Yields rows about the increase of lubrication. "Weakly" has no published number, and depends on the terms that
    are counted as hydrodynamic."""
    pairs = curve.ratio("lubrication", 1e4, 1)
    text = "lubrication at Pe = 10⁴ over that at 1: it increases (published: weakly)"
    yield curve.row(Statement, text, pairs, low=1, essential=False)
    for text, more in (("2.5 φ", 2.5 * curve.fraction), ("1 + 2.5 φ", 1 + 2.5 * curve.fraction)):
        parts = ((number(curve.at[p], "lubrication")[0] + more, curve.at[p]["lubrication_error"]) for p in (1e4, 1))
        yield curve.row(Finding, f"lubrication + {text} at Pe = 10⁴ over that at 1", quotient(*parts))
    exponent = over(logarithm(pairs), math.log(1e4))
    yield curve.row(Finding, "d ln lubrication / d ln Pe from 1 to 10⁴", exponent)


def low_rows(curve):
    """Yields rows about the structural Brownian stress over the contact stress at low Pe. "Maps quite closely", on axes
    of three decades, is tested to a factor of 1.5, at the lowest Pe with a small error."""
    text = "structural Brownian stress over contact stress at Pe = "
    closely = number(curve.at[SLOWEST], "structural_over_contact")
    yield curve.row(Statement, f"{text}{SLOWEST:g}", closely, SLOWEST, low=2 / 3, high=1.5, essential=False)
    for peclet in (0.22, 0.01):
        yield curve.row(Finding, f"{text}{peclet:g}", number(curve.at[peclet], "structural_over_contact"), peclet)
    text = "structural Brownian stress over contact stress without the control variate at Pe = 0.01"
    yield curve.row(Finding, text, number(curve.at[0.01], "structural_over_plain_contact"), 0.01)
    text = f"η_r of pairs at Pe = 0.01 over that at {SLOWEST:g}"
    kind, more, bounds = (Statement, ": still rising", {"low": 1}) if curve.fraction == 0.55 else (Finding, "", {})
    yield curve.row(kind, text + more, curve.ratio("pairs", 0.01, SLOWEST), 0.01, **bounds)


def rest_rows(curves):
    """Yields statements about the plateau at low Pe, by the exact viscosity at rest. Its bounds, 0.8 to 1.25, are twice
    the published errors of two points. Its height increases with the volume fraction."""
    rest, how = rows_at_rest()
    for fraction, curve in curves.items():
        if "by" in rest.get(fraction, {}) and fraction != 0.55:  # of linear response
            text = f"η_r of pairs at Pe = {SLOWEST:g} over that at rest ({how}): plateau"
            found = row_ratio(curve.at[SLOWEST], rest[fraction], "pairs")
            yield curve.row(Statement, text, found, SLOWEST, low=0.8, high=1.25)
    known = [f for f in FRACTIONS if f in rest]
    for low, high in zip(known, known[1:]):
        text = f"η_r of pairs at rest ({how}) over that at φ = {low:g}"
        yield curves[high].row(Statement, text, row_ratio(rest[high], rest[low], "pairs"), SLOWEST, low=1)


def high_rows(curves):
    """Yields statements about Pe = 10^4 against the same suspensions without noise."""
    table = read_rows(HERE / "table.csv")
    for fraction, curve in curves.items():
        bare = first(table, method=WITHOUT_NOISE, fraction=fraction)
        found = row_ratio(curve.at[1e4], bare, "pairs")
        yield curve.row(Statement, "η_r of pairs at Pe = 10⁴ over that without noise", found, low=0.9, high=1.1)
    noisy = read_rows(HERE.parent / "literature" / "peclet.csv")
    for fraction in FRACTIONS[:2]:
        wide = {r["peclet"]: r for r in where(noisy, fraction=fraction, gap=0.5)}
        text = f"φ = {fraction:g}, μ = 1, outer gap 0.5: lubrication at Pe = 10⁴ over that at 1"
        yield Finding(text, "literature", *row_ratio(wide[1e4], wide[1], "lubrication"), wide[1]["seeds"] - 1)


def comparison_rows(table):
    """Yields statements that viscosities do not depend on stiffness, particle number and method."""
    small = where(table, method="implicit", count=250)
    for row in where(small, fraction=0.5):
        if row["stiffness"] != 1e4:
            text = f"φ = 0.5, Pe = {row['peclet']:g}: η_r at k_n = {row['stiffness']:g} over that at 10⁴"
            ratio = row_ratio(row, first(small, fraction=0.5, stiffness=1e4, peclet=row["peclet"]), "viscosity")
            yield Statement(text, "L4.5b", *ratio, 0.95, 1.05, row["seeds"] - 1)
    for row in where(small, stiffness=1e4):
        text = f"φ = {row['fraction']:g}, Pe = {row['peclet']:g}: η_r with N = 1000 over that with 250"
        large = first(table, **USUAL, count=1000, fraction=row["fraction"], peclet=row["peclet"])
        yield Check(text, "N", *row_ratio(large, row, "viscosity"), 0.95, 1.05, row["seeds"] - 1)
    text = "φ = 0.45, Pe = 100, rate 0.045: η_r with implicit steps over that with explicit ones"
    implicit, explicit = (first(table, method=f"{m} at rate 0.045") for m in ("implicit", "explicit"))
    yield Check(text, "method", *row_ratio(implicit, explicit, "viscosity"), 0.9, 1.1, explicit["seeds"] - 1)


def curves_of_table():
    """Returns the curves with the most spheres, by volume fraction, and the table."""
    table = read_rows(HERE / "table.csv")
    rows = where(table, **USUAL)
    most = {f: max(row["count"] for row in where(rows, fraction=f, peclet=SLOWEST)) for f in FRACTIONS}
    return {f: Curve(where(rows, count=most[f]), f) for f in FRACTIONS}, table


def judge():
    curves, table = curves_of_table()
    for curve in curves.values():
        yield from shape_rows(curve)
        yield from low_rows(curve)
        yield from lubrication_rows(curve)
    yield from rest_rows(curves)
    yield from high_rows(curves)
    yield from comparison_rows(table)


def measure(program):
    if not program.long:
        print("flow-curve: rows are made of Pe = 0.046 and 0.01, too, which take an hour: say --long", file=sys.stderr)
        sys.exit(2)
    curves, bare = rows_of_curves(program), rows_without_noise(program)
    costs.write_curves(program.peclet, Path(program.folder))
    cases = [(0.5, k, p) for k in STIFFNESSES for p in STIFFNESS_PECLET] + [(0.45, 1e4, p) for p in (100, 1e4)]
    small = rows_of(program, "small", cases, 16)
    methods = {}
    for method in ("implicit", "explicit"):
        patch = {"limits": {"shear_rate": 0.045}, "integrator": {"method": method}}
        methods[method] = rows_of(program, method, [(0.45, 1e4, 100)], 6, patch)[0]

    table = [{"method": "implicit", "count": 1000, **r} for r in curves]
    table += [{"method": WITHOUT_NOISE, "count": 1000, **r} for r in bare]
    table += [{"method": "implicit", "count": 250, **r} for r in small]
    table += [{"method": f"{m} at rate 0.045", "count": 250, **r} for m, r in methods.items()]
    names = "method, count, fraction, stiffness, peclet, seeds, lost, transient, viscosity±, pairs±, lubrication±, "
    names += "contact±, controlled_contact±, structural±, structural_over_contact±, structural_over_plain_contact±"
    write_table(HERE / "table.csv", names, table, 4)


def draw_overview():
    """Draws η_r of the curves, with intervals of the points and bands; rest is at the left, no noise at the right."""
    figure = Figure(HERE / "overview.png", columns=1, size=(1000, 460))
    ends = {"x_range": (3.5e-3, 4e4), "y_range": (3, 130)}
    bare = {row["fraction"]: row for row in where(read_rows(HERE / "table.csv"), method=WITHOUT_NOISE)}
    titles = "Péclet number Pe = 6πηa³γ̇/kT", "relative viscosity η_r, with 1 + 2.5 φ"
    panel = figure.panel(*titles, log="xy", powers="x", **ends)
    table = read_rows(HERE / "curve.csv")
    for fraction, colour in ((0.55, GREEN), (0.5, RED), (0.45, BLUE)):
        rows = where(table, fraction=fraction)
        flowing = [row for row in rows if row["peclet"] > 0]
        panel.band([(row["peclet"], row["low"], row["high"]) for row in flowing], colour)
        points = [(row["peclet"], row["viscosity"], row["half_width"]) for row in flowing]
        panel.points(points, f"volume fraction φ = {fraction:.2f}", colour)
        panel.line([(row["peclet"], row["curve"]) for row in flowing], None, colour)
        rest = [(5e-3, row["viscosity"], row["half_width"]) for row in rows if row["peclet"] == 0]
        panel.points(rest, "left: at rest" if colour == BLUE else None, colour, 6)
        value, error = number(bare[fraction], "viscosity")
        half = t.ppf(0.975, bare[fraction]["seeds"] - 1) * error
        panel.points([(2.5e4, value, half)], "right: without noise" if colour == BLUE else None, colour, 4)
    figure.draw()


def draw():
    curves, _ = curves_of_table()
    draw_overview()
    terms = {
        "pairs": (BLACK, 7, "all pairs"),
        "controlled_contact": (RED, 5, "contact"),
        "lubrication": (BLUE, 9, "lubrication"),
        "structural": (GREEN, 4, "structural Brownian"),
    }
    figure = Figure(HERE / "chart.png", columns=3, size=(1400, 460))
    rest = table_at_rest()
    for fraction, largest in zip(FRACTIONS, (200, 400, 1200)):
        ends = {"x_range": (5e-3, 3e4), "y_range": (0.1, largest)}
        panel = figure.panel("Pe", "σ / (η γ̇)", f"φ = {fraction:g}", log="xy", powers="x", **ends)
        for name, (colour, mark, title) in terms.items():
            panel.rows(curves[fraction].at.values(), "peclet", name, title, colour, mark, 0.8, joined=True)
        panel.level(diverging(fraction, JAMMED_AT_REST), "published fits of both ends", GREY, (5e-3, 0.02), width=3)
        panel.level(diverging(fraction, JAMMED_IN_STRONG_FLOW), None, GREY, (3e3, 3e4), width=3)
        if fraction in rest:
            recipe = rest[fraction]["viscosity"]
            panel.level(recipe, "integral of it at rest (zero-shear)", GREEN, (5e-3, 0.1), width=2, dash=2)
    figure.draw()


def quick_measure(program):
    parts = during({"brownian_times": 10}, {"brownian_times": 20, "strain": 3})
    cases = [(0.5, 1e4, p) for p in (0.22, 4.6, 1e4)]
    low, middle, high = rows_of(program, "quick", cases, 8, {"particles": {"count": 100}, **parts})
    for text, found, least, most in (
        ("η_r of pairs at Pe = 10⁴ over that at 4.6 (thickening)", row_ratio(high, middle, "pairs"), 1.1, 2.5),
        ("η_r of pairs at Pe = 4.6", number(middle, "pairs"), 4, 10),
        ("lubrication at Pe = 4.6 over that at 10⁴", row_ratio(middle, high, "lubrication"), 0.1, 0.8),
        (
            "structural Brownian stress over contact stress at Pe = 0.22",
            number(low, "structural_over_contact"),
            0.25,
            2,
        ),
    ):
        yield Statement(f"φ = 0.5: {text}", "L4.5b", *found, least, most, 7)


main(HERE, TITLE, measure, quick_measure, judge, draw)
