#!/usr/bin/python3
"""Shear that is reversed, stopped, or combined with oscillatory cross shear; planar extension compared with shear."""
import math
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from studies.driver import BLUE, Check, Figure, Finding, GREEN, ORANGE, RED, REFERENCE_SCENE, difference, during
from studies.driver import entries, estimate, in_strains, main, merged, number, over, propagated, quotient, read_numbers
from studies.driver import read_rows, row_ratio, where, write_numbers, write_rows

TITLE = "Reversal, extension and shear across"
NONE = {"flow": None, "duration": None}
SCENE = merged(REFERENCE_SCENE, NONE, particles={"count": 200, "density": 1e-3}, fluid={"viscosity": 1})
FRICTION = {"contact": {"normal_stiffness": 2e5, "friction": 0.5}}
REVERSED, REVERSAL_SEEDS, BEFORE, AFTER, BINS = 0.50, 48, 4, 5, 100
EXTENSION = {0.02: 8, 0.30: 12, 0.40: 12, 0.50: 16}  # volume fraction and seeds
RATE = 1.0  # sqrt(2 E:E) of both flows
SHAKEN, SHAKEN_SEEDS = 0.54, 8
# Amplitudes of the cross shear, and frequencies over the rate.
SHAKES = (0.01, 30), (0.01, 100), (0.01, 300), (0.03, 30), (0.03, 100), (0.1, 30)


def point_of(program, name, patch, seeds, settings, observable="relative_viscosity"):
    (point,) = program.run(name, merged(SCENE, patch), [settings], seeds, observable)
    return point


def reversal_rows(program, levels):
    """Yields rows of a steady flow and of one that is reversed, with and without friction.

    Adds to `levels` their means over the window and over its last fifth, with errors over seeds.
    """
    turned = [{"shear_rate": RATE, "strain": BEFORE}, {"shear_rate": -RATE}]
    for name, contact in (("friction", FRICTION), ("none", {"contact": {"normal_stiffness": 2e5}})):
        for flow, segments in (("reversed", turned), ("steady", [{"shear_rate": RATE}])):
            patch = merged(contact, in_strains(BEFORE, AFTER), volume_fraction=REVERSED)
            patch |= {"observables": ["stress", "transient"], "transient": {"bins": BINS}}
            point = point_of(program, f"{flow}-{name}", patch, REVERSAL_SEEDS, {"/flow/segments": segments})
            means = point.means
            for part, begin in (("whole", 0), ("end", BINS - BINS // 5)):
                values = [sum(m["transient"]["shear_stress"][begin:]) / (BINS - begin) for m in means]
                levels[f"{flow}-{name}-{part}"] = (*estimate(values), len(values) - 1)
            for k in range(BINS):
                row = {"contacts": name, "flow": flow, "strain": (k + 0.5) / BINS * AFTER, "seeds": len(means)}
                for quantity, path in (("viscosity", "shear_stress"), ("normal", "first_normal_difference")):
                    row |= entries(quantity, point.measured(f"transient/{path}", k))
                yield row


def extension_rows(program):
    for fraction, seeds in EXTENSION.items():
        patch = {"volume_fraction": fraction, "contact": {"normal_stiffness": 2e5}, **in_strains(1, 6)}
        shear = point_of(program, f"shear-{fraction:g}", patch, seeds, {"/flow/shear_rate": RATE})
        # Hencky strains, so that the invariants of both strains are equal.
        patch |= in_strains(0.5, 3)
        extension = point_of(program, f"extension-{fraction:g}", patch, seeds, {"/flow/extension_rate": RATE / 2})
        row = {"fraction": fraction, "seeds": min(len(shear.results), len(extension.results))}
        for name, point in (("shear", shear), ("extension", extension)):
            row |= entries(name, point.measured("relative_viscosity"))
        yield row | entries("second", extension.measured("second_normal_difference"))


def shaken_rows(program):
    """Yields rows of cross shear. The dissipation is that of both shears over viscosity * rate^2 of the steady one."""
    patch = merged(FRICTION, contact={"normal_stiffness": 1e6}, volume_fraction=SHAKEN)
    patch |= in_strains(2, 8)
    still = point_of(program, "still", patch, SHAKEN_SEEDS, {"/flow/shear_rate": RATE})
    alone = {"amplitude": 0, "frequency": 0, "seeds": len(still.results)}
    viscosity = still.measured("relative_viscosity")
    yield alone | entries("viscosity", viscosity) | entries("dissipation", viscosity)
    for amplitude, frequency in SHAKES:
        cycles = math.ceil(8 * frequency / (2 * math.pi))
        patch |= during({"cycles": math.ceil(cycles / 4)}, {"cycles": cycles})
        patch |= {"observables": ["stress", "oscillation"]}
        cross = {"amplitude": amplitude, "frequency": frequency * RATE}
        settings = {"/flow/shear_rate": RATE, "/flow/cross_shear": cross}
        point = point_of(program, f"shaken-{amplitude:g}-{frequency:g}", patch, SHAKEN_SEEDS, settings)
        row = {"amplitude": amplitude, "frequency": frequency, "seeds": len(point.means)}
        row |= entries("viscosity", point.measured("relative_viscosity"))
        # <sigma_yz rate across> = g^2 w G'' / 2.
        factor = amplitude**2 * frequency * RATE / 2 / RATE**2
        total = [m["relative_viscosity"] + factor * m["loss_modulus"] for m in point.means]
        yield row | entries("dissipation", estimate(total))


def measure(program):
    write_rows(HERE / "extension.csv", list(extension_rows(program)), 5)
    write_rows(HERE / "shaken.csv", list(shaken_rows(program)), 5)
    levels = {}
    write_rows(HERE / "reversal.csv", list(reversal_rows(program, levels)), 5)
    write_numbers(HERE / "levels.csv", levels)


def reversed_curve(contacts):
    rows = where(read_rows(HERE / "reversal.csv"), contacts=contacts, flow="reversed")
    return [(r["strain"], *number(r, "viscosity")) for r in rows]


def places_of(turned, level):
    """Returns the strains at which a curve is lowest and at which it is back at nine tenths of a level, with errors
    from those of its points and from the width of a bin."""

    def found(values):
        pairs = list(zip((strain for strain, *_ in turned), values))
        lowest, _ = min(pairs, key=lambda pair: pair[1])
        return lowest, next((s for s, value in pairs if s > lowest and value > 0.9 * level), math.nan)

    places, errors = propagated([(value, error) for _, value, error in turned], found)
    return [(place, math.hypot(error, AFTER / BINS / math.sqrt(12))) for place, error in zip(places, errors)]


def pairs_in_extension(row):
    """Returns the viscosity of the pairs in extension over that in shear."""
    alone = 1 + 2.5 * row["fraction"], 0
    return quotient(*(difference(number(row, flow), alone) for flow in ("extension", "shear")))


def judge():
    for row in read_rows(HERE / "extension.csv"):
        ratio = quotient(number(row, "extension"), number(row, "shear"))
        fraction, degrees = row["fraction"], row["seeds"] - 1
        if fraction < 0.1:
            text, found = f"φ = {fraction:g}: η_E of planar extension over 1 + 2.5 φ", number(row, "extension")
            yield Check(text, "Newtonian limit", *over(found, 1 + 2.5 * fraction), 0.99, 1.02, degrees)
        text = f"φ = {fraction:g}: η_E of planar extension over that of shear at the same invariants"
        yield Finding(text, "extension", *ratio, degrees)
        yield Finding(f"φ = {fraction:g}: the same of the pairs", "extension", *pairs_in_extension(row), degrees)
    for contacts, name in (("friction", "friction 0.5"), ("none", "no friction")):
        turned, levels, degrees = reversed_curve(contacts), read_numbers(HERE / "levels.csv"), REVERSAL_SEEDS - 1
        level, last = levels[f"steady-{contacts}-whole"][:2], levels[f"reversed-{contacts}-end"][:2]
        text = f"{name}: viscosity a strain of {0.9 * AFTER:g} after the reversal over that of steady shear"
        yield Check(text, "steady shear", *quotient(last, level), 0.92, 1.08, degrees)
        lowest = min(turned, key=lambda point: point[1])
        text = f"{name}: lowest viscosity after the reversal over that of steady shear"
        yield Finding(text, "reversal", *quotient(lowest[1:], level), degrees)
        for what, (place, error) in zip(("it is lowest", "nine tenths of it are back"), places_of(turned, level[0])):
            yield Finding(f"{name}: strain at which {what}", "reversal", place, error, degrees)
    still, *shaken = read_rows(HERE / "shaken.csv")
    best = min(shaken, key=lambda row: row["viscosity"])
    text = f"shaken across by {best['amplitude']:g} at {best['frequency']:g} γ̇: viscosity over that without"
    yield Check(text, "Lin et al. 2016: it falls", *row_ratio(best, still, "viscosity"), 0, 0.8, best["seeds"] - 1)
    for row in shaken:
        text = f"amplitude {row['amplitude']:g}, frequency {row['frequency']:g} γ̇: "
        for name, what in (("viscosity", "viscosity"), ("dissipation", "dissipation of both")):
            ratio = quotient(number(row, name), number(still, "viscosity"))
            yield Finding(f"{text}{what} over that of shear alone", "shaking", *ratio, row["seeds"] - 1)


def draw():
    figure = Figure(HERE / "chart.png", columns=3, size=(1500, 480))
    place = {"key": "bottom right", "y_range": (0, None)}
    one = figure.panel("strain after the reversal", "η_r", f"φ = {REVERSED:.2f}", **place)
    for contacts, name, colour in (("friction", "friction 0.5", RED), ("none", "no friction", BLUE)):
        one.points(reversed_curve(contacts), name, colour, 7, 0.6, joined=True)
        one.level(read_numbers(HERE / "levels.csv")[f"steady-{contacts}-whole"][0], None, colour, span=(0, AFTER))
    ends = {"x_range": (0, 0.52), "y_range": (0.9, 1.3)}
    two = figure.panel("φ", "η_E of the pairs over that of shear", "planar extension at the same invariants", **ends)
    two.level(1)
    rows = read_rows(HERE / "extension.csv")
    two.points([(row["fraction"], *pairs_in_extension(row)) for row in rows], None, RED, 7, 1.2)
    still, *shaken = read_rows(HERE / "shaken.csv")
    place = {"log": "x", "key": "top right", "x_range": (0.2, 5), "y_range": (0, 1.4)}
    title = f"shaken along the vorticity, φ = {SHAKEN:.2f}, friction 0.5"
    three = figure.panel("largest rate across / γ̇", "viscosity over that of shear alone", title, **place)
    for amplitude, colour in ((0.01, BLUE), (0.03, GREEN), (0.1, ORANGE)):
        mine = where(shaken, amplitude=amplitude)
        points = [(amplitude * r["frequency"], *row_ratio(r, still, "viscosity")) for r in mine]
        three.points(points, f"amplitude {amplitude:g}", colour, joined=True)
    figure.draw()


def quick_measure(program):
    """Yields checks that a dilute suspension has the same viscosity in extension and in shear."""
    patch = {"volume_fraction": 0.05, "particles": {"count": 50}, **in_strains(0.1, 1)}
    for name, settings in (("shear", {"/flow/shear_rate": 1}), ("extension", {"/flow/extension_rate": 0.5})):
        value = point_of(program, name, patch, 4, settings).measured("relative_viscosity")
        yield Check(f"φ = 0.05: η of {name}", "1 + 2.5 φ and pairs", *value, 1.124, 1.2, 3)


main(HERE, TITLE, measure, quick_measure, judge, draw)
