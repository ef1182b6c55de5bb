#!/usr/bin/python3
"""Colloids and grains without noise: where mixtures of radii 1, 1.4, 5 and 7 jam, with and without friction, beside two
models of packings; and whether dense grains flow better when colloids are added to them."""
import math
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from studies.compositions import COLLOIDS, GRAINS, MIXTURE_SCENE, colloids_added, composition_row, packing_models
from studies.compositions import setting_of
from studies.driver import BLUE, Check, Figure, Finding, GREEN, ORANGE, RED, Statement, columns_of, difference, during
from studies.driver import entries, estimate, main, merged, number, over, place_of_largest, propagated, quotient
from studies.driver import read_rows, row_ratio, viscosity_row, where, write_table
import numpy as np

TITLE = "Colloids and grains without noise"
SCENE = merged(MIXTURE_SCENE, during({"strain": 1}, {"strain": 2}))
# Share of the grains in the volume of all spheres, and how many spheres that takes for some thirty grains.
COUNTS = {0: 1000, 0.4: 5000, 0.5: 4000, 0.6: 3000, 0.7: 2000, 0.75: 2000, 0.8: 1500, 0.85: 1500, 0.9: 1000, 1: 1000}
ALONE = {0: 0.64, 1: 0.57}  # in print: where one group alone jams, by friction
# How far below the volume fractions at which a pilot had them jam.
BELOW = {0: (0.10, 0.075, 0.055, 0.04, 0.025), 1: (0.12, 0.09, 0.065, 0.045, 0.03)}
PILOT = {
    0: dict(zip(COUNTS, (0.637, 0.722, 0.745, 0.762, 0.78, 0.778, 0.76, 0.739, 0.704, 0.637))),
    1: dict(zip(COUNTS, (0.577, 0.66, 0.675, 0.69, 0.685, 0.672, 0.655, 0.64, 0.61, 0.577))),
}
SEEDS = 4
# Colloids added to grains of this volume fraction, with friction: whether they leave the jam.
DENSE = 0.60
# What may not matter, at a share of grains and so far below the jam: so many times as many spheres, contacts so many
# times as stiff, and spheres so many times as light.
SIZES, STIFFER, LIGHTER, TESTED, FAR = (0.5, 1, 2, 4), 4, 4, 0.5, {0: 0.055, 1: 0.09}
ORDERED = (0.5, 0.75)  # shares of grains that are searched for layers, without friction
LAYERED = 0.04  # so far below the jam


def stiffness_of(friction, alpha):
    """With friction curves are needed up to larger stresses, and where grains carry these, contacts of larger
    spheres."""
    if friction == 0:
        return 1e5
    return 2e5 if alpha < 0.75 else 4e5 if alpha < 0.9 else 1e6


def below(friction, alpha, distance):
    return round(PILOT[friction][alpha] - distance, 4)


def rows_of(program, part, friction, cases, seeds=SEEDS, stiffer=1, density=SCENE["particles"]["density"]):
    """Rows of (share of grains, number of spheres, volume fraction)."""
    scene = merged(SCENE, {"contact": {"friction": friction}, "particles": {"density": density}})
    settings = [setting_of(*case, stiffer * stiffness_of(friction, case[0])) for case in cases]
    for setting, point in zip(settings, program.run(f"{part}-{friction}", scene, settings, seeds)):
        yield {
            "part": part,
            "friction": friction,
            **composition_row(setting),
            **viscosity_row(point, "mean_overlap"),
            "overlap": max((r["largest_overlap"] for r in point.results), default=math.nan),
        }


def layer_peaks(path, radii):
    """Of a final configuration: the largest |sum of exp(i k r)|^2 / N of the spheres of these radii, along the gradient
    and along the vorticity, among the waves that are 0.75 to 1.3 mean diameters long. Where nothing is ordered it is
    the peak of a liquid's structure factor, the same for both; of perfect layers it is N."""
    with open(path) as f:
        f.readline()
        lattice = [float(x) for x in f.readline().split('Lattice="')[1].split('"')[0].split()]
        *place, radius = np.loadtxt(f, usecols=(1, 2, 3, 4)).T
    chosen = np.isin(radius, radii)
    diameter = 2 * radius[chosen].mean()
    for height, length in ((place[1][chosen], lattice[4]), (place[2][chosen], lattice[8])):
        waves = np.arange(math.ceil(length / (1.3 * diameter)), math.floor(length / (0.75 * diameter)) + 1)
        sums = np.exp(2j * math.pi * np.outer(waves, height) / length).sum(axis=1)
        yield float(np.max(np.abs(sums) ** 2) / len(height))


def order_rows(program):
    scene = merged(SCENE, {"contact": {"friction": 0}, "files": {"final_configuration": True}})
    settings = [
        {
            "/particles/mixture/alpha": alpha,
            "/particles/count": 2 * COUNTS[alpha],
            "/volume_fraction": below(0, alpha, LAYERED),
        }
        for alpha in ORDERED
    ]
    folder = Path(program.folder) / "order-0.peclet"
    for alpha, point in zip(ORDERED, program.run("order-0", scene, settings, 2 * SEEDS)):
        paths = [folder / f["path"] for r in point["realisations"] for f in r.get("files") or []]
        for group, radii in (("colloids", COLLOIDS), ("grains", GRAINS)):
            gradient, vorticity = zip(*(layer_peaks(path, radii) for path in paths))
            row = {"alpha": alpha, "group": group, "seeds": len(paths)}
            yield row | entries("gradient", estimate(gradient)) | entries("vorticity", estimate(vorticity))


def measure(program):
    rows, jams = [], []
    for friction in ALONE:
        curves = [(a, n, below(friction, a, d)) for a, n in COUNTS.items() for d in BELOW[friction]]
        rows += rows_of(program, "curve", friction, curves)
        jams += jamming_rows(program, friction)
    for friction, distance in FAR.items():
        fraction = below(friction, TESTED, distance)
        sizes = [(TESTED, round(factor * COUNTS[TESTED]), fraction) for factor in SIZES]
        rows += rows_of(program, "size", friction, sizes)
        rows += rows_of(program, f"stiff-{STIFFER}", friction, sizes[:1], stiffer=STIFFER)
        light = SCENE["particles"]["density"] / LIGHTER
        rows += rows_of(program, f"light-{LIGHTER}", friction, sizes[:1], density=light)
    names = ["part", "friction", "alpha", "count", "grains", "fraction", "stiffness", "seeds", "lost", "transient"]
    names += ["overlap", *columns_of("viscosity", "pairs", "lubrication", "contact", "mean_overlap")]
    write_table(HERE / "table.csv", names, rows, 5)
    write_table(HERE / "jamming.csv", JAMMING, jams, 5)
    names = ["alpha", "group", "seeds", *columns_of("gradient", "vorticity")]
    write_table(HERE / "order.csv", names, list(order_rows(program)), 4)


LAW = "jammed", "prefactor", "exponent"
JAMMING = ["friction", "alpha", "points", *columns_of(*LAW), "rms", "chi squared", "degrees", "flowing", "stuck"]


def jamming_rows(program, friction):
    """The law of the divergence through the points of each share of grains, with one exponent for all: what `peclet
    jamming` says of the campaign."""
    found = program.asked("jamming", f"curve-{friction}", "--common-exponent")
    exponent = found["common"]["exponent"]
    for curve in sorted(found["curves"], key=lambda c: c["settings"]["/particles/mixture/alpha"]):
        law, stuck = curve["law"], curve["smallest_stuck"]
        row = {
            "friction": friction,
            "alpha": curve["settings"]["/particles/mixture/alpha"],
            "flowing": curve["largest_flowing"] or math.nan,
            "stuck": stuck["fraction"] if stuck else math.nan,
        }
        row |= {"points": 0, "rms": math.nan, "chi squared": math.nan, "degrees": 0}
        row |= {k: v for name in LAW for k, v in entries(name, (math.nan, math.inf)).items()}
        if law["phi_m"]:
            fitted = [p for p in curve["points"] if p["fitted"]]
            numbers = [(law["phi_m"]["value"], law["phi_m"]["standard_error"])]
            numbers.append((law["prefactor"]["value"], law["prefactor"]["standard_error"]))
            numbers.append((exponent["value"], exponent["standard_error"]))
            (jammed, _), (prefactor, _), (power, _) = numbers
            left = [math.log(p["mean"] / prefactor) + power * math.log(1 - p["fraction"] / jammed) for p in fitted]
            row |= {"points": len(fitted), "rms": math.sqrt(sum(x * x for x in left) / len(left))}
            row |= {"chi squared": law["chi_squared"], "degrees": law["degrees"]}
            row |= {k: v for name, value in zip(LAW, numbers) for k, v in entries(name, value).items()}
        yield row


def jammed_at(points, friction):
    return {p["alpha"]: p for p in points if p["friction"] == friction and p["points"]}


def optimum(of_alpha):
    """The share of grains at which phi_m is largest, among those that were measured."""
    alphas = list(of_alpha)
    return place_of_largest(alphas, [number(of_alpha[alpha], "jammed") for alpha in alphas])


def modelled(alpha, friction):
    """What the two models say."""
    of = packing_models(ALONE[friction])
    return of["linear mixture"](alpha), of["rods"](alpha)


def from_nearer_model(of_alpha, friction):
    """Root of the mean square distance of phi_m from the nearer of the two models."""
    said = [modelled(alpha, friction) for alpha in of_alpha]

    def found(values):
        left = [min(abs(v - model) for model in pair) for v, pair in zip(values, said)]
        return math.sqrt(sum(d * d for d in left) / len(left))

    return propagated([number(row, "jammed") for row in of_alpha.values()], found)


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
        yield Statement(text, "L5.4b", *from_nearer_model(of, friction), high=0.015, essential=False)
        for alpha in (0.8, 0.85, 0.9):
            linear, rod = modelled(alpha, friction)
            share = over(difference(number(of[alpha], "jammed"), (linear, 0)), rod - linear)
            text = f"{name}, α = {alpha:g}: φ_m between the models (0: linear mixture, 1: rods)"
            yield Finding(text, "packing models", *share)
        yield Finding(f"{name}: exponent β of (1 - φ/φ_m)^-β", "L5.4a", *number(of[0], "exponent"))
    row = jammed_at(points, 1)[0.4]
    yield Statement("μ = 1, α = 0.4: rms of ln η_r about a power", "L5.4a", row["rms"], 0, high=0.1)
    off = min((difference(number(row, "jammed"), (model, 0)) for model in modelled(0.4, 1)), key=lambda d: abs(d[0]))
    text = "μ = 1, α = 0.4: φ_m less that of the nearer packing model"
    yield Statement(text, "L5.4a", *off, -0.015, 0.015, essential=False)


def dense_rows(points):
    """Whether dense grains leave the jam when colloids are added, by phi_m."""
    of = jammed_at(points, 1)

    def room(alpha):
        return over(number(of[alpha], "jammed"), colloids_added(alpha, DENSE))

    name = f"grains at φ₀ = {DENSE:g}, μ = 1: φ_m/φ"
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
            ratio = row_ratio(other, one, "viscosity")
            text = f"{name}: η_r of {other['count']:.0f} spheres over that of {one['count']:.0f}"
            yield Check(text, "size", *ratio, 0.9, 1.1, SEEDS - 1)
        for part, what in (
            ("stiff", f"contacts {STIFFER} times as stiff"),
            ("light", f"a density {LIGHTER} times less"),
        ):
            (changed,) = of_part[f"{part}-{STIFFER if part == 'stiff' else LIGHTER}"]
            ratio = row_ratio(changed, sizes[0], "viscosity")
            yield Check(f"{name}: η_r with {what} over η_r", "Table 5.1", *ratio, 0.95, 1.05, SEEDS - 1)
    curves = [r for r in rows if r["part"] == "curve" and r["seeds"]]
    flowing = [number(r, "mean_overlap") for r in curves if r["viscosity"] < 1000]
    yield Check("largest mean overlap where η_r < 1000", "Table 5.1", *max(flowing), high=0.01)


def order_statements(order):
    for row in order:
        ratio = quotient(number(row, "gradient"), number(row, "vorticity"))
        text = f"μ = 0, α = {row['alpha']:g}, {row['group']}: peak of S(k), gradient over vorticity"
        yield Finding(text, "layers", *ratio, row["seeds"] - 1)


def judge():
    rows, points = read_rows(HERE / "table.csv"), read_rows(HERE / "jamming.csv")
    yield from map_rows(points)
    yield from dense_rows(points)
    yield from consistency_rows(rows)
    yield from order_statements(read_rows(HERE / "order.csv"))


def draw():
    rows, points = read_rows(HERE / "table.csv"), read_rows(HERE / "jamming.csv")
    figure = Figure(HERE / "chart.png", columns=2)
    ends = {"x_range": (-0.02, 1.02), "y_range": (0.46, 0.82)}
    panel = figure.panel("share of grains α", "φ_m", "where they jam", key="bottom center", **ends)
    for friction, colour in zip(ALONE, (BLUE, RED)):
        of = jammed_at(points, friction)
        panel.points([(a, *number(r, "jammed")) for a, r in of.items()], f"μ = {friction}", colour)
        for dash, (name, model) in zip((1, 2), packing_models(ALONE[friction]).items()):
            title = name if friction == 0 else None
            panel.curve(model, title, colour, span=(0, 1), samples=81, dash=dash)
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
    """Grains at which friction jams colloids or grains alone, mixed."""
    smooth, rough = (
        {r["alpha"]: r for r in rows_of(program, "quick", friction, cases, 4)}
        for friction, cases in ((0, [(0, 300, 0.6), (0.7, 1000, 0.6)]), (1, [(0, 300, 0.54), (0.7, 1000, 0.54)]))
    )
    for name, of in (("μ = 0, φ = 0.6", smooth), ("μ = 1, φ = 0.54", rough)):
        ratio = row_ratio(of[0.7], of[0], "viscosity")
        yield Statement(f"{name}: η_r at α = 0.7 over that of colloids alone", "L5.3b", *ratio, 0, 0.8)


main(HERE, TITLE, measure, quick_measure, judge, draw)
