#!/usr/bin/python3
"""Viscosity against inertia: without noise, and with thermal motion."""
import math
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from studies.driver import BLUE, Check, DENSITY, Figure, Finding, GREEN, ORANGE, PURPLE, RED, REFERENCE_SCENE, STIFFNESS
from studies.driver import Statement, TABLE_4_1, VISCOSITY, counts_text, first, flags, in_brownian_times, in_strains
from studies.driver import line_through, main, mari_fit, merged, over, quotient, read_rows, weighted_mean, where
from studies.driver import write_rows
import numpy as np

TITLE = "Viscosity and inertia"
THERMAL_ENERGY, RATE = 0.017, 0.045
FLAT = 0.1  # relative change that is not visible in published curves on logarithmic axes

# Without noise tau_I / tau_S = rho a^2 rate / eta is varied by the density alone, which keeps the hardness of spheres.
FLOW_BOUND = 0.1
STOKES = (0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10)
SMALL = {"particles": {"count": 250}}
FLOW = merged(REFERENCE_SCENE, SMALL, volume_fraction=0.55, flow={"shear_rate": RATE})

# Noise: tau_I / tau_B = rho kT / (eta^2 a) is varied by the density, too; tau_I / tau_S = Pe / (6 pi) tau_I / tau_B
# stays below 0.01. Runs: Pe, seeds, values of tau_I / tau_B, durations.
THERMAL_BOUND = 0.01
WIDE_BOUND = 6 * math.pi * THERMAL_BOUND
THERMAL_RUNS = (
    (0.1, 128, (0.01, 1.8), in_brownian_times(20, 30)),
    (0.3, 32, (0.01, 0.1, 0.6), in_brownian_times(20, 30)),
    (1, 24, (0.001, 0.003, 0.01, 0.03, 0.18), in_brownian_times(5, 30)),
    (10, 64, (0.001, 0.003, 0.01, 0.018), in_strains(1, 3)),
)
THERMAL = merged(REFERENCE_SCENE, SMALL, volume_fraction=0.45, fluid={"thermal_energy": THERMAL_ENERGY})


def row_of(point, curve, ratio):
    row = {"curve": curve, "ratio": ratio, "seeds": len(point.results), "lost": point.lost}
    row["flags"] = counts_text(flags(point))
    return row | dict(zip(("viscosity", "standard_error"), point.measured("relative_viscosity_pair")))


def flow_rows(program, ratios, seeds, patch=None, name="flow", window=6):
    """Returns rows by tau_I / tau_S. The equilibration grows with the inertial time."""
    settings = [
        {"/particles/density": stokes * VISCOSITY / RATE, "/duration": in_strains(2 + stokes, window)["duration"]}
        for stokes in ratios
    ]
    points = program.run(name, merged(FLOW, patch or {}), settings, seeds)
    return [row_of(point, "flow", stokes) for stokes, point in zip(ratios, points)]


def thermal_scene(number, parts, patch=None):
    rate = number * THERMAL_ENERGY / (6 * math.pi * VISCOSITY)
    return merged({**THERMAL, "flow": {"shear_rate": rate}, **parts}, patch or {})


def density_at(ratio):
    """Returns the density that gives tau_I / tau_B."""
    return ratio * VISCOSITY**2 / THERMAL_ENERGY


def thermal_rows(program, number, seeds, ratios, parts, patch=None, name=None):
    settings = [{"/particles/density": density_at(r)} for r in ratios]
    points = program.run(name or f"thermal-{number:g}", thermal_scene(number, parts, patch), settings, seeds)
    return [row_of(point, f"Pe {number:g}", r) for r, point in zip(ratios, points)]


def measured(row):
    return row["viscosity"], row["standard_error"]


def mean_of(rows):
    return weighted_mean(*zip(*map(measured, rows)))


def ratio_of(a, b):
    return quotient(measured(a), measured(b))


def change_of(row, flat):
    """Returns the viscosity of a row over a number, minus 1."""
    value, error = quotient(measured(row), flat)
    return value - 1, error


def flat_part(rows, bound):
    """Returns the rows up to the bound, and their weighted mean."""
    below = [r for r in rows if r["ratio"] <= bound * (1 + 1e-9)]
    return below, mean_of(below)


def furthest(rows):
    """Returns the row that is furthest from the weighted mean of the others, and its ratio to that mean, minus 1."""
    found = [(row, change_of(row, mean_of([r for r in rows if r is not row]))) for row in rows]
    return max(found, key=lambda f: abs(f[1][0]))


def change(rows):
    """Returns the change of ln eta_r over the range of rows, from a line through ln eta_r against ln ratio."""
    x = np.log([r["ratio"] for r in rows])
    values, errors = np.array([measured(r) for r in rows]).T
    _, slope, error = line_through(x, np.log(values), errors / values)
    return slope * (x[-1] - x[0]), error * (x[-1] - x[0])


def leaves(rows, flat):
    """Returns log10 of the ratio at which the viscosity first differs from its flat value by FLAT; NaN if nowhere."""
    x = np.log10([r["ratio"] for r in rows])
    values, errors = np.array([quotient(measured(r), flat) for r in rows]).T
    off, errors = abs(np.log(values)), errors / values
    level = math.log(1 + FLAT)
    for k in range(1, len(rows)):
        if off[k - 1] < level <= off[k]:
            step, rise = x[k] - x[k - 1], off[k] - off[k - 1]
            place = (level - off[k - 1]) / rise
            return x[k - 1] + place * step, step * math.hypot((1 - place) * errors[k - 1], place * errors[k]) / rise
    return math.nan, math.nan


def leaving_row(kind, text, source, row, flat, **more):
    """Returns a row about the deviation of a viscosity from its flat value."""
    value, error = change_of(row, flat)
    text = f"{text}: η_r over its flat value, less 1, without its sign"
    return kind(text, source, abs(value), error, degrees=row["seeds"] - 1, **more)


def flow_judged(rows):
    below, flat = flat_part(rows, FLOW_BOUND)
    degrees = rows[0]["seeds"] - 1
    row, found = furthest(below)
    text = "φ = 0.55, no noise: η_r over that of the others, less 1, where it differs most of all τ_I/τ_S ≤ 0.1"
    yield Statement(f"{text} (at {row['ratio']:g})", "L4.6a", *found, -FLAT, FLAT, degrees)
    text = "change of ln η_r from τ_I/τ_S = 0.005 to 0.1, by a line"
    yield Statement(text, "L4.6a", *change(below), -FLAT, FLAT, degrees)
    yield leaving_row(Statement, f"τ_I/τ_S = {rows[-1]['ratio']:g}", "L4.6a", rows[-1], flat, low=FLAT)
    place, error = leaves(rows, flat)
    text = f"log10 of τ_I/τ_S where η_r is 10 % off its flat value ({10**place:.2g}; published: not below 0.1)"
    yield Statement(text, "L4.6a", place, error, math.log10(FLOW_BOUND), degrees=degrees)


def thermal_judged(curves):
    for number, rows in curves.items():
        below, _ = flat_part(rows, THERMAL_BOUND)
        degrees = rows[0]["seeds"] - 1
        if len(below) > 1:
            row, found = furthest(below)
            text = f"φ = 0.45, Pe = {number:g}: the same where it differs most of all τ_I/τ_B ≤ 0.01"
            yield Statement(f"{text} (at {row['ratio']:g})", "L4.6b", *found, -FLAT, FLAT, degrees)
            text = f"Pe = {number:g}: change of ln η_r from τ_I/τ_B = {below[0]['ratio']:g} to 0.01, by a line"
            yield Statement(text, "L4.6b", *change(below), -FLAT, FLAT, degrees)
    # "Only when > 0.01" is published, and holds if the curve is flat below; with 6πηa³/kT, the other Brownian time of
    # the thesis, below WIDE_BOUND. Where the flat part ends is not published.
    for number in sorted(curves):
        last = curves[number][-1]
        flat = flat_part(curves[number], THERMAL_BOUND)[1]
        kind, bounds = (Statement, {"high": FLAT}) if last["ratio"] <= WIDE_BOUND else (Finding, {})
        yield leaving_row(kind, f"Pe = {number:g}, τ_I/τ_B = {last['ratio']:g}", "L4.6b", last, flat, **bounds)


def comparison(text, implicit, explicit, what="implicit steps over that by explicit ones"):
    ratio = ratio_of(implicit, explicit)
    return Check(f"{text}: η_r by {what}", "method", *ratio, 1 - FLAT, 1 + FLAT, explicit["seeds"] - 1)


def groups_of_table():
    """Yields statements about the published Table 4.1, a = 1: its Peclet numbers, and the published conditions on time
    scales."""
    off = max(abs(6 * math.pi * VISCOSITY * rate / energy / number - 1) for number, rate, energy in TABLE_4_1)
    text = "Table 4.1: 6πηa³γ̇/kT over the printed Pe, less 1, where it differs most (two digits are printed)"
    yield Statement(text, "L 3.8", off, 0, 0, 0.05)
    inertial, contact = DENSITY / VISCOSITY, math.sqrt(DENSITY / STIFFNESS)
    least = min(min(inertial, VISCOSITY / energy, 1 / rate) for _, rate, energy in TABLE_4_1)
    text = "Table 4.1: τ_C over the least of the other times (published: an order of magnitude less)"
    yield Statement(text, "L 3.8", contact / least, 0, 0, 0.1)
    thermal = inertial / max(VISCOSITY / energy for number, _, energy in TABLE_4_1 if number <= 1)
    # The thesis has two Brownian times, η a³ / kT (3.57) and one with 6π (2.3).
    for words, factor in (("", 1), (" with 6πηa³/kT", 6 * math.pi)):
        text = f"Table 4.1, Pe ≤ 1: τ_I/τ_B{words} (published: below 0.01 in what follows)"
        yield Statement(text, "L 4.2.4", thermal / factor, 0, high=THERMAL_BOUND, essential=factor > 1)
    text = "Table 4.1: largest τ_I/τ_S, at a rate of 0.009 (published: below 0.1)"
    yield Statement(text, "L 4.2.4", inertial * max(rate for _, rate, _ in TABLE_4_1), 0, high=FLOW_BOUND)


def judge():
    table = read_rows(HERE / "table.csv")

    def curve(name, method="implicit"):
        return where(table, curve=name, method=method)

    flow, curves = curve("flow"), {run[0]: curve(f"Pe {run[0]:g}") for run in THERMAL_RUNS}
    yield from flow_judged(flow)
    yield from thermal_judged(curves)
    yield from groups_of_table()
    for row in curve("flow", "explicit"):
        yield comparison(f"τ_I/τ_S = {row['ratio']:g}", first(flow, ratio=row["ratio"]), row)
    yield comparison("Pe = 1, τ_I/τ_B = 0.18", first(curves[1], ratio=0.18), curve("Pe 1", "explicit")[0])
    of_step = "the automatic step over that by a quarter of it"
    (fine,) = curve("Pe 10", "implicit, a quarter of the step")
    yield comparison("Pe = 10, τ_I/τ_B = 0.001", first(curves[10], ratio=0.001), fine, of_step)


def measure(program):
    flow = flow_rows(program, STOKES, 24)
    curves = {run[0]: thermal_rows(program, *run) for run in THERMAL_RUNS}
    # At the smallest inertia: a quarter of the automatic step, because explicit steps take too long.
    number, seeds, _, parts = THERMAL_RUNS[-1]
    lightest = thermal_scene(number, parts, {"particles": {"density": density_at(0.001)}})
    quarter = {"integrator": program.part_of_step(0.25, lightest)}
    fine = thermal_rows(program, number, seeds, (0.001,), parts, quarter, "thermal-fine")
    explicit = {"integrator": {"method": "explicit"}}
    flow_explicit = flow_rows(program, (0.1, 10), 12, explicit, "flow-explicit")
    thermal_explicit = thermal_rows(program, 1, 8, (0.18,), in_brownian_times(5, 20), explicit, "thermal-explicit")
    by_method = {
        "implicit": [*flow, *(r for rows in curves.values() for r in rows)],
        "implicit, a quarter of the step": fine,
        "explicit": [*flow_explicit, *thermal_explicit],
    }
    table = [{"method": method, **row} for method, rows in by_method.items() for row in rows]
    write_rows(HERE / "table.csv", table, 5)


def draw():
    table = read_rows(HERE / "table.csv")

    def bars(name, method="implicit"):
        return [(r["ratio"], r["viscosity"], 2 * r["standard_error"]) for r in where(table, curve=name, method=method)]

    figure = Figure(HERE / "chart.png", columns=2)
    name = "η_r of the pairs"
    ends = {"x_range": (0.003, 20), "y_range": (15, 100), "powers": "x", "key": "top left"}
    panel = figure.panel("τ_I / τ_S", name, "φ = 0.55, no noise", log="xy", **ends)
    panel.upright(FLOW_BOUND)
    panel.text("published: flat", 0.09, 17, "right")
    flow = where(table, curve="flow", method="implicit")
    panel.level(flat_part(flow, FLOW_BOUND)[1][0], "mean up to 0.1", dash=2)
    panel.points(bars("flow"), "implicit steps", BLUE)
    panel.points(bars("flow", "explicit"), "explicit steps", RED, mark=4, size=1.6)
    ends = {"x_range": (0.0005, 4), "y_range": (0, 7)}
    panel = figure.panel("τ_I / τ_B", name, "φ = 0.45", log="x", powers="x", key="top left", **ends)
    for bound, words in ((THERMAL_BOUND, "published: flat"), (WIDE_BOUND, "with 6π")):
        panel.upright(bound)
        panel.text(words, 0.9 * bound, 0.4, "right")
    for (number, *_), colour in zip(THERMAL_RUNS, (PURPLE, BLUE, GREEN, ORANGE)):
        panel.points(bars(f"Pe {number:g}"), f"Pe = {number:g}", colour, joined=True)
    panel.points(bars("Pe 1", "explicit"), "Pe = 1, explicit steps", RED, mark=4, size=1.6)
    figure.draw()


def quick_measure(program):
    small = {"particles": {"count": 100}}
    slow, flat, fast = flow_rows(program, (0.005, 0.1, 5), 8, small, window=3)
    little, more = thermal_rows(program, 1, 8, (0.001, 0.01), in_brownian_times(3, 10), small)
    of_fit = over((flat["viscosity"] + 1 + 2.5 * 0.55, flat["standard_error"]), mari_fit(0.55, 0))
    for text, source, found, least, most in (
        ("η_r at τ_I/τ_S = 0.1 over that at 0.005", "L4.6a", ratio_of(flat, slow), 0.7, 1.4),
        ("η_r at τ_I/τ_S = 5 over that at 0.1", "L4.6a", ratio_of(fast, flat), 1 + FLAT, math.inf),
        ("η_r with solvent and stresslet over Mari's fit", "M table 1", of_fit, 0.7, 1.3),
        ("Pe = 1: η_r at τ_I/τ_B = 0.01 over that at 0.001", "L4.6b", ratio_of(more, little), 0.5, 2),
        ("Pe = 1: η_r is below that of Pe = 10^4", "L4.9a", measured(more), 1, 6.11),
    ):
        yield Statement(text, source, *found, least, most, 7)


main(HERE, TITLE, measure, quick_measure, judge, draw)
