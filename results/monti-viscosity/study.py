#!/usr/bin/python3
"""Viscosities of the suspensions of Monti et al. (2021) without noise, without and with friction, compared with the
fits of their Fig. 7."""
import itertools
import math
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from studies.driver import BLUE, Check, Figure, Finding, GREY, MARI_FITS, RED, Statement, column, divergence
from studies.driver import entries, first, flags, groups, in_strains, main, mari_fit, merged, number, over, propagated
from studies.driver import quotient, read_numbers, read_rows, read_texts, relative_difference, row_ratio, viscosity_row
from studies.driver import where, with_pairs, write_numbers, write_rows, write_table
from studies.monti import PAIRS, contact, in_units, kim_karrila, lubrication
import numpy as np

TITLE = "Viscosities of Monti et al. with and without friction"
GAPS = (0.05, 0.2)
NAMES = {0: "FL", 1: "FR"}  # of their Table 1, by friction
COUNTS = {0: 200, 1: 1000}
FRACTIONS = {0: (0.30, 0.40, 0.45, 0.50, 0.55, 0.57), 1: (0.30, 0.40, 0.45, 0.50, 0.53, 0.55)}
# Volume fractions at which their fits are compared, and the tolerance: the fits are not 1 without spheres, and errors
# are large near phi_J.
COMPARED = {0: (0.40, 0.55, 0.1), 1: (0.30, 0.50, 0.15)}
# Volume fractions of free fits: all points, and those that follow one power of 1 - phi / phi_J (chosen from the
# results), without the dilute ones, and without the densest with friction, where contacts are too soft.
FITTED = {"all": {0: (0.30, 0.57), 1: (0.30, 0.55)}, "one power": {0: (0.45, 0.57), 1: (0.40, 0.53)}}
SCENE = merged(PAIRS, in_strains(2, 8))
SEEDS = {0: 48, 1: 8}

# Volume fractions of variants that may move a viscosity away from the fit, at a gap of 0.05, by friction.
VARIED = {0: (0.30, 0.50), 1: (0.30, 0.50, 0.53, 0.55)}
SCANNED = (1e-2, 3e-4, 1e-4)  # regularisations besides 1e-3; the last two also at the gap of 0.2
WIDE = 0.5  # a gap beyond the published ones
STIFF = contact(4e6, 0)
OTHER_COUNTS = {0: 1000, 1: 250}
VARIANT_SEEDS = 6

ROLLING = {"contact": {"rolling_stiffness": 4e5 / 7, "rolling_friction": 0.1}}  # as in their program
ROLLED = (0.45, 0.50)
LONG = in_strains(20, 8)


def rows_of(program, name, cases, seeds, patch=None, block=lubrication):
    """Returns rows for cases (friction, volume fraction, gap); block(gap) is the lubrication block."""
    friction = cases[0][0]
    fixed = {"particles": {"count": COUNTS[friction]}, "contact": {"friction": friction}}
    settings = [{"/volume_fraction": f, "/lubrication": block(g)} for _, f, g in cases]
    points = program.run(name, merged(SCENE, fixed, patch or {}), settings, seeds)
    return [row_of(case, point) for case, point in zip(cases, points)]


def row_of(case, point):
    friction, fraction, gap = case
    row = {"system": NAMES[friction], "fraction": fraction, "gap": gap, "fit": mari_fit(fraction, friction)}
    row |= viscosity_row(point, "first_normal_difference", "second_normal_difference", "pressure")
    row["soft"] = flags(point)["overlap"]
    pairs = number(row, "pairs")
    row |= entries("double", (1 + 2.5 * fraction + 2 * pairs[0], 2 * pairs[1]))
    for of in ("viscosity", "double"):
        row |= entries(f"{of}_over_fit", over(number(row, of), row["fit"]))
    return row


def chosen(rows, friction, gap):
    return [r for r in rows if (r["system"], r["gap"]) == (NAMES[friction], gap) and math.isfinite(r["viscosity"])]


def between(rows, friction, gap, low, high):
    return [r for r in chosen(rows, friction, gap) if low <= r["fraction"] <= high]


def compared(rows, friction, gap):
    return between(rows, friction, gap, *COMPARED[friction][:2])


def distance_from(rows):
    """Returns the rms of ln(eta / fit) with pairs counted twice, minus that with pairs counted once."""
    fractions, fits = column(rows, "fraction"), column(rows, "fit")

    def found(pairs):
        # Both use the same draws of the pair stress.
        ratios = (1 + 2.5 * fractions + np.outer((2, 1), pairs)) / fits
        double, single = np.sqrt(np.square(np.log(np.maximum(ratios, 1e-9))).mean(axis=1))
        return float(double - single)

    return propagated([number(r, "pairs") for r in rows], found)


def fit_rows(rows, fits):
    """Yields rows about the fits. "Satisfying" and "excellent agreement" have no published numbers, and depend on a
    regularisation that is not published: they are tested to 10 and 15 %, and are not essential."""
    for friction, name in NAMES.items():
        low, high, share = COMPARED[friction]
        for gap in GAPS:
            worst = max(compared(rows, friction, gap), key=lambda r: abs(math.log(r["viscosity_over_fit"])))
            text = f"{name}, gap {gap}: η_r over the fit where it is farthest from 1 of φ = {low:g} to {high:g}"
            place, ratio = f"{text} (at {worst['fraction']:g})", number(worst, "viscosity_over_fit")
            yield Statement(place, "M fig 7", *ratio, 1 - share, 1 + share, worst["seeds"] - 1, essential=False)
        for row in where(fits, system=name):
            ends = f"φ = {row['from']:g} to {row['to']:g} (published: {row['jammed_published']:g})"
            text = f"{name}, gap {row['gap']:g}: φ_J of a free fit from {ends}"
            degrees = chosen(rows, friction, row["gap"])[0]["seeds"] - 1
            yield Finding(text, "M fig 7", *number(row, "jammed"), degrees)
        text = f"{name}: rms of ln(η_r/fit) with the pairs' stress counted twice, less that counted once"
        yield Finding(text, "M eq 8", *distance_from([r for gap in GAPS for r in compared(rows, friction, gap)]))


def unit_numbers(program):
    """Yields differences of a point in two other systems of units. Units that are powers of two round equally."""
    name = "FL, φ = 0.5, gap 0.05, 8 seeds"
    base = merged(SCENE, in_strains(1, 2), particles={"count": 200})
    found = []
    for key, units in (("first", (1, 1, 1)), ("binary", (0.25, 0.5, 2)), ("other", (0.1, 0.045, 1.7))):
        (point,) = program.run(f"units-{key}", in_units(base, *units), [{"/volume_fraction": 0.5}], 8)
        found.append(point.by_seed())
    one, binary, other = found
    largest = max(abs(binary[s] / one[s] - 1) for s in one)
    yield f"{name}: largest relative difference of η_r in units of η/4, rate/2, 2 a", (largest, 0.0, len(one) - 1)
    text = f"{name}: relative difference of η_r in units of 0.1 η, 0.045 rate, 1.7 a, paired by seeds"
    yield text, relative_difference(other, one, paired=True)


def unit_rows(numbers):
    """Yields statements that viscosities depend on the three dimensionless groups alone."""
    for text, (*found, degrees) in numbers.items():
        yield Statement(text, "M eq 11", *found, *((0, 1e-4) if "largest" in text else (-0.03, 0.03)), degrees)


def rolling_rows(rows, rolled):
    plain = {r["fraction"]: r for r in chosen(rows, 1, 0.05)}
    rolled = [r for r in rolled if r["seeds"] > 1]
    ratios = [row_ratio(r, plain[r["fraction"]], "viscosity") for r in rolled]
    degrees = min(r["seeds"] for r in rolled) - 1
    for row, ratio in zip(rolled, ratios):
        text = f"FR, φ = {row['fraction']:g}: η_r with rolling resistance over that without"
        yield Statement(text, "M app B", *ratio, low=1, degrees=degrees)
    text = "the second of these over the first (above 1: φ_J falls)"
    yield Finding(text, "M app B", *quotient(ratios[1], ratios[0]), degrees)


def regularisation_that_fits(scan):
    """Returns log10 of the regularisation at which the viscosity is that of the fit, and its error.

    `scan` has (regularisation, viscosity over the fit, its error); logarithms are interpolated linearly.
    """
    scan = sorted(scan)
    places = np.log10([value for value, _, _ in scan])

    def found(ratios):
        # Viscosities decrease with the regularisation.
        logs = np.log(np.maximum(ratios, 1e-9))
        return float(np.interp(0, logs[::-1], places[::-1]))

    return propagated([(ratio, error) for _, ratio, error in scan], found)


def regularisation_rows(of_variant):
    """Yields findings about the regularisation that the published fits correspond to, where the scan includes it."""
    prefix = "regularisation "
    values = {float(k.removeprefix(prefix)): rows for k, rows in of_variant.items() if k.startswith(prefix)}
    values = {1e-3: of_variant[""]} | values
    for friction, name in NAMES.items():
        for fraction, gap in itertools.product(VARIED[friction], GAPS):
            case = {"system": name, "fraction": fraction, "gap": gap}
            scan = [(v, *number(r, "viscosity_over_fit")) for v, rows in values.items() for r in where(rows, **case)]
            ratios = [ratio for _, ratio, _ in scan]
            if min(ratios) < 1 < max(ratios):
                text = f"{name}, φ = {fraction:g}, gap {gap}: log10 of the regularisation at which η_r is the fit's"
                yield Finding(text, "M fig 7", *regularisation_that_fits(scan), VARIANT_SEEDS - 1)


def judge():
    texts = [r["variant"] for r in read_texts(HERE / "table.csv")]
    table = [with_pairs(row) | {"variant": text} for row, text in zip(read_rows(HERE / "table.csv"), texts)]
    of_variant = groups(table, "variant")
    rows = of_variant[""]
    yield from fit_rows(rows, read_rows(HERE / "fits.csv"))
    yield from regularisation_rows(of_variant)
    yield from unit_rows(read_numbers(HERE / "numbers.csv"))
    yield from rolling_rows(rows, of_variant["rolling"])
    for row in of_variant["strain of 20 before"]:  # the published start, a dense packing, is different
        early = first(rows, **{name: row[name] for name in ("system", "gap", "fraction")})
        text = f"{row['system']}, φ = {row['fraction']:g}: η_r after a strain of 20 over that after 2"
        yield Check(text, "start", *row_ratio(row, early, "viscosity"), 0.95, 1.05, row["seeds"] - 1)


def regularised(value):
    return lambda gap: lubrication(gap, value)


def variants_of(friction):
    """Yields the variants: name, patch, lubrication, gap, and volume fractions (None: those of VARIED)."""
    stiff, count = {"contact": STIFF | {"friction": friction}}, OTHER_COUNTS[friction]
    for value in SCANNED:
        for gap in GAPS if value < 1e-3 else GAPS[:1]:
            yield f"regularisation {value:.0e}".replace("e-0", "e-"), {}, regularised(value), gap, None
    yield f"gap {WIDE}", {}, lubrication, WIDE, None
    yield "kim-karrila", {}, kim_karrila, GAPS[0], None
    yield "ten times k_n", stiff, lubrication, GAPS[0], None
    if friction:
        yield "ten times k_n, regularisation 1e-4", stiff, regularised(1e-4), GAPS[0], VARIED[friction][-1:]
    yield f"N = {count}", {"particles": {"count": count}}, lubrication, GAPS[0], None


def rows_of_variants(program):
    for friction, fractions in VARIED.items():
        for k, (name, patch, block, gap, alone) in enumerate(variants_of(friction)):
            cases = [(friction, f, gap) for f in alone or fractions]
            for row in rows_of(program, f"variant-{friction}-{k}", cases, VARIANT_SEEDS, patch, block):
                yield {"variant": name, **row}
    for row in rows_of(program, "rolling", [(1, f, 0.05) for f in ROLLED], SEEDS[1], ROLLING):
        yield {"variant": "rolling", **row}
    for friction, name in NAMES.items():
        for row in rows_of(program, f"later-{name}", [(friction, 0.5, 0.05)], SEEDS[friction], LONG):
            yield {"variant": "strain of 20 before", **row}


def measure(program):
    rows = []
    for friction, name in NAMES.items():
        rows += rows_of(program, name, [(friction, f, g) for g in GAPS for f in FRACTIONS[friction]], SEEDS[friction])
    names = "variant, system, fraction, gap, seeds, lost, transient, soft, fit, viscosity±, viscosity_over_fit±, "
    names += "double_over_fit±, lubrication±, contact±, first_normal_difference±, second_normal_difference±, pressure±"
    table = [{"variant": "", **row} for row in rows] + list(rows_of_variants(program))
    write_table(HERE / "table.csv", names, table, 4)
    fits = {key: fit_row(rows, *key) for key in itertools.product(NAMES, GAPS, FITTED)}
    write_rows(HERE / "fits.csv", list(fits.values()), 4)
    write_numbers(HERE / "numbers.csv", dict(unit_numbers(program)))


def fit_row(rows, friction, gap, part):
    """Returns the row of a fit of c, phi_J and lambda, with errors, to a part of a curve."""
    curve = between(rows, friction, gap, *FITTED[part][friction])
    fractions = [r["fraction"] for r in curve]
    row = {"system": NAMES[friction], "gap": gap, "from": min(fractions), "to": max(fractions)}
    found = divergence(fractions, [number(r, "viscosity") for r in curve], MARI_FITS[friction])
    for name, pair, published in zip(("factor", "jammed", "exponent"), found, MARI_FITS[friction]):
        row |= entries(name, pair) | {f"{name}_published": published}
    return row


def draw():
    texts = [r["variant"] for r in read_texts(HERE / "table.csv")]
    rows = [row for row, text in zip(read_rows(HERE / "table.csv"), texts) if not text]
    figure = Figure(HERE / "chart.png", columns=2, rows=2, size=(1100, 800))
    for friction, name in NAMES.items():
        title = f"{name}: μ = {friction}, N = {COUNTS[friction]}"
        ends = {"x_range": (0.28, 0.58), "y_range": (2, 2000 if friction else 100)}
        panel = figure.panel("φ", "η_r", title, log="y", key="top left", **ends)
        span = (0.28, min(0.58, MARI_FITS[friction][1] - 0.004))
        panel.curve(lambda phi, m=friction: mari_fit(phi, m), "Mari fit (published)", span=span, width=2)
        for gap, colour in zip(GAPS, (BLUE, RED)):
            panel.rows(chosen(rows, friction, gap), "fraction", "viscosity", f"gap {gap} a", colour, 7, 0.9)
        twice = [(r["fraction"], r["double_over_fit"] * r["fit"], 0) for r in chosen(rows, friction, GAPS[0])]
        panel.points(twice, f"gap {GAPS[0]} a, pairs counted twice", GREY, 6, 0.9)
    for friction in NAMES:
        low, high, share = COMPARED[friction]
        panel = figure.panel("φ", "η_r over the published fit", x_range=(0.28, 0.58), y_range=(0.4, 1.2), key=None)
        panel.band([(f, 1 - share, 1 + share) for f in (low, high)], GREY)
        panel.level(1)
        for gap, colour in zip(GAPS, (BLUE, RED)):
            panel.rows(chosen(rows, friction, gap), "fraction", "viscosity_over_fit", None, colour, 7, 0.9, joined=True)
    figure.draw()


def quick_measure(program):
    small = in_strains(1, 4)
    (smooth,) = rows_of(program, "quick-FL", [(0, 0.45, 0.05)], 8, small)
    rough, rolled = (
        rows_of(program, name, [(1, 0.45, 0.05)], 8, merged({"particles": {"count": 250}, **small}, patch))[0]
        for name, patch in (("quick-FR", {}), ("quick-rolling", ROLLING))
    )
    for row, low in ((smooth, 0.88), (rough, 0.7)):
        text = f"{row['system']}, φ = 0.45, gap 0.05: η_r over the fit"
        yield Check(text, "M fig 7", *number(row, "viscosity_over_fit"), low, 1.12, 7)
    text = "FL, φ = 0.45: rms of ln(η_r/fit) with the pairs' stress counted twice, less that counted once"
    yield Check(text, "M eq 8", *distance_from([smooth]), low=0.1)
    text = "FR, φ = 0.45: η_r with rolling resistance over that without"
    yield Statement(text, "M app B", *row_ratio(rolled, rough, "viscosity"), 1.1, 2, 7)
    yield from unit_rows(dict(unit_numbers(program)))


main(HERE, TITLE, measure, quick_measure, judge, draw)
