#!/usr/bin/python3
"""Time in which the viscosity becomes steady, from a random packing, in weak and in strong flow."""
import math
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from studies.driver import BLUE, Figure, Finding, GREEN, RED, Statement, TABLE_SCENE, entries, estimate, jackknife
from studies.driver import lines, main, merged, number, over, read_numbers, read_rows, where, write_numbers, write_rows
import numpy as np

TITLE = "Time until the viscosity is steady"
FRACTIONS = (0.45, 0.50, 0.54)
BLOCKS = 32  # of the window, which begins with the packing
WEAK, STRONG = 0.1, 1e4
# By Peclet number: seeds, unit and length of the window, its early part, right after the published 3 to 4 Brownian
# times or a strain of 2, and its late part, which gives the steady viscosity.
RUNS = {WEAK: (320, "brownian_times", 96, (3, 6), (63, 96)), STRONG: (48, "strain", 8, (2, 3), (5, 8))}
# The thesis has two Brownian times, η a³ / kT (3.57) and one with 6π (2.3), and does not say which one is meant by 3 to
# 4 times. LATER: 3 to 4 times with 6π, and the rest of the window.
DIFFUSION_TIME = 6 * math.pi
LATER = (57, 75), (75, 96)

TOLERANCE = 0.1  # published: "standard deviation less than 10 %"
LEFT = 0.05  # remaining part when 95 % are reached
SCENE = merged(TABLE_SCENE, duration=None)


def part_of(rows, length, ends):
    """Returns the means over the blocks between two times (seeds,)."""
    middles = (np.arange(BLOCKS) + 0.5) * length / BLOCKS
    return rows[:, (ends[0] < middles) & (middles < ends[1])].mean(axis=1)


def relaxation(values, length):
    """Returns the time of a least-squares fit of c + d exp(-t / time) to block means, and the t at which
    |d| exp(-t / time) is 5 % of c."""
    edges, times = np.arange(BLOCKS + 1) * length / BLOCKS, length * 10 ** (np.arange(-200, 1) / 100)
    decays = np.exp(-edges / times[:, None])
    shapes = -np.diff(decays, axis=1) * times[:, None] / np.diff(edges)
    constants, slopes, left = lines(shapes, values)
    best = np.argmin(left)
    return times[best], times[best] * max(0, math.log(max(abs(slopes[best]) / (LEFT * constants[best]), 1e-9)))


def numbers_of(rows, peclet):
    """Returns early over steady viscosity, the relaxation time, and the time to 95 %, by name, with jackknife errors
    and degrees of freedom."""
    _, _, length, early, late = RUNS[peclet]

    def share(*ends):
        before, then = (part_of(rows, length, of) for of in ends)
        return jackknife(lambda seeds: before[seeds].mean() / then[seeds].mean(), len(rows))

    times, errors = jackknife(lambda seeds: relaxation(rows[seeds].mean(axis=0), length), len(rows))
    names = ("early over steady", "time", "time to 95 %")
    numbers = dict(zip(names, (share(early, late), *zip(times, errors))))
    if peclet == WEAK:
        numbers["later over latest"] = share(*LATER)
    return {name: (*found, len(rows) - 1) for name, found in numbers.items()}


def measured(program, name, peclet, seeds, fractions, patch=None):
    """Runs a campaign and returns the block means of the viscosity of pairs (seeds, 32) by volume fraction."""
    _, unit, length, _, _ = RUNS[peclet]
    parts = {"equilibration": {"strain": 0}, "production": {unit: length}}
    scene = merged(SCENE, {"peclet": peclet, "duration": parts}, patch or {})
    program.run(name, scene, [{"/volume_fraction": f} for f in fractions], seeds)
    blocks = ([r["blocks"]["relative_viscosity_pair"] for r in of] for of in program.stored_results(name))
    return {f: np.array(rows) for f, rows in zip(fractions, blocks)}


def measure(program):
    table, numbers = [], {}
    for peclet, (seeds, unit, length, _, _) in RUNS.items():
        for fraction, rows in measured(program, f"start-{peclet:g}", peclet, seeds, FRACTIONS).items():
            found = numbers_of(rows, peclet)
            numbers |= {f"Pe = {peclet:g}, φ = {fraction:g}: {name}": of for name, of in found.items()}
            for k, values in enumerate(rows.T):
                place = {"peclet": peclet, "fraction": fraction, "seeds": len(rows), "unit": unit}
                place |= {"from": k * length / BLOCKS, "to": (k + 1) * length / BLOCKS}
                table.append(place | entries("pairs", estimate(values)))
    write_rows(HERE / "table.csv", table, 5)
    write_numbers(HERE / "numbers.csv", numbers)


def weak_rows(numbers):
    """Yields rows about weak flow. The sentence is about a smaller Peclet number, so that none is essential."""
    for fraction in FRACTIONS:
        name = f"Pe = {WEAK:g}, φ = {fraction:g}"
        for key, text in (
            ("early over steady", "η_r of pairs from 3 to 6 τ_B over that from 63 to 96 (published: 3 to 4 suffice)"),
            ("later over latest", "η_r of pairs from 57 to 75 τ_B, 3 to 4 with 6π, over that from 75 to 96"),
        ):
            *found, degrees = numbers[f"{name}: {key}"]
            bounds = {"low": 1 - TOLERANCE, "high": 1 + TOLERANCE, "essential": False}
            yield Statement(f"{name}: {text}", "L 4.2.1", *found, degrees=degrees, **bounds)
        *found, degrees = numbers[f"{name}: time to 95 %"]
        yield Finding(f"{name}: τ_B to 95 % of the steady η_r of pairs, by an exponential", "L 4.2.1", *found, degrees)
        yield Finding(f"{name}: the same over 6πηa³/kT", "L 4.2.1", *over(found, DIFFUSION_TIME), degrees)


def strong_rows(numbers):
    for fraction in FRACTIONS:
        name = f"Pe = {STRONG:g}, φ = {fraction:g}"
        *found, degrees = numbers[f"{name}: early over steady"]
        text = f"{name}: η_r of pairs from a strain of 2 to 3 over that from 5 to 8 (published: steady after 1 to 2)"
        yield Statement(text, "L 4.2.1", *found, 1 - TOLERANCE, 1 + TOLERANCE, degrees)
        *found, degrees = numbers[f"{name}: time to 95 %"]
        yield Finding(f"{name}: strain to 95 %, by an exponential", "L 4.2.1", *found, degrees)


def judge():
    numbers = read_numbers(HERE / "numbers.csv")
    return [*weak_rows(numbers), *strong_rows(numbers)]


def draw():
    table = read_rows(HERE / "table.csv")
    figure = Figure(HERE / "chart.png", columns=2)
    labels = {WEAK: "t / τ_B, from a random packing", STRONG: "strain, from a random packing"}
    for peclet, (_, _, length, early, late) in RUNS.items():
        ends = {"x_range": (0, length), "y_range": (0, 1.4)}
        title = "η_r of pairs over its steady value"
        panel = figure.panel(labels[peclet], title, f"Pe = {peclet:g}", key="bottom right", **ends)
        for fraction, colour in zip(FRACTIONS, (BLUE, GREEN, RED)):
            rows = where(table, peclet=peclet, fraction=fraction)
            steady = np.mean([r["pairs"] for r in rows if r["from"] >= late[0] - 1e-9])
            points = [((r["from"] + r["to"]) / 2, *over(number(r, "pairs"), steady)) for r in rows]
            panel.points(points, f"φ = {fraction:g}", colour, 7, 0.7, joined=True)
        panel.level(1, span=(0, length))
        for place in {WEAK: (4, LATER[0][1]), STRONG: (2,)}[peclet]:
            panel.upright(place)
    figure.draw()


def quick_measure(program):
    (rows,) = measured(program, "quick", STRONG, 16, (0.5,), {"particles": {"count": 100}}).values()
    _, _, length, early, late = RUNS[STRONG]
    steady = part_of(rows, length, late)
    found = numbers_of(rows, STRONG)["early over steady"]
    begins = estimate(part_of(rows, length, (0, length / BLOCKS)) / steady.mean())
    for text, source, value, low, high in (
        ("η_r from a strain of 2 to 3 over that from 5 to 8", "L 4.2.1", found[:2], 0.8, 1.2),
        ("η_r in the first quarter of a strain over that from 5 to 8", "L 4.2.1", begins, 0.2, 0.9),
        ("η_r of pairs from a strain of 5 to 8", "L4.5b", estimate(steady), 8, 15),
    ):
        yield Statement(f"Pe = {STRONG:g}, φ = 0.5: {text}", source, *value, low, high, 15)


main(HERE, TITLE, measure, quick_measure, judge, draw)
