#!/usr/bin/python3
"""Colloids and grains without noise: jamming of mixtures of radii 1, 1.4, 5 and 7, with and without friction, compared
with two models of packings; and the flow of dense grains as colloids are added."""
import math
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from studies.compositions import COLLOIDS, GRAINS, MIXTURE_SCENE, alike, colloids_added, composition_row
from studies.compositions import draw_models, from_nearer_model, packing_models, setting_of
from studies.driver import BLUE, Check, Figure, Finding, GREEN, ORANGE, RED, Statement, difference, entries, estimate
from studies.driver import first, in_strains, main, merged, number, over, place_of_largest, propagated, quotient
from studies.driver import read_final, read_rows, row_ratio, viscosity_row, where, write_rows, write_table
import numpy as np

TITLE = "Colloids and grains without noise"
SCENE = merged(MIXTURE_SCENE, in_strains(1, 2))
# Number of spheres with about thirty grains, by the share of the grains in the volume of all spheres.
COUNTS = {0: 1000, 0.4: 5000, 0.5: 4000, 0.6: 3000, 0.7: 2000, 0.75: 2000, 0.8: 1500, 0.85: 1500, 0.9: 1000, 1: 1000}
ALONE = {0: 0.64, 1: 0.57}  # published jamming volume fraction of one group alone, by friction
# Distances below the jamming volume fractions of a pilot run, by friction.
BELOW = {0: (0.10, 0.075, 0.055, 0.04, 0.025), 1: (0.12, 0.09, 0.065, 0.045, 0.03)}
PILOT = {
    0: dict(zip(COUNTS, (0.637, 0.722, 0.745, 0.762, 0.78, 0.778, 0.76, 0.739, 0.704, 0.637))),
    1: dict(zip(COUNTS, (0.577, 0.66, 0.675, 0.69, 0.685, 0.672, 0.655, 0.64, 0.61, 0.577))),
}
SEEDS = 4
# Volume fraction of grains with friction to which colloids are added; tests if they unjam.
DENSE = 0.60
# Tests of parameters that should not matter: factors of the number of spheres, stiffness and lightness, the share of
# grains, and the distance below jamming by friction.
SIZES, STIFFER, LIGHTER, TESTED, FAR = (0.5, 1, 2, 4), 4, 4, 0.5, {0: 0.055, 1: 0.09}
LATE = {"/duration/equilibration/strain": 3, "/duration/production/strain": 4}
ORDERED = (0.5, 0.75)  # shares of grains that are searched for layers, without friction
LAYERED = 0.04  # distance below jamming of this search


def stiffness_of(friction, alpha):
    """Returns k_n: larger with friction, where curves reach larger stresses, and if large grains carry them."""
    if friction == 0:
        return 1e5
    return 2e5 if alpha < 0.75 else 4e5 if alpha < 0.9 else 1e6


def below(friction, alpha, distance):
    return round(PILOT[friction][alpha] - distance, 4)


def rows_of(program, part, friction, cases, seeds=SEEDS, stiffer=1, besides=None):
    """Yields rows for cases (share of grains, number of spheres, volume fraction), with settings `besides`."""
    scene = merged(SCENE, contact={"friction": friction})
    settings = [setting_of(*case, stiffer * stiffness_of(friction, case[0]), besides=besides) for case in cases]
    for setting, point in zip(settings, program.run(f"{part}-{friction}", scene, settings, seeds)):
        yield {
            "part": part,
            "friction": friction,
            **composition_row(setting),
            **viscosity_row(point, "mean_overlap"),
            "overlap": max((r["largest_overlap"] for r in point.results), default=math.nan),
        }


def layer_peaks(path, radii):
    """Yields the largest |sum of exp(i k r)|^2 / N of spheres of these radii in a final configuration, along the
    gradient and along the vorticity.

    Wavelengths are 0.75 to 1.3 mean diameters. Without order this is the peak of a liquid's structure factor, equal for
    both directions; for perfect layers it is N.
    """
    edges, places, radius = read_final(path)
    chosen = np.isin(radius, radii)
    diameter = 2 * radius[chosen].mean()
    for length, place in zip(edges[1:], places[1:]):
        waves = np.arange(math.ceil(length / (1.3 * diameter)), math.floor(length / (0.75 * diameter)) + 1)
        sums = np.exp(2j * math.pi * np.outer(waves, place[chosen]) / length).sum(axis=1)
        yield float(np.max(np.abs(sums) ** 2) / chosen.sum())


def order_rows(program):
    scene = merged(SCENE, contact={"friction": 0}, files={"final_configuration": True})
    pointers = "/particles/mixture/alpha", "/particles/count", "/volume_fraction"
    settings = [dict(zip(pointers, (a, 2 * COUNTS[a], below(0, a, LAYERED)))) for a in ORDERED]
    for alpha, point in zip(ORDERED, program.run("order-0", scene, settings, 2 * SEEDS)):
        paths = program.final_configurations("order-0", point)
        for group, radii in (("colloids", COLLOIDS), ("grains", GRAINS)):
            gradient, vorticity = zip(*(layer_peaks(path, radii) for path in paths))
            row = {"alpha": alpha, "group": group, "seeds": len(paths)}
            yield row | entries("gradient", estimate(gradient)) | entries("vorticity", estimate(vorticity))


def test_rows(program, friction):
    """Yields rows of a point with other sizes, stiffness, density, step and window."""
    fraction = below(friction, TESTED, FAR[friction])
    sizes = [(TESTED, round(factor * COUNTS[TESTED]), fraction) for factor in SIZES]
    particles = {"count": sizes[0][1], "mixture": {"alpha": TESTED}}
    contact = {"friction": friction, "normal_stiffness": stiffness_of(friction, TESTED)}
    half = program.part_of_step(0.5, merged(SCENE, particles=particles, contact=contact, volume_fraction=fraction))
    yield from rows_of(program, "size", friction, sizes)
    for part, stiffer, besides in (
        (f"stiff-{STIFFER}", STIFFER, None),
        (f"light-{LIGHTER}", 1, {"/particles/density": SCENE["particles"]["density"] / LIGHTER}),
        ("half-step", 1, {"/integrator": half}),
        ("late", 1, LATE),
    ):
        yield from rows_of(program, part, friction, sizes[:1], SEEDS, stiffer, besides)


def measure(program):
    rows, jams = [], []
    for friction in ALONE:
        curves = [(a, n, below(friction, a, d)) for a, n in COUNTS.items() for d in BELOW[friction]]
        rows += rows_of(program, "curve", friction, curves)
        jams += jamming_rows(program, friction)
    for friction in FAR:
        rows += test_rows(program, friction)
    names = "part, friction, alpha, count, grains, fraction, stiffness, seeds, lost, transient, overlap, viscosity±, "
    write_table(HERE / "table.csv", names + "pairs±, lubrication±, contact±, mean_overlap±", rows, 5)
    names = "friction, alpha, points, jammed±, prefactor±, exponent±, rms, chi squared, degrees, flowing, stuck"
    write_table(HERE / "jamming.csv", names, jams, 5)
    write_rows(HERE / "order.csv", list(order_rows(program)), 4)


LAW = "jammed", "prefactor", "exponent"


def jamming_rows(program, friction):
    """Yields the law of divergence for each share of grains, with one exponent for all, from `peclet jamming`."""
    found = program.asked("jamming", f"curve-{friction}", "--common-exponent")
    exponent = found["common"]["exponent"]
    for curve in sorted(found["curves"], key=lambda c: c["settings"]["/particles/mixture/alpha"]):
        law, stuck = curve["law"], curve["smallest_stuck"]
        row = {"friction": friction, "alpha": curve["settings"]["/particles/mixture/alpha"], "points": 0, "degrees": 0}
        row |= {"rms": math.nan, "chi squared": math.nan, "flowing": curve["largest_flowing"] or math.nan}
        row["stuck"] = stuck["fraction"] if stuck else math.nan
        numbers = [(math.nan, math.inf)] * 3
        if law["phi_m"]:
            fitted = where(curve["points"], fitted=True)
            numbers = [(n["value"], n["standard_error"]) for n in (law["phi_m"], law["prefactor"], exponent)]
            (jammed, _), (prefactor, _), (power, _) = numbers
            left = [math.log(p["mean"] / prefactor) + power * math.log(1 - p["fraction"] / jammed) for p in fitted]
            row |= {"points": len(fitted), "rms": math.sqrt(sum(x * x for x in left) / len(left))}
            row |= {"chi squared": law["chi_squared"], "degrees": law["degrees"]}
        yield row | {k: v for name, value in zip(LAW, numbers) for k, v in entries(name, value).items()}


def jammed_at(points, friction):
    return {p["alpha"]: p for p in points if p["friction"] == friction and p["points"]}


def modelled(alpha, friction):
    """Returns the jamming volume fractions of the two models."""
    return [model(alpha) for model in packing_models(ALONE[friction]).values()]


def distance_from_models(of_alpha, friction):
    """Returns the rms distance of phi_m from the nearer of the two models."""
    said = np.array([modelled(alpha, friction) for alpha in of_alpha])

    def found(values):
        left = np.abs(np.array(values)[:, None] - said).min(axis=1)
        return math.sqrt(sum(d * d for d in left) / len(left))

    return propagated([number(row, "jammed") for row in of_alpha.values()], found)


def slopes(of_alpha):
    """Returns the slope of phi_m at grains alone over that at colloids alone."""
    least = min(alpha for alpha in of_alpha if alpha > 0)
    ends = [number(of_alpha[alpha], "jammed") for alpha in (1, 0.9, least, 0)]
    return propagated(ends, lambda v: (v[1] - v[0]) / 0.1 / ((v[2] - v[3]) / least))


def map_rows(points):
    for friction in ALONE:
        of = jammed_at(points, friction)
        name = f"μ = {friction}"
        best = place_of_largest([*of], [number(row, "jammed") for row in of.values()])
        yield Statement(f"{name}: share α of grains at which φ_m is largest", "L5.3c", *best, 0.6, 0.8, essential=False)
        yield Statement(f"{name}: how fast φ_m rises from α = 1 over how fast from 0", "L5.3c", *slopes(of), 1.5)
        yield alike(
            f"{name}: φ_m of colloids alone less that of grains alone",
            "L5.4b",
            number(of[0], "jammed"),
            number(of[1], "jammed"),
        )
        text = f"{name}: rms distance of φ_m(α) from the nearer packing model"
        yield Finding(text, "L5.4b", *distance_from_models(of, friction))  # print has no number for "matching"
        for alpha in (0.8, 0.85, 0.9):
            linear, rod = modelled(alpha, friction)
            share = over(difference(number(of[alpha], "jammed"), (linear, 0)), rod - linear)
            text = f"{name}, α = {alpha:g}: φ_m between the models (0: linear mixture, 1: rods)"
            yield Finding(text, "packing models", *share)
        yield Finding(f"{name}: exponent β of (1 - φ/φ_m)^-β", "L5.4a", *number(of[0], "exponent"))
    row = jammed_at(points, 1)[0.4]
    yield Statement("μ = 1, α = 0.4: rms of ln η_r about a power", "L5.4a", row["rms"], 0, high=0.1)
    off = from_nearer_model(number(row, "jammed"), 0.4, ALONE[1])
    yield Finding("μ = 1, α = 0.4: φ_m less that of the nearer packing model", "L5.4a", *off)


def dense_rows(points):
    """Yields statements about unjamming of dense grains by added colloids, from phi_m."""
    of = jammed_at(points, 1)

    def room(alpha):
        return over(number(of[alpha], "jammed"), colloids_added(alpha, DENSE))

    name = f"grains at φ₀ = {DENSE:g}, μ = 1: φ_m/φ"
    for alpha, low, high in ((1, 0, 1), (0.8, 1, math.inf), (0.5, 0, 1)):
        yield Statement(f"{name} at α = {alpha:g} (above 1: flows)", "L5.6", *room(alpha), low, high)
    text = f"{name} at α = 0.6 over that at 0.7 (further away)"
    yield Statement(text, "L5.6", *quotient(room(0.6), room(0.7)), low=1)
    for name, model in packing_models(ALONE[1]).items():
        of_model = [model(alpha) / colloids_added(alpha, DENSE) for alpha in (0.6, 0.7)]
        yield Finding(f"{text}, {name}", "packing models", of_model[0] / of_model[1], 0)


def consistency_rows(rows):
    for friction in ALONE:
        name, of = f"μ = {friction}, α = {TESTED:g}", where(rows, friction=friction)
        sizes = sorted(where(of, part="size"), key=lambda r: r["count"])
        for one, other in zip(sizes, sizes[1:]):
            text = f"{name}: η_r of {other['count']:.0f} spheres over that of {one['count']:.0f}"
            yield Check(text, "size", *row_ratio(other, one, "viscosity"), 0.9, 1.1, SEEDS - 1)
        parts = {f"stiff-{STIFFER}": f"contacts {STIFFER} times as stiff"}
        parts |= {f"light-{LIGHTER}": f"a density {LIGHTER} times less"}
        parts |= {"half-step": "half of the step", "late": "the strains 3 to 7 for 1 to 3"}
        for part, what in parts.items():
            ratio = row_ratio(first(of, part=part), sizes[0], "viscosity")
            yield Check(f"{name}: η_r with {what} over η_r", "Table 5.1", *ratio, 0.95, 1.05, SEEDS - 1)
    curves = [r for r in where(rows, part="curve") if r["seeds"]]
    flowing = [number(r, "mean_overlap") for r in curves if r["viscosity"] < 1000]
    yield Check("largest mean overlap where η_r < 1000", "Table 5.1", *max(flowing), high=0.01)


def judge():
    rows, points = read_rows(HERE / "table.csv"), read_rows(HERE / "jamming.csv")
    yield from map_rows(points)
    yield from dense_rows(points)
    yield from consistency_rows(rows)
    for row in read_rows(HERE / "order.csv"):
        text = f"μ = 0, α = {row['alpha']:g}, {row['group']}: peak of S(k), gradient over vorticity"
        yield Finding(text, "layers", *quotient(number(row, "gradient"), number(row, "vorticity")), row["seeds"] - 1)


def draw():
    rows, points = read_rows(HERE / "table.csv"), read_rows(HERE / "jamming.csv")
    figure = Figure(HERE / "chart.png", columns=2)
    ends = {"x_range": (-0.02, 1.02), "y_range": (0.46, 0.82)}
    panel = figure.panel("share of grains α", "φ_m", "where they jam", key="bottom center", **ends)
    for friction, colour in zip(ALONE, (BLUE, RED)):
        panel.rows(jammed_at(points, friction).values(), "alpha", "jammed", f"μ = {friction}", colour)
        draw_models(panel, ALONE[friction], colour, titled=friction == 0)
    for base, colour in zip((0.55, DENSE), (GREEN, ORANGE)):
        title = f"colloids added to φ₀ = {base:g}"
        panel.curve(lambda a, b=base: colloids_added(a, b), title, colour, span=(0.4, 1), dash=3)
    panel = figure.panel("1 - φ/φ_m", "η_r", "the law", log="xy", key="top right", x_range=(0.02, 0.3))
    for friction, mark in zip(ALONE, (6, 7)):
        of = jammed_at(points, friction)
        for alpha, colour in ((0, BLUE), (0.5, GREEN), (0.8, ORANGE), (1, RED)):
            if alpha not in of:
                continue
            curve = where(rows, part="curve", friction=friction, alpha=alpha)
            jammed = of[alpha]["jammed"]
            places = [(1 - r["fraction"] / jammed, *number(r, "viscosity")) for r in curve if r["seeds"]]
            panel.points(places, f"α = {alpha:g}, μ = {friction}", colour, mark)
    figure.draw()


def quick_measure(program):
    """Yields statements that mixing lowers the viscosity near the volume fraction at which either group jams."""
    for friction, fraction in ((0, 0.6), (1, 0.54)):
        alone, mixed = rows_of(program, "quick", friction, [(0, 300, fraction), (0.7, 1000, fraction)], 4)
        text = f"μ = {friction}, φ = {fraction:g}: η_r at α = 0.7 over that of colloids alone"
        yield Statement(text, "L5.3b", *row_ratio(mixed, alone, "viscosity"), 0, 0.8)


main(HERE, TITLE, measure, quick_measure, judge, draw)
