#!/usr/bin/python3
"""Flow curves with friction, and with a repulsion whose strength is a multiple of kT."""
import math
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from studies.driver import BLUE, Check, Figure, Finding, GREEN, ORANGE, RED, Statement, TABLE_SCENE, decades_of_rise
from studies.driver import difference, during, first, in_strains, log_of_share, main, merged, number, propagated
from studies.driver import propagated_lists, quotient, read_rows, row_ratio, thickening_decades, viscosity_row, where
from studies.driver import write_table
import numpy as np

TITLE = "Friction and repulsion in flow curves"
PECLET = (4.6, 10, 22, 100, 460, 1e3, 2200, 1e4, 4.6e4, 1e5, 1e6)
SLOW = 1  # Peclet number at which friction should not matter; only for A = 0, with more seeds
FRICTIONS, STRENGTHS = (0, 0.1, 0.5, 1), (0, 1, 100, 1000)
# Curves: volume fraction, friction, repulsion over kT.
CURVES = [
    *((0.5, m, 0) for m in FRICTIONS),
    *((0.5, m, a) for m in (0.5, 1) for a in STRENGTHS[1:]),
    *((f, 0.5, a) for f in (0.45, 0.53) for a in (0, 100, 1000)),
]
SCENE = merged(
    TABLE_SCENE,
    during({"strain": 2, "brownian_times": 25}, {"strain": 4, "brownian_times": 30}),
    contact={"friction": 0},
    repulsion={"form": "exponential", "strength": 0},
)
SEEDS, SLOW_SEEDS, METHOD_SEEDS = 5, 8, 18
# Curves with more seeds, for the decades of thickening and the width that a repulsion leaves.
MORE, MORE_SEEDS = [*((0.5, m, 0) for m in (0.5, 1)), *((0.53, 0.5, a) for a in (0, 100, 1000))], 12
# Curves with contacts four times as stiff, which move a thickening that softness brings about.
STIFFER, STIFFER_NAME, STIFFER_STRENGTHS = 4, "four times k_n", (0, 100)
# Largest rate, largest kT, eta, and the decay length of the repulsion of two unit spheres.
RATE, THERMAL_ENERGY, VISCOSITY, LENGTH = 0.009, 0.017, 0.1, 0.02
# Published thickening: volume fraction, friction, figure.
THICKENING = ((0.5, 0.5, "L4.9b"), (0.5, 1, "L4.9d"), (0.45, 0.5, "L4.9c"), (0.53, 0.5, "L4.9c"))


def thermal_energy(peclet):
    """Returns the kT of a scene with this `peclet` and the limits of the table."""
    return min(THERMAL_ENERGY, 6 * math.pi * VISCOSITY * RATE / peclet)


def measured(program, name, cases, seeds, patch=None):
    """Returns rows for cases (volume fraction, friction, strength over kT, Peclet number)."""
    pointers = "/volume_fraction", "/contact/friction", "/repulsion/strength", "/peclet"
    settings = [dict(zip(pointers, (f, m, a * thermal_energy(p), p))) for f, m, a, p in cases]
    points = program.run(name, merged(SCENE, patch or {}), settings, seeds)
    return [row_of(case, point) for case, point in zip(cases, points)]


def row_of(case, point):
    row = dict(zip(("fraction", "friction", "strength", "peclet"), case)) | viscosity_row(point)
    row["stress"] = row["pairs"] * row["peclet"] / (6 * math.pi)  # sigma a^3 / kT
    # sigma a^2 kappa / A
    row["stress_over_repulsion"] = row["stress"] * LENGTH / row["strength"] if row["strength"] else math.nan
    return row


def curve_of(rows, *case):
    """Returns the rows of a volume fraction, a friction coefficient and a strength of the repulsion."""
    chosen = where(rows, **dict(zip(("fraction", "friction", "strength"), case)))
    return sorted(chosen, key=lambda r: r["peclet"])


def common(curve):
    """Returns the rows of a curve at the Peclet numbers that all curves have."""
    return [row for row in curve if row["peclet"] in PECLET]


def of_curve(curve, function):
    """Returns function(Peclet numbers, viscosities of pairs) of a curve, and its standard error."""
    x = [r["peclet"] for r in curve]
    return propagated([number(r, "pairs") for r in curve], lambda values: function(x, values))


def middle(curve):
    """Returns log10 Pe of the middle of the thickening."""
    return of_curve(curve, lambda x, values: log_of_share(x, values, 0.5))


def width(curve):
    """Returns the width of the thickening [decades], from 0.1 to 0.9 of its rise."""
    return of_curve(curve, decades_of_rise)


def ratio_of(a, b):
    return row_ratio(a, b, "pairs")


def plateau(curve, share):
    """Returns the decades of Pe around the minimum in which the viscosity is within `share` of it. Logarithms are
    interpolated linearly."""

    def decades(abscissae, values):
        x, logs = np.log10(abscissae), np.log(np.maximum(values, 1e-9))
        fine = np.linspace(x[0], x[-1], 2001)
        return float((np.interp(fine, x, logs) <= logs.min() + math.log1p(share)).mean() * (x[-1] - x[0]))

    return of_curve(curve, decades)


def friction_rows(rows, degrees):
    smooth = {r["peclet"]: r for r in curve_of(rows, 0.5, 0, 0)}
    for friction in FRICTIONS[1:]:
        rough = {r["peclet"]: r for r in curve_of(rows, 0.5, friction, 0)}
        name = f"φ = 0.5, A = 0: η_r of pairs with μ = {friction} over that without"
        slow = ratio_of(rough[SLOW], smooth[SLOW])
        yield Statement(f"{name}, Pe = 1", "L4.9b", *slow, 0.9, 1.1, rough[SLOW]["seeds"] - 1)
        fast = ratio_of(rough[1e4], smooth[1e4])
        yield Statement(f"{name}, Pe = 10⁴", "L4.9b", *fast, low=1, degrees=degrees)
    for a, b in zip(FRICTIONS[1:], FRICTIONS[2:]):
        text = f"φ = 0.5, A = 0, Pe = 10⁶: η_r of pairs with μ = {b} over that with {a}"
        ratio = ratio_of(*(curve_of(rows, 0.5, friction, 0)[-1] for friction in (b, a)))
        yield Statement(text, "L4.9b", *ratio, low=1, degrees=degrees)
    for low, high in ((0.45, 0.5), (0.5, 0.53)):
        text = f"μ = 0.5, A = 0: η_r at Pe = 10⁶ over its least, φ = {high:g} over that at {low:g}"
        curves = (common(curve_of(rows, f, 0.5, 0)) for f in (high, low))
        grown = quotient(*(of_curve(curve, lambda x, values: values[-1] / min(values)) for curve in curves))
        yield Statement(text, "L4.9c", *grown, low=1, degrees=degrees)


def thickening_rows(rows, fraction, friction, source, degrees):
    name = f"φ = {fraction:g}, μ = {friction}"
    bare = curve_of(rows, fraction, friction, 0)
    if fraction == 0.5:
        # Print does not say where its decades begin and end.
        for share in (0.95, 0.99):
            text = f"{name}, A = 0: decades of Pe from the minimum to {share:.0%} of the thickening (published: 4 to 5)"
            found = of_curve(bare, lambda x, values, share=share: thickening_decades(x, values, share))
            yield Finding(text.replace("%", " %", 1), source, *found, degrees)
        text = f"{name}, A = 0: decades of Pe from a tenth to nine tenths of the thickening"
        yield Finding(text, source, *width(bare), degrees)
    for strength in (1, 100, 1000):
        repelled = curve_of(rows, fraction, friction, strength)
        if not repelled:
            continue
        text = f"with A = {strength} kT less that with A = 0, decades of Pe"
        for what, function, bound in (("width", width, {"high": 0}), ("middle of the thickening", middle, {"low": 0})):
            kind, bounds = (Finding, {}) if strength == 1 else (Statement, bound)
            moved = difference(function(repelled), function(bare))
            yield kind(f"{name}: {what} {text}", source, *moved, degrees=degrees, **bounds)


def plateau_rows(rows, degrees):
    """Yields rows about the plateau. Print does not say where it ends; a tenth is the published error of a point.
    Without repulsion it may extend below Pe = 1, where the curve ends."""
    repelled, bare = (curve_of(rows, 0.5, 1, strength) for strength in (1000, 0))
    for share, words in ((0.1, "a tenth"), (0.5, "a half")):
        text = f"φ = 0.5, μ = 1: decades of Pe within {words} of the minimum, A = 1000 kT less A = 0: a broader plateau"
        broader = difference(plateau(repelled, share), plateau(bare, share))
        yield Statement(text, "L 7", *broader, low=0, degrees=degrees, essential=False)


def stress_rows(rows, degrees):
    """Yields findings about the stress of the thickening; the unit of stress of the figure is not published."""

    def middle_stress(fraction, friction, strength):
        """Returns log10 of the stress in the middle of the thickening, in units of A / (a^2 kappa)."""
        scale = LENGTH / strength

        def place(x, values):
            return log_of_share(np.array(values) * x / (6 * math.pi) * scale, values, 0.5)

        return of_curve(curve_of(rows, fraction, friction, strength), place)

    for case in ((0.45, 0.5), (0.5, 0.5), (0.5, 1), (0.53, 0.5)):
        less = difference(*(middle_stress(*case, strength) for strength in (1000, 100)))
        name = "φ = {:g}, μ = {:g}".format(*case)
        text = f"{name}: log10 of σ a² κ / A in the middle of the thickening, A = 1000 kT less 100 kT"
        yield Finding(f"{text} (0: the repulsion alone sets the stress)", "L4.9d", *less, degrees)


def pressed(row, factor=1):
    """Returns σa² of a row over sqrt(k_n kT), the force that thermal overlaps need; k_n is that of the table times
    `factor`."""
    energy = thermal_energy(row["peclet"])
    stress = row["viscosity"] * row["peclet"] * energy / (6 * math.pi)
    return stress / math.sqrt(factor * SCENE["contact"]["normal_stiffness"] * energy)


def shares(values, bare):
    """Returns ln(η_r/η_r without friction) along a curve, over that at its end."""
    effect = np.log(np.divide(values, bare))
    return effect / effect[-1]


def viscosities(*curves):
    return [[number(row, "viscosity") for row in curve] for curve in curves]


def onset_rows(rows, degrees):
    """Yields findings about the stress at which friction has half of its effect, by straight lines over ln stress."""
    smooth = common(curve_of(rows, 0.5, 0, 0))
    for friction in FRICTIONS[1:]:
        curve = common(curve_of(rows, 0.5, friction, 0))
        places = np.log([pressed(row) for row in curve])
        half = propagated_lists(
            viscosities(curve, smooth), lambda v, at=places: float(np.exp(np.interp(0.5, shares(*v), at)))
        )
        text = f"φ = 0.5, μ = {friction}, A = 0: σa²/√(k_n kT) at half of the effect of friction"
        yield Finding(text, "stiffness", *half, degrees)


def stiffness_rows(rows, stiffer, degrees):
    """Yields findings about contacts four times as stiff. Without a repulsion friction sets in where the force on a
    pair, about σa², is a given part of that of thermal overlaps, sqrt(k_n kT)."""
    name = "φ = 0.5, μ = 1"
    for strength in STIFFER_STRENGTHS:
        soft, stiff = (curve_of(of, 0.5, 1, strength) for of in (rows, stiffer))
        text = f"{name}, A = {strength} kT: middle of the thickening with 4 k_n less that with k_n, decades of Pe"
        yield Finding(text, "stiffness", *difference(middle(stiff), middle(soft)), degrees)
    bare, repelled = (curve_of(stiffer, 0.5, 1, strength) for strength in STIFFER_STRENGTHS)
    for what, function in (("width", width), ("middle", middle)):
        text = f"{name}, 4 k_n: {what} of the thickening with A = {STIFFER_STRENGTHS[1]} kT less that with A = 0"
        yield Finding(f"{text}, decades of Pe", "stiffness", *difference(function(repelled), function(bare)), degrees)
    smooth, soft, stiff = (common(curve_of(*of)) for of in ((rows, 0.5, 0, 0), (rows, 0.5, 1, 0), (stiffer, 0.5, 1, 0)))
    numbers = viscosities(smooth, soft, stiff)

    def later(values):
        return float(np.subtract(*(np.interp(0.5, shares(of, values[0]), np.log10(PECLET)) for of in values[:0:-1])))

    text = f"{name}, A = 0: half of the effect of friction with 4 k_n less that with k_n, decades of Pe"
    yield Finding(text, "stiffness", *propagated_lists(numbers, later), degrees)
    places = [np.log([pressed(row, factor) for row in of]) for of, factor in ((soft, 1), (stiff, STIFFER))]
    for peclet in (100, 1e3, 1e4):
        k = PECLET.index(peclet)
        for how, at in (("Pe", True), ("σa²/√(k_n kT)", False)):

            def less(values, k=k, at=at):
                share, then = (shares(of, values[0]) for of in values[1:])
                return float(then[k] - (share[k] if at else np.interp(places[1][k], places[0], share)))

            text = f"Pe = {peclet:g}: share of the effect of friction with 4 k_n less that with k_n at the same {how}"
            yield Finding(f"{name}, A = 0, {text}", "stiffness", *propagated_lists(numbers, less), degrees)


def judge():
    table = read_rows(HERE / "table.csv")
    rows = where(table, method="implicit")
    degrees = min(r["seeds"] for r in rows) - 1
    yield from friction_rows(rows, degrees)
    for case in THICKENING:
        yield from thickening_rows(rows, *case, degrees)
    yield from plateau_rows(rows, degrees)
    yield from stress_rows(rows, degrees)
    yield from onset_rows(rows, degrees)
    yield from stiffness_rows(rows, where(table, method=STIFFER_NAME), degrees)
    text = "φ = 0.5, μ = 0.5, A = 1000 kT, Pe = 10⁴: η_r with implicit steps over that with explicit ones"
    methods = [first(table, method=f"{m} at rate 0.045") for m in ("implicit", "explicit")]
    yield Check(text, "method", *row_ratio(*methods, "viscosity"), 0.9, 1.1, methods[1]["seeds"] - 1)


def measured_method(program, method):
    """Returns the row of a method at five times the rate and kT, where explicit steps cost a fifth."""
    fast = {"limits": {"shear_rate": 0.045}, "contact": {"friction": 0.5}, "integrator": {"method": method}}
    scene = merged(SCENE, fast, in_strains(1, 2), repulsion={"strength": 1000 * thermal_energy(1e4) * 5})
    (point,) = program.run(method, scene, [{"/peclet": 1e4}], METHOD_SEEDS)
    row = row_of((0.5, 0.5, 1000, 1e4), point)
    # The table has no stresses for these rows.
    del row["stress"], row["stress_over_repulsion"]
    return row


def measure(program):
    others = [c for c in CURVES if c not in MORE]
    rows = measured(program, "friction-repulsion", [(*c, p) for c in others for p in PECLET], SEEDS)
    rows += measured(program, "more", [(*c, p) for c in MORE for p in PECLET], MORE_SEEDS)
    rows += measured(program, "slow", [(0.5, m, 0, SLOW) for m in FRICTIONS], SLOW_SEEDS)
    stiff = {"contact": {"normal_stiffness": STIFFER * SCENE["contact"]["normal_stiffness"]}}
    cases = [(0.5, 1, a, p) for a in STIFFER_STRENGTHS for p in PECLET]
    stiffer = measured(program, "stiffer", cases, SEEDS, stiff)
    methods = {m: measured_method(program, m) for m in ("implicit", "explicit")}
    table = [{"method": "implicit", **r} for r in rows]
    table += [{"method": STIFFER_NAME, **r} for r in stiffer]
    table += [{"method": f"{m} at rate 0.045", **r} for m, r in methods.items()]
    names = "method, fraction, friction, strength, peclet, seeds, lost, transient, viscosity±, pairs±, lubrication±, "
    write_table(HERE / "table.csv", names + "contact±, repulsion±, stress, stress_over_repulsion", table, 4)


def draw():
    table = read_rows(HERE / "table.csv")
    rows, stiffer = where(table, method="implicit"), where(table, method=STIFFER_NAME)
    figure = Figure(HERE / "chart.png", columns=3, rows=2, size=(1600, 900))
    colours = (BLUE, GREEN, ORANGE, RED)

    def panel(curves, title, x, label, x_range, y_range):
        ends = {"x_range": x_range, "y_range": y_range, "key": "top left"}
        axes = figure.panel(label, "η_r of pairs", title, log="xy", powers="x", **ends)
        for case, name, colour, mark in curves:
            axes.rows(curve_of(rows, *case), x, "pairs", name, colour, mark, 0.8, joined=True)

    ends = "Pe", (0.5, 2e6), (2, 300)
    rough = [((0.5, m, 0), f"μ = {m}", c, 7) for m, c in zip(FRICTIONS, colours)]
    panel(rough, "friction: φ = 0.5, A = 0", "peclet", *ends)
    repelled = [((0.5, 0.5, a), f"A = {a} kT", c, 7) for a, c in zip(STRENGTHS, colours)]
    panel(repelled, "repulsion: φ = 0.5, μ = 0.5", "peclet", *ends)
    packed = [
        ((f, 0.5, a), f"φ = {f:g}, A = {a} kT", c, mark)
        for f, mark in ((0.53, 4), (0.5, 7), (0.45, 9))
        for a, c in ((0, BLUE), (1000, RED))
    ]
    panel(packed, "volume fractions: μ = 0.5", "peclet", "Pe", (0.5, 2e6), (1, 2000))
    stressed = [((0.5, 1, a), f"A = {a} kT", c, 7) for a, c in zip(STRENGTHS, colours)]
    panel(stressed, "over stress: φ = 0.5, μ = 1", "stress", "σ a³ / kT of the pairs", (0.1, 1e7), (2, 300))
    ends = {"x_range": (0.5, 2e6), "y_range": (2, 300), "key": "top left"}
    axes = figure.panel("Pe", "η_r of pairs", "stiffness: φ = 0.5, μ = 1", log="xy", powers="x", **ends)
    for strength, colour in zip(STIFFER_STRENGTHS, (BLUE, ORANGE)):
        for of, name, mark in ((rows, "k_n", 7), (stiffer, "4 k_n", 4)):
            title = f"A = {strength} kT, {name}"
            axes.rows(curve_of(of, 0.5, 1, strength), "peclet", "pairs", title, colour, mark, 0.8, joined=True)
    ends = {"x_range": (3e-4, 10), "y_range": (-0.05, 1.1), "key": "top left"}
    axes = figure.panel(
        "σ a² / (k_n kT)^{1/2}", "share of the effect of friction", "stiffness: φ = 0.5, μ = 1, A = 0", log="x", **ends
    )
    smooth = common(curve_of(rows, 0.5, 0, 0))
    for of, name, factor, mark in ((rows, "k_n", 1, 7), (stiffer, "4 k_n", STIFFER, 4)):
        curve = common(curve_of(of, 0.5, 1, 0))
        found = [
            propagated_lists(viscosities(curve, smooth), lambda v, k=k: float(shares(*v)[k])) for k in range(len(curve))
        ]
        points = [(pressed(row, factor), *share) for row, share in zip(curve, found)]
        axes.points(points, name, BLUE, mark, joined=True)
    figure.draw()


def quick_measure(program):
    cases = [(0.5, 0, 0, 1e4), (0.5, 1, 0, 1e4), (0.5, 1, 1000, 1e4), (0.5, 0, 0, 1), (0.5, 1, 0, 1)]
    parts = during({"strain": 1, "brownian_times": 5}, {"strain": 3, "brownian_times": 10})
    smooth, rough, repelled, *slow = measured(program, "quick", cases, 8, {"particles": {"count": 100}, **parts})
    text = "η_r of pairs with μ = 1 over that without"
    yield Statement(f"φ = 0.5, Pe = 10⁴: {text}", "L4.9b", *ratio_of(rough, smooth), 2, 12, 7)
    of_repulsion = "φ = 0.5, Pe = 10⁴, μ = 1: η_r of pairs with A = 1000 kT over that with A = 0"
    yield Statement(of_repulsion, "L4.9b", *ratio_of(repelled, rough), 0.05, 0.8, 7)
    yield Statement(f"φ = 0.5, Pe = 1: {text}", "L4.9b", *ratio_of(*slow[::-1]), 0.5, 1.6, 7)


main(HERE, TITLE, measure, quick_measure, judge, draw)
