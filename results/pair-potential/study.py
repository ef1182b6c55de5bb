#!/usr/bin/python3
"""Two spheres in a cube of edge 4 a: their distances, and the potential of mean force that follows.

study.py BIN [FOLDER] [--quick]
"""
import math
import os
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.dirname(HERE))
from campaigns import estimate, write_table  # noqa: E402
from studies import Statement, data_block, gnuplot, main  # noqa: E402

TITLE = "Potential of mean force of two spheres"
THERMAL_ENERGY, STIFFNESS = 0.017, 170.0  # a thermal overlap sqrt(kT / k_n) of 0.01 a
BIN = 0.005
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
# Method, seeds and Brownian times of each.
RUNS = [("implicit", 64, 4000), ("explicit", 32, 1000)]
QUICK_RUNS = [("implicit", 16, 1200)]


def densities(point):
    """By seed and bin: counts over ideal counts, normalised to 1 between 2.2 and 2.8 a, where there are no forces; and the distances."""
    rows, distance = [], None
    for realisation in point["realisations"]:
        radial = realisation["mean"]["pair_distribution"]["radial"]
        distance = radial["r"]
        far = [k for k, r in enumerate(distance) if 2.2 < r < 2.8]
        level = sum(radial["counts"][k] for k in far) / sum(radial["ideal"][k] for k in far)
        rows.append([c / i / level for c, i in zip(radial["counts"], radial["ideal"])])
    return distance, rows


def mean_density(distance, rows, low, high):
    """Mean over the shells between two distances, with its standard error over seeds."""
    chosen = [k for k, r in enumerate(distance) if low < r < high]
    weight = [distance[k] ** 2 for k in chosen]
    return estimate([sum(w * row[k] for w, k in zip(weight, chosen)) / sum(weight) for row in rows])


def potential(distance, rows, low, high):
    density, error = mean_density(distance, rows, low, high)
    return -math.log(density), error / density


def contact_ratio(distance, rows):
    """Density of overlaps up to two thermal ones over the mean of exp(-U / kT) there, weighted with r^2 as the density is."""
    low, parts, sums = 1.98, 2000, [0.0, 0.0]
    for k in range(parts):
        r = low + (2 - low) * (k + 0.5) / parts
        sums[0] += r * r * math.exp(-STIFFNESS * (2 - r) ** 2 / (2 * THERMAL_ENERGY))
        sums[1] += r * r
    density, error = mean_density(distance, rows, low, 2)
    expected = sums[0] / sums[1]
    return density / expected, error / expected


def statements_of(method, distance, rows, tolerance):
    source, degrees = "L4.1", len(rows) - 1
    inner, inner_error = potential(distance, rows, 2.005, 2.045)
    outer, outer_error = potential(distance, rows, 2.055, 2.155)
    touching, touching_error = potential(distance, rows, 2.0, 2.005)
    ratio, ratio_error = contact_ratio(distance, rows)

    def statement(text, value, error, low, high):
        return Statement(f"{text}, {method} steps", source, value, error, low, high, degrees)

    return [
        statement("U / kT = 0 between contact and the outer gap", inner, inner_error, -tolerance, tolerance),
        statement("U / kT = 0 beyond the outer gap", outer, outer_error, -tolerance, tolerance),
        statement(
            "no step of U / kT at the outer gap",
            inner - outer,
            math.hypot(inner_error, outer_error),
            -tolerance,
            tolerance,
        ),
        statement(
            "no step of U / kT at the inner gap",
            touching - inner,
            math.hypot(touching_error, inner_error),
            -tolerance,
            tolerance,
        ),
        statement(
            "density of overlaps over that of U = k_n delta^2 / 2", ratio, ratio_error, 1 - tolerance, 1 + tolerance
        ),
    ]


def local_step(method, distance, rows):
    """ln of the density in the last shell within the outer gap over that in the first one beyond. Implicit steps have one of their own."""
    inside, inside_error = potential(distance, rows, 2.045, 2.05)
    outside, outside_error = potential(distance, rows, 2.05, 2.055)
    return Statement(
        f"no step of U / kT from the shell within the outer gap to the next one, {method} steps",
        "L4.1",
        outside - inside,
        math.hypot(inside_error, outside_error),
        -0.1,
        0.1,
        len(rows) - 1,
        essential=method != "implicit",
    )


def point_of(program, method, seeds, brownian_times):
    scene = {
        **SCENE,
        "integrator": {"method": method},
        "duration": {"equilibration": {"brownian_times": 20}, "production": {"brownian_times": brownian_times}},
    }
    return program.run(f"pair-potential-{method}", scene, [{"/particles/count": 2}], seeds, "kinetic_temperature")[0]


def measure(program):
    statements, table, curves = [], [], {}
    for run in RUNS:
        method = run[0]
        distance, rows = densities(point_of(program, *run))
        statements += [*statements_of(method, distance, rows, 0.1), local_step(method, distance, rows)]
        curves[method] = []
        for k, r in enumerate(distance):
            density, error = estimate([row[k] for row in rows])
            if r > 1.95:
                table.append({"method": method, "distance": r, "density": density, "standard_error": error})
                curves[method].append((r, density, error))
    write_table(os.path.join(HERE, "table.csv"), ["method", "distance", "density", "standard_error"], table, 5)
    draw(curves)
    return statements


def draw(curves):
    lines = [
        "set terminal pngcairo size 1100, 480 font 'Sans,11'",
        f"set output '{os.path.join(HERE, 'chart.png')}'",
        "set multiplot layout 1, 2",
        "set grid lc rgb '#d8d8d8'; set key bottom right; set xlabel 'r / a'",
    ]
    for method, rows in curves.items():
        lines += data_block(
            method, [(r, g, e, -math.log(g) if g > 0 else math.nan, e / g if g > 0 else math.nan) for r, g, e in rows]
        )
    lines += [
        "set ylabel 'g(r)'; set yrange [0:1.3]; set xrange [1.95:2.8]",
        "set arrow 1 from 2.001, 0 to 2.001, 1.3 nohead dt 3; set arrow 2 from 2.05, 0 to 2.05, 1.3 nohead dt 3",
        f"plot x < 2 ? exp(-{STIFFNESS} * (2 - x)**2 / (2 * {THERMAL_ENERGY})) : 1 lc rgb 'black' title 'exp(-U / kT)', "
        "$implicit using 1:2:3 with yerrorbars pt 7 ps 0.4 lc rgb '#2060b0' title 'implicit steps', "
        "$explicit using 1:2:3 with yerrorbars pt 5 ps 0.4 lc rgb '#c03028' title 'explicit steps'",
        "unset arrow 1; unset arrow 2; set xrange [1.965:2.08]; set yrange [-0.3:4]; set ylabel 'U / kT'; set key top right; set samples 1000",
        "set arrow 1 from 2.001, -0.3 to 2.001, 1.5 nohead dt 3; set arrow 2 from 2.05, -0.3 to 2.05, 1.5 nohead dt 3",
        "set label 1 'inner gap' at 2.003, 1.4; set label 2 'outer gap' at 2.052, 1.4",
        f"plot x < 2 ? {STIFFNESS} * (2 - x)**2 / (2 * {THERMAL_ENERGY}) : 0 lc rgb 'black' title 'k_n δ² / 2', "
        "$implicit using 1:4:5 with yerrorbars pt 7 ps 0.6 lc rgb '#2060b0' title 'implicit steps', "
        "$explicit using 1:4:5 with yerrorbars pt 5 ps 0.6 lc rgb '#c03028' title 'explicit steps'",
    ]
    gnuplot(lines)


def quick_measure(program):
    statements = []
    for run in QUICK_RUNS:
        statements += statements_of(run[0], *densities(point_of(program, *run)), 0.25)
    return statements


main(HERE, TITLE, measure, quick_measure)
