#!/usr/bin/python3
"""Two spheres in a cube of edge 4 a: the distribution of their distances, and the potential of mean force."""
import math
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from studies.driver import BLUE, Check, Figure, RED, Statement, difference, estimate, in_brownian_times, logarithm, main
from studies.driver import over, read_numbers, write_numbers, write_rows
import numpy as np

TITLE = "Potential of mean force of two spheres"
THERMAL_ENERGY, STIFFNESS = 0.017, 170.0  # thermal overlap sqrt(kT / k_n) = 0.01 a
BIN = 0.005
INNER, OUTER = 2.001, 2.05  # distances at the gaps of lubrication
SCENE = {
    "particles": {"count": 2, "density": 0.1, "species": [{"radius": 1.0}]},
    "volume_fraction": 2 * 4 / 3 * math.pi / 4**3,
    "fluid": {"viscosity": 0.1, "thermal_energy": THERMAL_ENERGY},
    "flow": {"shear_rate": 0},
    "contact": {"normal_stiffness": STIFFNESS},
    "lubrication": {"form": "kim-karrila", "inner_gap": 1e-3, "outer_gap": 0.05},
    "observables": ["stress", "pair_distribution"],
    "pair_distribution": {"range": 2.825, "bin": BIN, "slab": 0.1, "interval": 0.1},
    "guard": {"largest_overlap": 0.2},
}
# Method, seeds, Brownian times of each seed.
RUNS = [("implicit", 64, 4000), ("explicit", 32, 1000)]
QUICK_RUNS = [("implicit", 16, 1200)]


def contact_energy(distance):
    """Returns U / kT of the contact, k_n (2 a - r)^2 / 2 kT."""
    return STIFFNESS * np.maximum(2 - distance, 0) ** 2 / (2 * THERMAL_ENERGY)


def densities(point):
    """Returns distances, and counts over ideal counts (seeds, bins), normalised to 1 between 2.2 and 2.8 a, where
    forces are absent."""
    radial = [r["mean"]["pair_distribution"]["radial"] for r in point["realisations"]]
    distance = np.array(radial[0]["r"])
    counts, ideal = (np.array([r[name] for r in radial]) for name in ("counts", "ideal"))
    far = (2.2 < distance) & (distance < 2.8)
    level = counts[:, far].sum(axis=1) / ideal[:, far].sum(axis=1)
    return distance, counts / ideal / level[:, None]


def mean_density(distance, rows, low, high):
    """Returns the mean density over the shells between two distances, with its standard error over seeds."""
    chosen = (low < distance) & (distance < high)
    return estimate(np.average(rows[:, chosen], axis=1, weights=distance[chosen] ** 2))


def potential(distance, rows, low, high):
    value, error = logarithm(mean_density(distance, rows, low, high))
    return -value, error


def contact_ratio(distance, rows):
    """Returns the density at overlaps up to two thermal ones over the mean of exp(-U / kT), both weighted with r^2."""
    low, parts = 1.98, 2000
    r = low + (2 - low) * (np.arange(parts) + 0.5) / parts
    expected = np.average(np.exp(-contact_energy(r)), weights=r**2)
    return over(mean_density(distance, rows, low, 2), expected)


INSIDE, BEYOND = "U / kT = 0 between contact and the outer gap", "U / kT = 0 beyond the outer gap, to 2.155 a"
AT_OUTER = "no step of U / kT at the outer gap, means over 0.04 and 0.1 a"
AT_INNER = "no step of U / kT at the inner gap"
OVERLAPS = "density of overlaps over that of U = k_n δ² / 2"
SHELLS = "no step of U / kT from the shell of 0.005 a within the outer gap to the next one"
# Known errors of a method at its automatic step. Their rows are checks of the method, and the other method decides.
# Velocity Verlet has too few overlaps, by the factor 1 - λ Δt / 2; implicit steps cross the outer gap.
KNOWN = {("explicit", OVERLAPS), ("implicit", SHELLS)}


def numbers_of(method, distance, rows):
    """Returns (value, standard error, degrees of freedom) by name."""
    inner, outer = (potential(distance, rows, *ends) for ends in ((2.005, 2.045), (2.055, 2.155)))
    touching = potential(distance, rows, 2.0, 2.005)
    inside, outside = (potential(distance, rows, *ends) for ends in ((2.045, 2.05), (2.05, 2.055)))
    found = {
        INSIDE: inner,
        BEYOND: outer,
        AT_OUTER: difference(inner, outer),
        AT_INNER: difference(touching, inner),
        OVERLAPS: contact_ratio(distance, rows),
        SHELLS: difference(outside, inside),
    }
    return {f"{method} steps: {name}": (*of, len(rows) - 1) for name, of in found.items()}


def judged(numbers, tolerance):
    """Yields the rows. The tolerance, 0.1 kT or 0.1 of the density, is the resolution of the published figures."""
    for name, (*found, degrees) in numbers.items():
        method, what = name.split(" steps: ")
        kind, source = (Check, "step") if (method, what) in KNOWN else (Statement, "L4.1")
        middle = 1 if what == OVERLAPS else 0
        yield kind(name, source, *found, middle - tolerance, middle + tolerance, degrees)


def judge():
    return judged(read_numbers(HERE / "numbers.csv"), 0.1)


def point_of(program, method, seeds, brownian_times):
    scene = {**SCENE, "integrator": {"method": method}, **in_brownian_times(20, brownian_times)}
    return program.run(f"pair-potential-{method}", scene, [{"/particles/count": 2}], seeds, "kinetic_temperature")[0]


def measure(program):
    numbers, table = {}, []
    names = "method", "distance", "density", "standard_error"
    for method, *how in RUNS:
        distance, rows = densities(point_of(program, method, *how))
        numbers |= numbers_of(method, distance, rows)
        shells = ((r, values) for r, values in zip(distance.tolist(), rows.T) if r > 1.95)
        table += [dict(zip(names, (method, r, *estimate(values)))) for r, values in shells]
    write_rows(HERE / "table.csv", table, 5)
    write_numbers(HERE / "numbers.csv", numbers)
    draw(table)


def draw(table):
    figure = Figure(HERE / "chart.png", columns=2)
    density = figure.panel("r / a", "g(r)", key="bottom right", x_range=(1.95, 2.8), y_range=(0, 1.3))
    energy = figure.panel("r / a", "U / kT", x_range=(1.965, 2.08), y_range=(-0.3, 4))
    for gap, name in ((INNER, "inner gap"), (OUTER, "outer gap")):
        density.upright(gap)
        energy.upright(gap, -0.3, 1.5)
        energy.text(name, gap + 0.002, 1.4)
    density.curve(lambda r: np.exp(-contact_energy(r)), "exp(-U / kT)")
    energy.curve(contact_energy, "k_n δ² / 2")
    for method, colour, mark in (("implicit", BLUE, 7), ("explicit", RED, 5)):
        rows = [(r["distance"], r["density"], r["standard_error"]) for r in table if r["method"] == method]
        density.points(rows, f"{method} steps", colour, mark, 0.4)
        logs = [(r, -math.log(g), error / g) for r, g, error in rows if g > 0]
        energy.points(logs, f"{method} steps", colour, mark, 0.6)
    figure.draw()


def quick_measure(program):
    for run in QUICK_RUNS:
        numbers = numbers_of(run[0], *densities(point_of(program, *run)))
        yield from judged({name: of for name, of in numbers.items() if SHELLS not in name}, 0.25)


main(HERE, TITLE, measure, quick_measure, judge)
