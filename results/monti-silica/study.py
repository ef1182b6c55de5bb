#!/usr/bin/python3
"""Flow curves of silica spheres with repulsion and attraction at two salt contents (Monti et al. 2021, Fig. 8)."""
import math
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from studies.driver import BLUE, Check, Figure, Finding, GREEN, GREY, ORANGE, PURPLE, RED, Statement, flags, in_strains
from studies.driver import logarithm, main, mari_fit, merged, number, over, propagated, read_numbers, read_rows
from studies.driver import relative_difference, row_ratio, viscosity_row, where, write_numbers, write_table
from studies.monti import DRAG, PROGRAM_RATIO, PUBLISHED_RANGE, SCENE, TABLE_RATIO, contact, electrochemistry
from studies.monti import lubrication, spheres
import numpy as np

TITLE = "Silica with two concentrations of salt"
FRACTION, FRICTION = 0.46, 0.5
SALTS = {0.0214: "salt-free", 0.0048: "0.4 M"}  # by the Debye length over the radius: 9 and 2 nm over 420 nm
FREE, SALTED = SALTS
SCENE = merged(SCENE, spheres(512, FRACTION, 1.1, 0.5), in_strains(2, 8), lubrication=lubrication(0.15))
# rate / rate_0 with rate_0 = (F_R + F_A) / (eta a^2).
RATES = [10 ** (k / 2) for k in (-10, -8, *range(-6, 3))]
SEEDS = 6
SLOPE_RATES, SLOPE_SEEDS = [10**-0.5, 10**0.5], 24  # on both sides of 1
SCANNED = {SALTED: (PROGRAM_RATIO, 3, 1, 0.5), FREE: (PROGRAM_RATIO, 1)}
SCAN_RATES, SCAN_SEEDS = [1e-4, 1e-3, 1e-2, 0.1, 1, 10], 3
OTHER_LENGTH = 0.005  # Debye length at 0.4 M, rounded differently
CHECKED, CHECK_SEEDS = [(FREE, 1e-5), (SALTED, 1e-5), (FREE, 0.1)], 8
SHORT = {"particles": {"count": 200}, **in_strains(1, 3)}
# Stiffness of contacts, and its smallest ratio to the attraction, which then compresses them by 0.01 radii.
STIFFNESS, STIFFNESS_OVER_ATTRACTION = 4e5, 100


def patch_of(rate, length, ratio, **others):
    """Returns the patch of one point; forces are in units of viscosity * rate * a^2."""
    force = 1 / rate
    stiffness = max(STIFFNESS, STIFFNESS_OVER_ATTRACTION * force / (1 + ratio))
    return {"contact": contact(stiffness, FRICTION), **electrochemistry(force, ratio, length, **others)}


def rows_of(program, name, cases, seeds, patch=None, **others):
    """Returns rows for cases (Debye length, F_R / F_A, rate / rate_0)."""
    patches = [patch_of(rate, length, ratio, **others) for length, ratio, rate in cases]
    settings = [{f"/{key}": block for key, block in p.items()} for p in patches]
    points = program.run(name, merged(SCENE, patches[0], patch or {}), settings, seeds)
    return [row_of(case, point) for case, point in zip(cases, points)]


def row_of(case, point):
    length, ratio, rate = case
    row = {"length": length, "ratio": ratio, "rate": rate, "rate_of_drag": rate * DRAG}
    row["rate_of_difference"] = rate * (ratio + 1) / (ratio - 1) if ratio > 1 else math.nan
    attraction = [m["stress"]["attraction"][3] for m in point.means]
    row["attraction"] = sum(attraction) / len(attraction) if attraction else math.nan
    return row | viscosity_row(point, "contacts_per_particle") | {"soft": flags(point)["overlap"]}


def curve_of(rows, length, ratio):
    return sorted(where(rows, length=length, ratio=ratio), key=lambda r: r["rate"])


def slope(low, high):
    """Returns d ln eta / d ln rate between two rows."""
    return over(logarithm(row_ratio(high, low, "viscosity")), math.log(high["rate"] / low["rate"]))


def shape_rows(rows):
    """Yields findings about the shapes of curves, published in a figure only; 1 means no thinning or thickening."""
    cases = ((FREE, TABLE_RATIO, 0), (SALTED, TABLE_RATIO, 0), (FREE, TABLE_RATIO, -1))
    for length, ratio, end in (*cases, *((SALTED, ratio, -1) for ratio in (TABLE_RATIO, *SCANNED[SALTED]))):
        curve = curve_of(rows, length, ratio)
        what = "lowest rate over the least: thinning" if end == 0 else "highest rate over the least: thickening"
        text = f"{SALTS[length]}, F_R/F_A = {ratio}: η_r at the {what}"
        found = propagated([number(r, "viscosity") for r in curve], lambda values, end=end: values[end] / min(values))
        yield Finding(text, "M fig 8", *found, curve[0]["seeds"] - 1)


def share_of_rise(curve, rate):
    """Returns the share of the rise of ln η_r, from its least value to that at the highest rate, that is reached at a
    rate; logarithms are interpolated linearly."""
    places = np.log([r["rate"] for r in curve])

    def share(values):
        logs = np.log(values)
        return float((np.interp(math.log(rate), places, logs) - min(logs)) / (logs[-1] - min(logs)))

    return propagated([number(r, "viscosity") for r in curve], share)


def slope_rows(rows, ends):
    """Yields rows about the rate γ̇₀, published as "within the shear-thickening region": by their equation (14), and in
    the units of their program. Within is between a tenth and nine tenths of the rise, bounds of ours."""
    curve = curve_of(rows, FREE, TABLE_RATIO)
    by_rate, degrees = {round(2 * math.log10(r["rate"])): r for r in curve}, curve[0]["seeds"] - 1
    slopes = (slope(*ends), ends[0]["seeds"] - 1), (slope(by_rate[-3], by_rate[-2]), degrees)
    forces = "(F_R + F_A)/(η a²)", "(F_R + F_A)/(6π η a²), the program's"
    for force, rate, (found, degrees_of_slope) in zip(forces, (1, 1 / DRAG), slopes):
        name = f"salt-free, γ̇₀ = {force}"
        text = f"{name}: share of the rise of ln η_r at this rate"
        yield Statement(text, "M 4.2", *share_of_rise(curve, rate), 0.1, 0.9, degrees, essential=False)
        yield Finding(f"{name}: d ln η_r/d ln γ̇ at this rate", "M 4.2", *found, degrees_of_slope)


def change(program, name, case, patch=None, **others):
    """Returns the relative change of the viscosity of the same packings of 200 spheres over short windows, its standard
    error and degrees of freedom."""
    points = []
    for kind, block, more in (("", {}, {}), ("-changed", patch or {}, others)):
        length, rate = case
        scene = merged(SCENE, patch_of(rate, length, TABLE_RATIO, **more), merged(SHORT, block))
        points += program.run(name + kind, scene, [{"/volume_fraction": FRACTION}], CHECK_SEEDS)
    reference, changed = (point.by_seed() for point in points)
    return relative_difference(changed, reference, paired=True)


def method_numbers(program):
    """Yields names and (value, standard error, degrees of freedom) of tests of the method."""
    for length, rate in CHECKED:
        automatic = program.derived(merged(SCENE, patch_of(rate, length, TABLE_RATIO)))["timestep"]
        name = f"steps-{length:g}-{rate:g}"
        text = f"{SALTS[length]}, rate {rate:g}: change of η_r with half of the automatic step of {automatic:.1e}"
        yield text, change(program, name, (length, rate), {"integrator": {"timestep": automatic / 2}})
    for length in SALTS:
        text = f"{SALTS[length]}, rate 1e-05: change of η_r with attraction to 4 a, not to 0.5 a"
        yield text, change(program, f"range-{length:g}", (length, 1e-5), attraction_range=PUBLISHED_RANGE)


def judge():
    table = read_rows(HERE / "table.csv")
    # The slope at a rate of 1 has its own campaigns, with more seeds.
    most = max(r["seeds"] for r in table)
    ends = sorted((r for r in table if r["seeds"] == most), key=lambda r: r["rate"])
    rows = [r for r in table if r["seeds"] < most]
    yield from slope_rows(rows, ends)
    yield from shape_rows(rows)
    for text, (*found, degrees) in read_numbers(HERE / "numbers.csv").items():
        of, width = ("step", 0.05) if "half of the automatic step" in text else ("range of attraction", 0.1)
        yield Check(text, of, *found, -width, width, degrees)


def measure(program):
    rows = rows_of(program, "curves", [(d, TABLE_RATIO, x) for d in SALTS for x in RATES], SEEDS)
    scans = [(d, ratio, x) for d, ratios in SCANNED.items() for ratio in ratios for x in SCAN_RATES]
    rows += rows_of(program, "scan", [*scans, *((OTHER_LENGTH, TABLE_RATIO, x) for x in SCAN_RATES)], SCAN_SEEDS)
    ends = rows_of(program, "slope", [(FREE, TABLE_RATIO, x) for x in SLOPE_RATES], SLOPE_SEEDS)
    names = "length, ratio, rate, rate_of_difference, rate_of_drag, seeds, lost, transient, soft, viscosity±, "
    names += "lubrication±, contact±, repulsion±, attraction, contacts_per_particle±"
    write_table(HERE / "table.csv", names, rows + ends, 4)
    write_numbers(HERE / "numbers.csv", dict(method_numbers(program)))


def draw():
    rows = read_rows(HERE / "table.csv")[: -len(SLOPE_RATES)]  # without those of the slope
    figure = Figure(HERE / "chart.png", columns=2)
    ends = {"x_range": (5e-6, 20), "log": "xy", "powers": "x"}
    title = f"φ = {FRACTION}, μ = {FRICTION}, F_R/F_A = 19"
    panel = figure.panel("γ̇/γ̇_0, F(0) = F_R + F_A", "η_r", title, key="top left", y_range=(5, 100), **ends)
    for friction, dash in ((1, 2), (0, 3)):
        panel.level(mari_fit(FRACTION, friction), f"Mari fit (published), μ = {friction}", GREY, dash=dash)
    for x, text in ((1, "γ̇_0 by Eq. 14"), (1 / DRAG, "γ̇_0 with 6π")):
        panel.upright(x)
        panel.text(text, x * 0.8, 48, "right", rotation=90, fontsize=9)
    for length, colour in ((FREE, BLUE), (SALTED, RED)):
        curve, title = curve_of(rows, length, TABLE_RATIO), f"{SALTS[length]}, λ = {length} a"
        panel.rows(curve, "rate", "viscosity", title, colour, 7, 0.8, joined=True)
    panel = figure.panel(
        "γ̇/γ̇_0, F(0) = F_R + F_A", "η_r", f"λ = {SALTED} a (0.4 M)", key="top right", y_range=(5, 1000), **ends
    )
    for ratio, colour in zip((TABLE_RATIO, *SCANNED[SALTED]), (RED, ORANGE, GREEN, GREY, PURPLE)):
        curve = curve_of(rows, SALTED, ratio)
        panel.rows(curve, "rate", "viscosity", f"F_R/F_A = {ratio}", colour, 7, 0.8, joined=True)
    figure.draw()


def quick_measure(program):
    cases = [(FREE, TABLE_RATIO, x) for x in (1e-5, 1e-3, 0.1)] + [(SALTED, 0.5, x) for x in (1e-3, 1)]
    slow, least, fast, sticky, torn = rows_of(program, "quick", cases, 6, SHORT)
    for text, row, low, high in (("10⁻⁵", slow, 1.05, 1.6), ("0.1", fast, 1.7, 4)):
        text = f"salt-free, F_R/F_A = {TABLE_RATIO}: η_r at rate {text} over that at 10⁻³"
        yield Check(text, "expected", *row_ratio(row, least, "viscosity"), low, high, 5)
    text = "0.4 M, F_R/F_A = 0.5: η_r at rate 10⁻³ over that at 1"
    yield Check(text, "expected", *row_ratio(sticky, torn, "viscosity"), 1.3, 6, 5)


main(HERE, TITLE, measure, quick_measure, judge, draw)
