#!/usr/bin/python3
"""Processor time of a run against the number of particles."""
import statistics
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from studies.driver import BLUE, Figure, Finding, RED, REFERENCE_SCENE, Statement, at_peclet, estimate, line_through
from studies.driver import main, merged, read_numbers, where, write_numbers, write_rows
import numpy as np

TITLE = "Time against the number of particles"
SCENE = merged(REFERENCE_SCENE, at_peclet(1), duration={"equilibration": {"time": 0}})
PUBLISHED = 10000  # largest published number of particles
COUNTS = (10, 30, 100, 300, 1000, 3000, PUBLISHED, 30000, 100000)
QUICK_COUNTS = (100, 1000, 4000)  # with fewer spheres the fixed cost of a step matters
ONE_THREAD = ("--workers", "1", "--threads", "1")
SHORT = 36  # steps of the shorter run of a pair; a window has at least 32 steps
CLOCKS = {"processor": "cpu_seconds", "wall": "wall_seconds"}


def times(program, counts, rounds, particle_steps, method="implicit"):
    """Returns rows by number of particles with ns of processor and wall time per particle-step, for every round.

    Times are differences of a longer and a shorter run, which removes packing, start and end.
    """
    scene = merged(SCENE, integrator={"method": method})
    step = program.derived(merged(scene, duration={"production": {"time": 1}}))["timestep"]
    settings, more = [], [max(SHORT, round(particle_steps / count)) for count in counts]
    for count, steps in zip(counts, more):
        # Half a step less, so that rounding does not add a step.
        for n in (SHORT, SHORT + steps):
            settings.append({"/particles/count": count, "/duration/production/time": (n - 0.5) * step})
    points = program.run(f"scaling-{method}", scene, settings, rounds, "relative_viscosity_pair", ONE_THREAD)
    return [row_of(count, *pair) for count, pair in zip(counts, zip(points[::2], points[1::2]))]


def row_of(count, short, longer):
    rounds = [*zip(short["realisations"], longer["realisations"])]
    steps = [b["steps"]["production"] - a["steps"]["production"] for a, b in rounds]
    row = {"particles": count, "steps": steps[-1]}
    for time, key in CLOCKS.items():
        row[time] = [1e9 * (b["cost"][key] - a["cost"][key]) / (n * count) for (a, b), n in zip(rounds, steps)]
    return row


def exponent(table, largest, time):
    """Returns the exponent of the time of a step against N, from a line through logarithms of medians over rounds.

    The error is that of the mean of the exponents of single rounds.
    """
    rows = [r for r in table if r["particles"] <= largest]
    counts = np.array([r["particles"] for r in rows])

    def slope(values):
        return line_through(np.log(counts), np.log(values * counts), np.ones(len(counts)))[1]

    rounds = np.array([r[time] for r in rows])
    return slope(np.median(rounds, axis=1)), estimate([slope(values) for values in rounds.T])[1]


def number_of(method, table, largest, time="processor"):
    """Returns the name of an exponent, and its value, standard error and degrees of freedom."""
    name = f"{method} steps: exponent of {time} time, N = {table[0]['particles']} to {largest}"
    return name, (*exponent(table, largest, time), len(table[0][time]) - 1)


def judge():
    """Yields the statement about processor time up to the published number of spheres, and findings beyond it."""
    for name, (*found, degrees) in read_numbers(HERE / "numbers.csv").items():
        if name.endswith(f"processor time, N = 10 to {PUBLISHED}"):
            yield Statement(f"{name} (published: 1)", "L4.4", *found, 0.9, 1.1, degrees)
        else:
            yield Finding(name, "L4.4", *found, degrees)


def table_row(method, row):
    summary = {"method": method, "particles": row["particles"], "steps": row["steps"]}
    for time in CLOCKS:
        for name, of in (("ns", statistics.median), ("lowest", min), ("highest", max)):
            summary[f"{time}_{name}"] = of(row[time])
    return summary


def measure(program):
    implicit = times(program, COUNTS, 5, 1e6)
    # Explicit steps are cheap: with few of them the difference would be that of two packings.
    explicit = times(program, [n for n in COUNTS[::2] if n <= PUBLISHED], 10, 2e7, "explicit")
    rows = [table_row(m, row) for m, table in (("implicit", implicit), ("explicit", explicit)) for row in table]
    write_rows(HERE / "table.csv", rows, 4)
    draw(rows)
    numbers = [number_of("implicit", implicit, PUBLISHED), number_of("explicit", explicit, PUBLISHED)]
    numbers += [number_of("implicit", implicit, COUNTS[-1]), number_of("implicit", implicit, PUBLISHED, "wall")]
    write_numbers(HERE / "numbers.csv", dict(numbers))


def draw(rows):
    """Draws the table."""
    figure = Figure(HERE / "chart.png", columns=2)
    axes = {"log": "xy", "key": "top left", "x_range": (5, 200000)}
    of_step = figure.panel("N", "processor time of a step, s", powers="xy", **axes)
    title = "processor time of a step of a particle, ns"
    of_particle = figure.panel("N", title, powers="x", y_range=(30, 5000), **axes)
    middle = next(r["processor_ns"] for r in rows if r["method"] == "implicit" and r["particles"] == 1000)
    of_step.curve(lambda n: middle * 1e-9 * n, "proportional to N")
    for method, colour, mark in (("implicit", BLUE, 7), ("explicit", RED, 5)):
        chosen = where(rows, method=method)
        counts = np.array([r["particles"] for r in chosen])
        bars = np.array([[r[f"processor_{name}"] for name in ("ns", "lowest", "highest")] for r in chosen])
        in_all = np.column_stack((counts, bars * counts[:, None] * 1e-9))
        of_step.points(in_all, f"{method} steps", colour, mark)
        of_particle.points(np.column_stack((counts, bars)), f"{method} steps", colour, mark, joined=True)
    figure.draw()


def quick_measure(program):
    """Returns a statement about the exponent that a busy machine does not change: nearer to 1 than to 0 or 2."""
    name, (value, error, degrees) = number_of("implicit", times(program, QUICK_COUNTS, 5, 2e5), QUICK_COUNTS[-1])
    return [Statement(name, "L4.4", value, error, 0.5, 1.5, degrees)]


main(HERE, TITLE, measure, quick_measure, judge)
