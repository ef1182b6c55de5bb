#!/usr/bin/python3
"""Mean squared displacements of dilute spheres, and self-diffusion from dilute to dense.

study.py BIN [FOLDER] [--quick]
"""
import math
import os
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.dirname(HERE))
from campaigns import REFERENCE_SCENE, estimate, merged, write_table  # noqa: E402
from studies import Statement, data_block, gnuplot, line_through, main, weighted_mean  # noqa: E402

TITLE = "Mean squared displacement and self-diffusion"
AT_REST = merged(REFERENCE_SCENE, {"flow": {"shear_rate": 0}, "observables": ["stress", "mean_squared_displacement"]})

# tau_I = 0.1, tau_C = 1e-3; explicit steps, because inertia is what is looked at.
VISCOSITY, DENSITY, STIFFNESS = 1.0, 0.1, 1e5
RATIOS = (1.7, 0.17, 0.017)  # tau_I / tau_B
DILUTE = merged(
    AT_REST,
    {
        "particles": {"count": 100, "density": DENSITY},
        "volume_fraction": 0.001,
        "fluid": {"viscosity": VISCOSITY},
        "contact": {"normal_stiffness": STIFFNESS},
        "integrator": {"method": "explicit", "timestep": 2e-5},
        "mean_squared_displacement": {"interval": 5e-4},
        "duration": {"equilibration": {"time": 0.5}, "production": {"time": 6}},
    },
)

# The published units, tau_I = 1.
FRACTIONS = (0.001, 0.1, 0.2, 0.3, 0.4, 0.45, 0.5, 0.55)
CROWDED = merged(
    AT_REST,
    {
        "particles": {"count": 250},
        "integrator": {"method": "implicit"},
        "duration": {"equilibration": {"brownian_times": 10}, "production": {"brownian_times": 9}},
    },
)

# Displacements over windows ten times longer, for the limit of long times.
LONG_FRACTIONS = (0.001, 0.1, 0.3, 0.5)
LONG = {"duration": {"production": {"brownian_times": 90}}}


def thermal_energy(ratio, viscosity, density):
    """kT at which tau_I / tau_B = (rho a^2 / eta) (kT / (eta a^3)) has this value, a = 1."""
    return ratio * viscosity**2 / density


def free_displacement(time, energy, radius):
    """<x^2> of a free sphere along one axis: (2 kT m / zeta^2) (zeta t / m - 1 + exp(-zeta t / m)), L4.1."""
    mass, zeta = 4 / 3 * math.pi * DENSITY * radius**3, 6 * math.pi * VISCOSITY * radius
    return 2 * energy * mass / zeta**2 * (zeta * time / mass - 1 + math.exp(-zeta * time / mass))


def dilute_curves(program, ratios, seeds, patch=None):
    """By ratio: rows of time, measured and free displacement of the small spheres, with the standard error, and the same ratio of the two
    for both species, which all of its scatter is taken from."""
    settings = [{"/fluid/thermal_energy": thermal_energy(r, VISCOSITY, DENSITY)} for r in ratios]
    curves = {}
    for ratio, point in zip(
        ratios, program.run("dilute", merged(DILUTE, patch or {}), settings, seeds, "kinetic_temperature")
    ):
        energy = thermal_energy(ratio, VISCOSITY, DENSITY)
        displacements = [r["mean"]["mean_squared_displacement"] for r in point["realisations"]]
        rows = []
        for k, time in enumerate(displacements[0]["time"]):
            ratios_of_seeds, small = [], []
            for d in displacements:
                species = [
                    (s["x"][k] + s["y"][k] + s["z"][k]) / 3 / free_displacement(time, energy, s["radius"])
                    for s in d["species"]
                ]
                ratios_of_seeds.append(sum(species) / len(species))
                small.append(species[0])
            mean, error = estimate(ratios_of_seeds)
            rows.append(
                {
                    "ratio": ratio,
                    "time": time,
                    "displacement": estimate(small)[0] * free_displacement(time, energy, 1.0),
                    "free": free_displacement(time, energy, 1.0),
                    "over_free": mean,
                    "standard_error": error,
                }
            )
        curves[ratio] = rows
    return curves


def worst(rows, low, high):
    """The row between two times that is furthest from the formula, in standard errors."""
    chosen = [r for r in rows if low <= r["time"] <= high]
    return max(chosen, key=lambda r: abs(r["over_free"] - 1) / r["standard_error"])


def dilute_statements(curves, seeds, tolerance):
    inertial_time = DENSITY / VISCOSITY
    for ratio, rows in curves.items():
        for name, low, high in (("before", 0, 0.1), ("around", 0.1, 1), ("beyond", 1, 30)):
            row = worst(rows, low * inertial_time, high * inertial_time)
            yield Statement(
                f"τ_I/τ_B = {ratio}: displacement over L4.1 at its worst {name} τ_I (t = {row['time'] / inertial_time:.3g} τ_I)",
                "L4.2a",
                row["over_free"],
                row["standard_error"],
                1 - tolerance,
                1 + tolerance,
                seeds - 1,
            )


def diffusion(program, ratios, fractions, seeds, patch=None, name="crowded"):
    settings = [
        {"/volume_fraction": f, "/fluid/thermal_energy": thermal_energy(r, 0.1, 0.1)} for r in ratios for f in fractions
    ]
    table = []
    for s, point in zip(settings, program.run(name, merged(CROWDED, patch or {}), settings, seeds, "self_diffusion")):
        values = [r["mean"]["self_diffusion"] for r in point["realisations"] if r.get("mean")]
        mean, error = estimate(values)
        table.append(
            {
                "ratio": s["/fluid/thermal_energy"] * 0.1 / 0.1**2,
                "fraction": s["/volume_fraction"],
                "seeds": len(values),
                "diffusion": mean,
                "standard_error": error,
            }
        )
    return table


def line_of(rows):
    """D(phi) by least squares with the errors: intercept, slope over intercept and its standard error, and what remains of each row."""
    x, y, errors = ([r[name] for r in rows] for name in ("fraction", "diffusion", "standard_error"))
    intercept, slope, slope_error = line_through(x, y, errors)
    mean_x, mean_error = weighted_mean(x, errors)
    ratio = slope / intercept
    # The intercept is the value at the mean of x, whose error is independent, less mean_x times the slope.
    ratio_error = math.hypot(slope_error * (1 + ratio * mean_x), ratio * mean_error) / abs(intercept)
    return intercept, ratio, ratio_error, [b - intercept - slope * a for a, b in zip(x, y)]


def crowded_statements(table, seeds):
    def of(ratio, fraction):
        return next(r for r in table if abs(r["ratio"] - ratio) < 1e-9 and r["fraction"] == fraction)

    cold, warm, hot = RATIOS[2], RATIOS[1], RATIOS[0]
    free = of(cold, FRACTIONS[0])
    # Two sizes: the mean of 1 / a over the number of spheres, 2.744 of the small ones to one large.
    expected = (2.744 + 1 / 1.4) / 3.744
    yield Statement(
        "dilute limit of D / D_0 over the mean of a / a_i",
        "L4.2d",
        free["diffusion"] / expected,
        free["standard_error"] / expected,
        0.95,
        1.05,
        seeds - 1,
    )
    for fraction in FRACTIONS:
        a, b = of(warm, fraction), of(cold, fraction)
        yield Statement(
            f"φ = {fraction:g}: D / D_0 at τ_I/τ_B = 0.17 over that at 0.017",
            "L4.2d",
            a["diffusion"] / b["diffusion"],
            math.hypot(a["standard_error"], b["standard_error"]) / b["diffusion"],
            0.9,
            1.1,
            seeds - 1,
        )
    intercept, slope, slope_error, residuals = line_of([r for r in table if abs(r["ratio"] - cold) < 1e-9])
    largest = max(range(len(FRACTIONS)), key=lambda k: abs(residuals[k]))
    yield Statement(
        f"largest distance of D / D_0 from a line in φ (at φ = {FRACTIONS[largest]:g}) over its dilute value",
        "L4.2d",
        residuals[largest] / intercept,
        of(cold, FRACTIONS[largest])["standard_error"] / intercept,
        -0.05,
        0.05,
        seeds - 1,
        essential=False,
    )
    yield Statement("slope of that line over the dilute value", "L4.2d", slope, slope_error, high=-1, degrees=seeds - 1)
    dense = of(hot, 0.5)["diffusion"] / of(cold, 0.5)["diffusion"]
    error = dense * math.hypot(
        of(hot, 0.5)["standard_error"] / of(hot, 0.5)["diffusion"],
        of(cold, 0.5)["standard_error"] / of(cold, 0.5)["diffusion"],
    )
    yield Statement(
        "φ = 0.5: D / D_0 at τ_I/τ_B = 1.7 over that at 0.017 (L4.2d: it depends on the temperature there)",
        "L4.2d",
        dense,
        error,
        low=1.05,
        degrees=seeds - 1,
        essential=False,
    )


def long_time_statement(table):
    """The middle volume fractions against the straight line through the first and the last."""
    first, *middle, last = table
    slope = (last["diffusion"] - first["diffusion"]) / (last["fraction"] - first["fraction"])
    distances = []
    for row in middle:
        part = (row["fraction"] - first["fraction"]) / (last["fraction"] - first["fraction"])
        errors = row["standard_error"], (1 - part) * first["standard_error"], part * last["standard_error"]
        distances.append(
            (
                row["diffusion"] - first["diffusion"] - slope * (row["fraction"] - first["fraction"]),
                math.hypot(*errors),
                row["fraction"],
            )
        )
    distance, error, fraction = max(distances, key=lambda d: abs(d[0]))
    dilute = first["diffusion"]
    return Statement(
        f"windows of 90 Brownian times: largest distance of D / D_0 from the line through the first and the last φ (at φ = {fraction:g}) over its dilute value",
        "L4.2d",
        distance / dilute,
        error / dilute,
        -0.05,
        0.05,
        table[0]["seeds"] - 1,
        essential=False,
    )


def measure(program):
    seeds = 32
    curves = dilute_curves(program, RATIOS, seeds)
    table = diffusion(program, RATIOS, FRACTIONS, seeds)
    seeds = min(row["seeds"] for row in table)
    explicit = diffusion(program, RATIOS[1:2], [0.3], 8, {"integrator": {"method": "explicit"}}, "crowded-explicit")[0]
    long = diffusion(program, RATIOS[2:], LONG_FRACTIONS, 8, LONG, "crowded-long")
    write_table(
        os.path.join(HERE, "displacement.csv"),
        ["ratio", "time", "displacement", "free", "over_free", "standard_error"],
        [row for rows in curves.values() for row in rows],
        5,
    )
    write_table(
        os.path.join(HERE, "table.csv"),
        ["method", "ratio", "fraction", "seeds", "diffusion", "standard_error"],
        [{"method": "implicit", **row} for row in table]
        + [{"method": "explicit", **explicit}]
        + [{"method": "implicit, windows of 90", **row} for row in long],
        5,
    )
    draw(curves, table, long)
    implicit = next(r for r in table if abs(r["ratio"] - RATIOS[1]) < 1e-9 and r["fraction"] == 0.3)
    return [
        *dilute_statements(curves, seeds, 0.02),
        *crowded_statements(table, seeds),
        long_time_statement(long),
        Statement(
            "φ = 0.3: implicit steps over explicit ones",
            "method",
            implicit["diffusion"] / explicit["diffusion"],
            math.hypot(implicit["standard_error"], explicit["standard_error"]) / explicit["diffusion"],
            0.9,
            1.1,
            explicit["seeds"] - 1,
        ),
    ]


def draw(curves, table, long):
    lines = [
        "set terminal pngcairo size 1100, 480 font 'Sans,11'",
        f"set output '{os.path.join(HERE, 'chart.png')}'",
        "set multiplot layout 1, 2",
        "set grid lc rgb '#d8d8d8'",
    ]
    colours = ("#c03028", "#308030", "#2060b0")
    inertial_time = DENSITY / VISCOSITY
    for k, rows in enumerate(curves.values()):
        lines += data_block(f"m{k}", [(r["time"] / inertial_time, r["displacement"], r["free"]) for r in rows])
    lines += [
        "set logscale xy; set format '10^{%L}'; set xlabel 't / τ_I'; set ylabel '⟨x²⟩ / a², φ = 0.001'; set key bottom right"
    ]
    lines.append(
        "plot "
        + ", ".join(
            f"$m{k} using 1:3 with lines lc rgb 'black' {'title `L4.1`' if k == 0 else 'notitle'}, $m{k} using 1:2 with points pt 7 ps 0.7 lc rgb '{colours[k]}' title 'τ_I/τ_B = {ratio:g}'"
            for k, ratio in enumerate(curves)
        ).replace("`", '"')
    )
    for k, ratio in enumerate(RATIOS):
        lines += data_block(
            f"d{k}",
            [(r["fraction"], r["diffusion"], 2 * r["standard_error"]) for r in table if abs(r["ratio"] - ratio) < 1e-9],
        )
    lines += data_block("long", [(r["fraction"], r["diffusion"], 2 * r["standard_error"]) for r in long])
    lines += [
        "unset logscale; set format '%g'; set xlabel 'φ'; set ylabel 'D / D_0'; set key top right; set xrange [-0.02:0.6]; set yrange [0:1.1]"
    ]
    lines.append(
        "plot "
        + ", ".join(
            f"$d{k} using 1:2:3 with yerrorlines pt 7 ps 0.7 lc rgb '{colours[k]}' title 'τ_I/τ_B = {ratio:g}'"
            for k, ratio in enumerate(RATIOS)
        )
        + ", $long using 1:2:3 with yerrorbars pt 6 ps 1.2 lc rgb 'black' title 'τ_I/τ_B = 0.017, windows of 90 τ_B'"
    )
    gnuplot(lines)


def quick_measure(program):
    seeds = 8
    curves = dilute_curves(
        program, RATIOS[:1], seeds, {"particles": {"count": 50}, "duration": {"production": {"time": 3}}}
    )
    table = diffusion(program, RATIOS[1:2], [0.001, 0.45], seeds, {"particles": {"count": 100}})
    slower = table[1]["diffusion"] / table[0]["diffusion"]
    error = slower * math.hypot(*(r["standard_error"] / r["diffusion"] for r in table))
    return [
        *dilute_statements(curves, seeds, 0.1),
        Statement("D at φ = 0.45 over D at 0.001", "L4.2c", slower, error, 0.05, 0.5, seeds - 1),
    ]


main(HERE, TITLE, measure, quick_measure)
