#!/usr/bin/python3
"""Colloids and grains without noise: where mixtures of radii 1, 1.4, 5 and 7 jam, with and without friction, beside two
models of packings; and whether dense grains flow better when colloids are added to them.

study.py BIN [FOLDER] [--quick] [--from-table]
"""
import functools
import math
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from studies.command_line import main
from studies.compositions import COLLOIDS, GRAINS, MIXTURE_SCENE, colloids_added, grains_among, radii_and_shares
from studies.estimates import difference, logarithm, over, propagated, quotient
from studies.figure import BLUE, GREEN, ORANGE, RED, Figure
from studies.fits import jamming_points
from studies.packings import gap_of, linear_mixture, rods
from studies.scenes import during, merged
from studies.tables import columns_of, entries, number, read_rows, write_table
from studies.verdicts import Check, Finding, Statement
from studies.viscosities import viscosity_row

import numpy as np

TITLE = "Colloids and grains without noise"
RATIO = COLLOIDS[0] / GRAINS[0]
SCENE = merged(MIXTURE_SCENE, during({"strain": 1}, {"strain": 2}))
# Share of the grains in the volume of all spheres, and how many spheres that takes for some thirty grains.
COUNTS = {0: 1000, 0.4: 6000, 0.5: 4000, **dict.fromkeys((0.6, 0.7, 0.75, 0.8, 0.85, 0.9), 3000), 1: 1000}
ALONE = {0: 0.64, 1: 0.57}  # in print: where one group alone jams, by friction
# How far below what models with these numbers say; with friction mixtures jam before.
BELOW = {0: (0.10, 0.075, 0.055, 0.04, 0.025), 1: (0.19, 0.16, 0.13, 0.10, 0.075)}
SEEDS = 3
STEEP = 10  # from this viscosity on the law of the divergence is taken to hold
SOFT = 0.02  # overlap, in radii, beyond which spheres are not hard
# Colloids added to grains of these volume fractions, with friction.
BASES, ADDED = (0.55, 0.60), (1, 0.9, 0.8, 0.7, 0.6, 0.5)
# What may not matter, at a share of grains and so far below the models: so many times as many spheres, and contacts so
# many times as stiff.
SIZES, STIFFER, TESTED, FAR = (0.5, 1, 2), 4, 0.5, {0: 0.04, 1: 0.13}


@functools.cache
def models(alone):
    """Over alpha: the two models in which either group alone packs to this volume fraction."""
    gap = gap_of(*radii_and_shares(0), alone, 4000)
    return {
        "linear mixture": lambda alpha: linear_mixture(alpha, RATIO, alone, alone),
        "rods": lambda alpha: rods(*radii_and_shares(alpha), gap, 4000),
    }


def below_models(friction, alpha, distance):
    """The volume fraction so far below the mean of what the models say."""
    of = models(ALONE[friction]).values()
    return round(sum(model(alpha) for model in of) / len(of) - distance, 4)


def rows_of(program, part, friction, cases, seeds=SEEDS, stiffer=1):
    """Rows of (share of grains, number of spheres, volume fraction)."""
    stiffness = stiffer * SCENE["contact"]["normal_stiffness"]
    scene = merged(SCENE, {"contact": {"friction": friction, "normal_stiffness": stiffness}})
    pointers = "/particles/mixture/alpha", "/particles/count", "/volume_fraction"
    settings = [dict(zip(pointers, case)) for case in cases]
    for (alpha, count, fraction), point in zip(cases, program.run(f"{part}-{friction}", scene, settings, seeds)):
        yield {
            "part": part,
            "friction": friction,
            "alpha": alpha,
            "count": count,
            "grains": round(grains_among(alpha, count)),
            "fraction": fraction,
            "stiffness": stiffness,
            **viscosity_row(point),
            "overlap": max((r["largest_overlap"] for r in point["realisations"] if r.get("mean")), default=math.nan),
        }


def measure(program):
    rows = []
    for friction in ALONE:
        curves = [(a, n, below_models(friction, a, d)) for a, n in COUNTS.items() for d in BELOW[friction]]
        rows += rows_of(program, "curve", friction, curves)
    for base in BASES:
        cases = [(a, COUNTS[a], round(colloids_added(a, base), 4)) for a in ADDED]
        rows += rows_of(program, f"added-{base:g}", 1, cases)
    for friction, distance in FAR.items():
        fraction = below_models(friction, TESTED, distance)
        sizes = [(TESTED, round(factor * COUNTS[TESTED]), fraction) for factor in SIZES]
        rows += rows_of(program, "size", friction, sizes)
        rows += rows_of(program, f"stiff-{STIFFER}", friction, sizes[:1], stiffer=STIFFER)
    names = ["part", "friction", "alpha", "count", "grains", "fraction", "stiffness", "seeds", "lost", "transient"]
    names += ["overlap", *columns_of("viscosity", "pairs", "lubrication", "contact")]
    write_table(HERE / "table.csv", names, rows, 5)
    write_table(HERE / "jamming.csv", JAMMING, [row for friction in ALONE for row in jamming_rows(rows, friction)], 5)


JAMMING = ["friction", "alpha", "points", *columns_of("jammed", "exponent", "rms"), "linear mixture", "rods"]


def curve_of(rows, friction, alpha):
    """The points that the law of the divergence is fitted to: steep ones, of spheres that are hard."""
    here = [r for r in rows if (r["part"], r["friction"], r["alpha"]) == ("curve", friction, alpha)]
    return [r for r in here if r["viscosity"] >= STEEP and r["overlap"] < SOFT]


def jamming_rows(rows, friction):
    curves = {alpha: curve_of(rows, friction, alpha) for alpha in COUNTS}
    curves = {alpha: curve for alpha, curve in curves.items() if len(curve) >= 3}
    fractions = [[r["fraction"] for r in curve] for curve in curves.values()]
    ends = np.cumsum([len(curve) for curve in curves.values()])[:-1]
    numbers = [logarithm(number(r, "viscosity")) for curve in curves.values() for r in curve]

    def found(logarithms):
        """The exponent, and of each curve phi_m and the distance from the law."""
        parts = list(zip(fractions, np.split(np.asarray(logarithms), ends)))
        exponent, points = jamming_points(parts)
        return [exponent, *points, *(distance_from_law(*part, at, exponent) for part, at in zip(parts, points))]

    values, errors = propagated(numbers, found)
    of = models(ALONE[friction])
    for k, (alpha, curve) in enumerate(curves.items()):
        jammed, rms = 1 + k, 1 + len(curves) + k
        yield {
            "friction": friction,
            "alpha": alpha,
            "points": len(curve),
            **entries("jammed", (values[jammed], errors[jammed])),
            **entries("exponent", (values[0], errors[0])),
            **entries("rms", (values[rms], errors[rms])),
            **{name: model(alpha) for name, model in of.items()},
        }


def distance_from_law(fractions, logarithms, jammed, exponent):
    """Root of the mean square of ln eta about the law, with the factor that fits best."""
    return float(np.std(logarithms + exponent * np.log(1 - np.asarray(fractions) / jammed)))


def jammed_at(points, friction):
    return {p["alpha"]: p for p in points if p["friction"] == friction}


def optimum(of_alpha):
    """The share of grains at which phi_m is largest, among those that were measured."""
    alphas = list(of_alpha)
    numbers = [number(of_alpha[alpha], "jammed") for alpha in alphas]
    return propagated(numbers, lambda values: float(alphas[int(np.argmax(values))]))


def from_nearer_model(of_alpha):
    """Root of the mean square distance of phi_m from the nearer of the two models."""
    rows = list(of_alpha.values())

    def found(values):
        left = [min(abs(v - row["linear mixture"]), abs(v - row["rods"])) for v, row in zip(values, rows)]
        return math.sqrt(sum(d * d for d in left) / len(left))

    return propagated([number(row, "jammed") for row in rows], found)


def slopes(of_alpha):
    """How fast phi_m rises from grains alone over how fast from colloids alone."""
    first = min(alpha for alpha in of_alpha if alpha > 0)
    ends = [number(of_alpha[alpha], "jammed") for alpha in (1, 0.9, first, 0)]
    return propagated(ends, lambda v: (v[1] - v[0]) / 0.1 / ((v[2] - v[3]) / first))


def map_rows(points):
    for friction in ALONE:
        of = jammed_at(points, friction)
        name = f"μ = {friction}"
        text = f"{name}: share α of grains at which φ_m is largest"
        yield Statement(text, "L5.3c", *optimum(of), 0.6, 0.8, essential=False)
        text = f"{name}: how fast φ_m rises from α = 1 over how fast from 0"
        yield Statement(text, "L5.3c", *slopes(of), 1.5)
        ends = difference(number(of[0], "jammed"), number(of[1], "jammed"))
        yield Statement(f"{name}: φ_m of colloids alone less that of grains alone", "L5.4b", *ends, -0.004, 0.004)
        text = f"{name}: rms distance of φ_m(α) from the nearer packing model"
        yield Finding(text, "L5.4b", *from_nearer_model(of))
        for alpha in (0.8, 0.85, 0.9):
            row = of[alpha]
            above = difference(number(row, "jammed"), (row["linear mixture"], 0))
            share = over(above, row["rods"] - row["linear mixture"])
            text = f"{name}, α = {alpha:g}: φ_m between the models (0: linear mixture, 1: rods)"
            yield Finding(text, "packing models", *share)
        text = f"{name}: exponent β of (1 - φ/φ_m)^-β"
        yield Finding(text, "L5.4a", *number(of[0], "exponent"))
    row = jammed_at(points, 1)[0.4]
    yield Statement("μ = 1, α = 0.4: rms of ln η_r about a power", "L5.4a", *number(row, "rms"), high=0.1)


def added_rows(rows, points):
    """What becomes of dense grains when colloids are added."""
    of = jammed_at(points, 1)
    line = {r["alpha"]: r for r in rows if r["part"] == f"added-{BASES[0]:g}"}
    for first, then in ((1, 0.9), (0.9, 0.8)):
        ratio = quotient(*(number(line[alpha], "viscosity") for alpha in (then, first)))
        text = f"grains at φ₀ = {BASES[0]:g}, μ = 1: η_r at α = {then:g} over that at {first:g}"
        yield Statement(text, "L5.2", *ratio, high=1, degrees=line[then]["seeds"] - 1)

    def room(alpha):
        return over(number(of[alpha], "jammed"), colloids_added(alpha, BASES[1]))

    name = f"grains at φ₀ = {BASES[1]:g}, μ = 1: φ_m/φ"
    for alpha, low, high in ((1, 0, 1), (0.8, 1, math.inf), (0.5, 0, 1)):
        yield Statement(f"{name} at α = {alpha:g} (above 1: flows)", "L5.6", *room(alpha), low, high)
    text = f"{name} at α = 0.6 over that at 0.7 (further away)"
    yield Statement(text, "L5.6", *quotient(room(0.6), room(0.7)), low=1)


def consistency_rows(rows):
    for friction in ALONE:
        of_part = {}
        for row in rows:
            if row["friction"] == friction:
                of_part.setdefault(row["part"], []).append(row)
        name = f"μ = {friction}, α = {TESTED:g}"
        sizes = sorted(of_part["size"], key=lambda r: r["count"])
        for one, other in zip(sizes, sizes[1:]):
            ratio = quotient(number(other, "viscosity"), number(one, "viscosity"))
            text = f"{name}: η_r of {other['count']:.0f} spheres over that of {one['count']:.0f}"
            yield Check(text, "size", *ratio, 0.9, 1.1, SEEDS - 1)
        (stiff,) = of_part[f"stiff-{STIFFER}"]
        ratio = quotient(number(stiff, "viscosity"), number(sizes[0], "viscosity"))
        text = f"{name}: η_r with contacts {STIFFER} times as stiff over η_r"
        yield Check(text, "stiffness", *ratio, 0.95, 1.05, SEEDS - 1)


def judge():
    rows, points = read_rows(HERE / "table.csv"), read_rows(HERE / "jamming.csv")
    yield from map_rows(points)
    yield from added_rows(rows, points)
    yield from consistency_rows(rows)


def draw():
    rows, points = read_rows(HERE / "table.csv"), read_rows(HERE / "jamming.csv")
    figure = Figure(HERE / "chart.png", columns=2)
    ends = {"x_range": (-0.02, 1.02), "y_range": (0.46, 0.82)}
    panel = figure.panel("share of grains α", "φ_m", "where they jam", key="bottom center", **ends)
    for friction, colour in zip(ALONE, (BLUE, RED)):
        of = jammed_at(points, friction)
        panel.points([(a, *number(r, "jammed")) for a, r in of.items()], f"μ = {friction}", colour)
        for dash, (name, model) in zip((1, 2), models(ALONE[friction]).items()):
            title = name if friction == 0 else None
            panel.curve(model, title, colour, span=(0, 1), samples=81, dash=dash)
    for base, colour in zip(BASES, (GREEN, ORANGE)):
        title = f"colloids added to φ₀ = {base:g}"
        panel.curve(lambda a, b=base: colloids_added(a, b), title, colour, span=(0.4, 1), dash=3)
    panel = figure.panel("1 - φ/φ_m", "η_r", "the law", log="xy", key="bottom left", x_range=(0.02, 0.3))
    for friction, mark in zip(ALONE, (6, 7)):
        of = jammed_at(points, friction)
        for alpha, colour in ((0, BLUE), (0.5, GREEN), (0.8, ORANGE), (1, RED)):
            curve = curve_of(rows, friction, alpha)
            jammed = of[alpha]["jammed"]
            places = [(1 - r["fraction"] / jammed, *number(r, "viscosity")) for r in curve]
            panel.points(places, f"α = {alpha:g}, μ = {friction}", colour, mark)
    figure.draw()


def quick_measure(program):
    """Grains at which friction jams colloids or grains alone, mixed."""
    smooth, rough = (
        {r["alpha"]: r for r in rows_of(program, "quick", friction, cases, 4)}
        for friction, cases in ((0, [(0, 300, 0.6), (0.7, 1000, 0.6)]), (1, [(0, 300, 0.54), (0.7, 1000, 0.54)]))
    )
    for name, of in (("μ = 0, φ = 0.6", smooth), ("μ = 1, φ = 0.54", rough)):
        ratio = quotient(number(of[0.7], "viscosity"), number(of[0], "viscosity"))
        yield Statement(f"{name}: η_r at α = 0.7 over that of colloids alone", "L5.3b", *ratio, 0, 0.8)


main(HERE, TITLE, measure, quick_measure, judge, draw)
