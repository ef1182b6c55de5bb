#!/usr/bin/python3
"""Two spheres in a cube of edge 4 a: the distribution of their distances, and the potential of mean force."""
import math
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from studies.driver import BLUE, Check, Figure, Finding, GREEN, RED, Statement, difference, estimate, in_brownian_times
from studies.driver import logarithm, main, over, read_numbers, read_rows, write_numbers, write_rows
import numpy as np

TITLE = "Potential of mean force of two spheres"
THERMAL_ENERGY, STIFFNESS = 0.017, 170.0  # thermal overlap sqrt(kT / k_n) = 0.01 a
BIN = 0.005
INNER, OUTER = 2.001, 2.05  # distances at the gaps of lubrication
DENSITY, VISCOSITY = 0.1, 0.1
SCENE = {
    "particles": {"count": 2, "density": DENSITY, "species": [{"radius": 1.0}]},
    "volume_fraction": 2 * 4 / 3 * math.pi / 4**3,
    "fluid": {"viscosity": VISCOSITY, "thermal_energy": THERMAL_ENERGY},
    "flow": {"shear_rate": 0},
    "contact": {"normal_stiffness": STIFFNESS},
    "lubrication": {"form": "kim-karrila", "inner_gap": 1e-3, "outer_gap": 0.05},
    "observables": ["stress", "pair_distribution"],
    "pair_distribution": {"range": 2.825, "bin": BIN, "slab": 0.1, "interval": 0.1},
    "guard": {"largest_overlap": 0.2},
}
# Runs: method, divisor of the automatic step, seeds, Brownian times of each seed.
RUNS = [("implicit", 1, 64, 4000), ("implicit", 16, 24, 4000), ("explicit", 1, 72, 1000)]
QUICK_RUNS = [("implicit", 1, 16, 1200)]


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


def shell(low, high, parts=2000):
    """Returns distances in a shell, whose mean has to be weighted with r^2."""
    return low + (high - low) * (np.arange(parts) + 0.5) / parts


def contact_ratio(distance, rows):
    """Returns the density at overlaps up to two thermal ones over the mean of exp(-U / kT), both weighted with r^2."""
    r = shell(1.98, 2)
    return over(mean_density(distance, rows, 1.98, 2), np.average(np.exp(-contact_energy(r)), weights=r**2))


def verlet_factor(distance, timestep):
    """Returns the density that velocity Verlet makes over the true one: 1 - lambda dt / 2.

    lambda = (2 X_A + zeta) / m is the rate at which the relative velocity along the line of centres decays, with the
    drag zeta = 6 pi eta a and X_A = zeta (1 / 4 xi + 9 / 40 ln 1 / xi) between the gaps.
    """
    gap = np.maximum(distance, INNER) - 2
    squeeze = np.where(distance < OUTER, 1 / (4 * gap) + 9 / 40 * np.log(1 / gap), 0)
    return 1 - 6 * math.pi * VISCOSITY * (2 * squeeze + 1) / (DENSITY * 4 / 3 * math.pi) * timestep / 2


INSIDE, BEYOND = "U / kT = 0 between contact and the outer gap", "U / kT = 0 beyond the outer gap, to 2.155 a"
AT_OUTER = "no step of U / kT at the outer gap, means over 0.04 and 0.1 a"
AT_INNER = "no step of U / kT at the inner gap"
OVERLAPS = "density of overlaps over that of U = k_n δ² / 2"
SHELLS = "no step of U / kT from the shell of 0.005 a within the outer gap to the next one"
AT_INNER_LEFT, OVERLAPS_LEFT = f"{AT_INNER}, but that of 1 − λΔt/2", f"{OVERLAPS} and of 1 − λΔt/2"
# Errors of velocity Verlet, which has the density 1 - lambda dt / 2: findings, and checks of what is left of them.
OF_VERLET = {("explicit", AT_INNER), ("explicit", OVERLAPS)}


def numbers_of(method, distance, rows, timestep):
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
    if method == "explicit":
        contact, near, further = (
            float(np.average(verlet_factor(r, timestep), weights=r**2))
            for r in (shell(1.98, 2), shell(2, 2.005), shell(2.005, 2.045))
        )
        found[AT_INNER_LEFT] = difference(found[AT_INNER], (math.log(further / near), 0))
        found[OVERLAPS_LEFT] = over(found[OVERLAPS], contact)
    return {name: (*of, len(rows) - 1) for name, of in found.items()}


def row_of(name, found, tolerance=0.1):
    """Returns a row. The tolerance, in kT or of a density of 1, is the resolution of the published figures."""
    steps, what = name.split(": ")
    method = steps.split()[0]
    if (method, what) in OF_VERLET:
        return Finding(name, "step", *found)
    middle = 1 if "density" in what else 0
    # Overlaps of the automatic implicit step test the step: steps 16 times finer are judged by what is published.
    of_step = "λ" in what or (steps, what) == (named("implicit", 1), OVERLAPS)
    kind, source = (Check, "step") if of_step else (Statement, "L4.1")
    return kind(name, source, *found[:2], middle - tolerance, middle + tolerance, found[2])


def judge():
    return [row_of(name, found) for name, found in read_numbers(HERE / "numbers.csv").items()]


def named(method, divisor):
    return f"{method} steps" + (f", {divisor} times finer" if divisor > 1 else "")


def run(program, method, divisor, seeds, brownian_times):
    """Returns the point, and its time step."""
    name = f"pair-potential-{method}" + (f"-{divisor}" if divisor > 1 else "")
    scene = {**SCENE, "integrator": {"method": method}, **in_brownian_times(20, brownian_times)}
    timestep = program.derived(scene, "kinetic_temperature")["timestep"] / divisor
    if divisor > 1:
        scene["integrator"]["timestep"] = timestep
    return program.run(name, scene, [{"/particles/count": 2}], seeds, "kinetic_temperature")[0], timestep


def numbers_and_densities(program, method, divisor, *how):
    point, timestep = run(program, method, divisor, *how)
    distance, rows = densities(point)
    numbers = numbers_of(method, distance, rows, timestep)
    return {f"{named(method, divisor)}: {what}": found for what, found in numbers.items()}, distance, rows


def measure(program):
    numbers, table = {}, []
    names = "steps", "distance", "density", "standard_error"
    for method, divisor, *how in RUNS:
        more, distance, rows = numbers_and_densities(program, method, divisor, *how)
        numbers |= more
        shells = ((r, values) for r, values in zip(distance.tolist(), rows.T) if r > 1.95)
        table += [dict(zip(names, (named(method, divisor), r, *estimate(values)))) for r, values in shells]
    write_rows(HERE / "table.csv", table, 5)
    write_numbers(HERE / "numbers.csv", numbers)


def draw():
    table = read_rows(HERE / "table.csv")
    figure = Figure(HERE / "chart.png", columns=2)
    density = figure.panel("r / a", "g(r)", key="bottom right", x_range=(1.95, 2.8), y_range=(0.85, 1.06))
    energy = figure.panel("r / a", "U / kT", x_range=(1.965, 2.08), y_range=(-0.3, 4))
    for gap, name in ((INNER, "inner gap"), (OUTER, "outer gap")):
        density.upright(gap)
        energy.upright(gap, -0.3, 1.5)
        energy.text(name, gap + 0.002, 1.4)
    density.curve(lambda r: np.exp(-contact_energy(r)), "exp(-U / kT)")
    energy.curve(contact_energy, "k_n δ² / 2")
    for (method, divisor, *_), colour, mark in zip(RUNS, (BLUE, GREEN, RED), (7, 6, 5)):
        name = named(method, divisor)
        rows = [(r["distance"], r["density"], r["standard_error"]) for r in table if r["steps"] == name]
        density.points(rows, name, colour, mark, 0.4)
        logs = [(r, -math.log(g), error / g) for r, g, error in rows if g > 0]
        energy.points(logs, name, colour, mark, 0.6)
    figure.draw()


def quick_measure(program):
    for run_of in QUICK_RUNS:
        for name, found in numbers_and_densities(program, *run_of)[0].items():
            yield row_of(name, found, 0.25)


main(HERE, TITLE, measure, quick_measure, judge, draw)
