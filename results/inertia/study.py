#!/usr/bin/python3
"""Viscosity against inertia: of the flow without noise, and of the thermal motion.

study.py BIN [FOLDER] [--quick]
"""
import math
import os
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.dirname(HERE))
from campaigns import REFERENCE_SCENE, counts_text, estimate, flags, merged, pair_viscosity, write_table  # noqa: E402
from studies import Statement, data_block, gnuplot, line_through, main, weighted_mean  # noqa: E402

TITLE = "Viscosity and inertia"
VISCOSITY, THERMAL_ENERGY, RATE = 0.1, 0.017, 0.045
FLAT = 0.1  # change that a published curve on logarithmic axes does not show

# Without noise: tau_I / tau_S = rho a^2 rate / eta, by the density alone, so that spheres stay as hard.
FLOW_BOUND = 0.1
STOKES = (0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10)
FLOW = merged(REFERENCE_SCENE, {"particles": {"count": 250}, "volume_fraction": 0.55, "flow": {"shear_rate": RATE}})
# Of the fit of Mari et al. (2014) to viscosities without friction, as Monti et al. (2021) quote it; with the solvent and the stresslet.
MARI = 1.4 * (1 - 0.55 / 0.66) ** -1.6

# With noise: tau_I / tau_B = rho kT / (eta^2 a), by the density too; tau_I / tau_S = Pe / (6 pi) tau_I / tau_B stays below 0.01.
# Pe, seeds, values of tau_I / tau_B, strain and Brownian times of equilibration and window.
THERMAL_BOUND = 0.01
THERMAL_RUNS = (
    (0.1, 32, (0.01, 1.8), {"brownian_times": 5}, {"brownian_times": 30}),
    (0.3, 16, (0.01, 0.1, 0.6), {"brownian_times": 5}, {"brownian_times": 30}),
    (1, 24, (0.001, 0.003, 0.01, 0.03, 0.18), {"brownian_times": 5}, {"brownian_times": 30}),
    (10, 16, (0.001, 0.003, 0.01, 0.018), {"strain": 1}, {"strain": 3}),
)
THERMAL = merged(
    REFERENCE_SCENE, {"particles": {"count": 250}, "volume_fraction": 0.45, "fluid": {"thermal_energy": THERMAL_ENERGY}}
)


def row_of(point, curve, ratio):
    values = [pair_viscosity(r["mean"]) for r in point["realisations"] if r.get("mean")]
    mean, error = estimate(values)
    return {
        "curve": curve,
        "ratio": ratio,
        "seeds": len(values),
        "lost": len(point["realisations"]) - len(values),
        "flags": counts_text(flags(point["realisations"])),
        "viscosity": mean,
        "standard_error": error,
    }


def flow_rows(program, ratios, seeds, patch=None, name="flow", window=6):
    """The equilibration grows with the time in which velocities adapt."""
    settings = [
        {
            "/particles/density": s * VISCOSITY / RATE,
            "/duration": {"equilibration": {"strain": 2 + s}, "production": {"strain": window}},
        }
        for s in ratios
    ]
    return [
        row_of(point, "flow", s)
        for s, point in zip(ratios, program.run(name, merged(FLOW, patch or {}), settings, seeds))
    ]


def thermal_rows(program, number, seeds, ratios, equilibration, production, patch=None, name=None):
    rate = number * THERMAL_ENERGY / (6 * math.pi * VISCOSITY)
    scene = merged(
        merged(THERMAL, {"flow": {"shear_rate": rate}, "duration": None}),
        {"duration": {"equilibration": equilibration, "production": production}},
    )
    settings = [{"/particles/density": r * VISCOSITY**2 / THERMAL_ENERGY} for r in ratios]
    points = program.run(name or f"thermal-{number:g}", merged(scene, patch or {}), settings, seeds)
    return [row_of(point, f"Pe {number:g}", r) for r, point in zip(ratios, points)]


def ratio_of(a, b):
    """Quotient of two rows and its standard error."""
    value = a["viscosity"] / b["viscosity"]
    return value, value * math.hypot(a["standard_error"] / a["viscosity"], b["standard_error"] / b["viscosity"])


def flat_part(rows, bound):
    """Rows up to the bound, and their weighted mean as a row."""
    below = [r for r in rows if r["ratio"] <= bound * (1 + 1e-9)]
    mean, error = weighted_mean([r["viscosity"] for r in below], [r["standard_error"] for r in below])
    return below, {"viscosity": mean, "standard_error": error}


def furthest(rows):
    """Of rows that should be equal: the one furthest from the weighted mean of the others, its ratio to it less 1, and the error."""
    found = []
    for row in rows:
        others = [r for r in rows if r is not row]
        mean, error = weighted_mean([r["viscosity"] for r in others], [r["standard_error"] for r in others])
        value, error = ratio_of(row, {"viscosity": mean, "standard_error": error})
        found.append((row, value - 1, error))
    return max(found, key=lambda f: abs(f[1]))


def change(rows):
    """Of ln eta_r over the range of rows, by the line through it against ln ratio; and its error."""
    _, slope, error = line_through(
        [math.log(r["ratio"]) for r in rows],
        [math.log(r["viscosity"]) for r in rows],
        [r["standard_error"] / r["viscosity"] for r in rows],
    )
    span = math.log(rows[-1]["ratio"] / rows[0]["ratio"])
    return slope * span, error * span


def leaves(rows, flat):
    """log10 of the ratio where the viscosity first is off its flat value by FLAT, between two rows in the logarithm; and its error."""
    off = [ratio_of(r, flat) for r in rows]
    for k in range(1, len(rows)):
        (before, before_error), (after, after_error) = ((abs(math.log(v)), e / v) for v, e in (off[k - 1], off[k]))
        level = math.log(1 + FLAT)
        if before < level <= after:
            place = (level - before) / (after - before)
            step = math.log10(rows[k]["ratio"] / rows[k - 1]["ratio"])
            return math.log10(rows[k - 1]["ratio"]) + place * step, step * math.hypot(
                (1 - place) * before_error, place * after_error
            ) / (after - before)
    return math.nan, math.nan


def flow_statements(rows):
    below, flat = flat_part(rows, FLOW_BOUND)
    degrees = rows[0]["seeds"] - 1
    row, value, error = furthest(below)
    yield Statement(
        f"φ = 0.55, no noise: η_r over that of the others, less 1, where it differs most of all τ_I/τ_S ≤ 0.1 (at {row['ratio']:g})",
        "L4.6a",
        value,
        error,
        -FLAT,
        FLAT,
        degrees,
    )
    value, error = change(below)
    yield Statement(
        "change of ln η_r from τ_I/τ_S = 0.005 to 0.1, by a line", "L4.6a", value, error, -FLAT, FLAT, degrees
    )
    value, error = ratio_of(rows[-1], flat)
    yield Statement(
        f"τ_I/τ_S = {rows[-1]['ratio']:g}: η_r over its flat value, less 1, without its sign",
        "L4.6a",
        abs(value - 1),
        error,
        FLAT,
        degrees=degrees,
    )
    value, error = leaves(rows, flat)
    yield Statement(
        f"log10 of τ_I/τ_S where η_r is 10 % off its flat value ({10**value:.2g})",
        "L4.6a",
        value,
        error,
        math.log10(FLOW_BOUND),
        degrees=degrees,
    )


def thermal_statements(curves):
    for number, rows in curves.items():
        below, flat = flat_part(rows, THERMAL_BOUND)
        degrees = rows[0]["seeds"] - 1
        if len(below) > 1:
            row, value, error = furthest(below)
            yield Statement(
                f"φ = 0.45, Pe = {number:g}: the same where it differs most of all τ_I/τ_B ≤ 0.01 (at {row['ratio']:g})",
                "L4.6b",
                value,
                error,
                -FLAT,
                FLAT,
                degrees,
            )
            value, error = change(below)
            yield Statement(
                f"Pe = {number:g}: change of ln η_r from τ_I/τ_B = {below[0]['ratio']:g} to 0.01, by a line",
                "L4.6b",
                value,
                error,
                -FLAT,
                FLAT,
                degrees,
            )
    # The curve leaves its flat part somewhere: with the largest values there are.
    for number in sorted(curves)[:2]:
        rows = curves[number]
        value, error = ratio_of(rows[-1], flat_part(rows, THERMAL_BOUND)[1])
        yield Statement(
            f"Pe = {number:g}, τ_I/τ_B = {rows[-1]['ratio']:g}: η_r over its flat value, less 1, without its sign",
            "L4.6b",
            abs(value - 1),
            error,
            FLAT,
            degrees=rows[0]["seeds"] - 1,
            essential=False,
        )


def comparison(text, implicit, explicit, what="implicit steps over that by explicit ones"):
    value, error = ratio_of(implicit, explicit)
    return Statement(f"{text}: η_r by {what}", "method", value, error, 1 - FLAT, 1 + FLAT, explicit["seeds"] - 1)


def measure(program):
    flow = flow_rows(program, STOKES, 24)
    curves = {run[0]: thermal_rows(program, *run) for run in THERMAL_RUNS}
    # Where inertia is least, steps that are small beside the automatic one; explicit ones take too long there.
    fine = thermal_rows(
        program,
        *THERMAL_RUNS[-1][:2],
        (0.001,),
        *THERMAL_RUNS[-1][3:],
        {"integrator": {"timestep": 0.0011}},
        "thermal-fine",
    )
    explicit = {"integrator": {"method": "explicit"}}
    flow_explicit = flow_rows(program, (0.1, 10), 12, explicit, "flow-explicit")
    thermal_explicit = thermal_rows(
        program, 1, 8, (0.18,), {"brownian_times": 5}, {"brownian_times": 20}, explicit, "thermal-explicit"
    )
    table = [
        {"method": method, **row}
        for method, rows in (
            ("implicit", [*flow, *(r for rows in curves.values() for r in rows)]),
            ("implicit, a quarter of the step", fine),
            ("explicit", [*flow_explicit, *thermal_explicit]),
        )
        for row in rows
    ]
    write_table(
        os.path.join(HERE, "table.csv"),
        ["method", "curve", "ratio", "seeds", "lost", "flags", "viscosity", "standard_error"],
        table,
        5,
    )
    draw(flow, flow_explicit, curves, thermal_explicit)

    def at(rows, ratio):
        return next(r for r in rows if r["ratio"] == ratio)

    return [
        *flow_statements(flow),
        *thermal_statements(curves),
        *(comparison(f"τ_I/τ_S = {row['ratio']:g}", at(flow, row["ratio"]), row) for row in flow_explicit),
        comparison("Pe = 1, τ_I/τ_B = 0.18", at(curves[1], 0.18), thermal_explicit[0]),
        comparison(
            "Pe = 10, τ_I/τ_B = 0.001",
            at(curves[10], 0.001),
            fine[0],
            "the automatic step over that by a quarter of it",
        ),
    ]


def draw(flow, flow_explicit, curves, thermal_explicit):
    def block(name, rows):
        return data_block(name, [(r["ratio"], r["viscosity"], 2 * r["standard_error"]) for r in rows])

    colours = ("#8040a0", "#2060b0", "#308030", "#d08020")
    lines = [
        "set terminal pngcairo size 1100, 480 font 'Sans,11'",
        f"set output '{os.path.join(HERE, 'chart.png')}'",
        "set multiplot layout 1, 2",
        "set grid lc rgb '#d8d8d8'; set logscale x; set format x '10^{%L}'; set ylabel 'η_r of the pairs'",
        *block("flow", flow),
        *block("explicit", flow_explicit),
        *block("thermal_explicit", thermal_explicit),
    ]
    for k, rows in enumerate(curves.values()):
        lines += block(f"t{k}", rows)
    flat = flat_part(flow, FLOW_BOUND)[1]["viscosity"]
    lines += [
        "set xlabel 'τ_I / τ_S'; set key top left; set title 'φ = 0.55, no noise'; set logscale y; set yrange [15:100]; set ytics (15, 20, 30, 50, 70, 100); set xrange [0.003:20]",
        "set arrow 1 from 0.1, 15 to 0.1, 100 nohead dt 3; set label 1 'published: flat' at 0.09, 17 right",
        f"plot {flat:.6g} lc rgb 'black' dt 2 title 'mean up to 0.1', $flow using 1:2:3 with yerrorbars pt 7 lc rgb '#2060b0' title 'implicit steps', "
        "$explicit using 1:2:3 with yerrorbars pt 4 ps 1.6 lc rgb '#c03028' title 'explicit steps'",
        "unset logscale y; set ytics autofreq; set xlabel 'τ_I / τ_B'; set title 'φ = 0.45'; set yrange [0:7]; set xrange [0.0005:4]",
        "set arrow 1 from 0.01, 0 to 0.01, 7 nohead dt 3; set label 1 'published: flat' at 0.009, 0.4 right",
        "plot "
        + ", ".join(
            f"$t{k} using 1:2:3 with yerrorlines pt 7 lc rgb '{colour}' title 'Pe = {number:g}'"
            for k, (number, colour) in enumerate(zip(curves, colours))
        )
        + ", $thermal_explicit using 1:2:3 with yerrorbars pt 4 ps 1.6 lc rgb '#c03028' title 'Pe = 1, explicit steps'",
    ]
    gnuplot(lines)


def quick_measure(program):
    seeds, small = 8, {"particles": {"count": 100}}
    slow, flat, fast = flow_rows(program, (0.005, 0.1, 5), seeds, small, window=3)
    thermal = thermal_rows(program, 1, seeds, (0.001, 0.01), {"brownian_times": 3}, {"brownian_times": 10}, small)
    absolute = flat["viscosity"] + 1 + 2.5 * 0.55
    return [
        Statement("η_r at τ_I/τ_S = 0.1 over that at 0.005", "L4.6a", *ratio_of(flat, slow), 0.7, 1.4, seeds - 1),
        Statement("η_r at τ_I/τ_S = 5 over that at 0.1", "L4.6a", *ratio_of(fast, flat), 1 + FLAT, degrees=seeds - 1),
        Statement(
            "η_r with solvent and stresslet over Mari's fit",
            "M table 1",
            absolute / MARI,
            flat["standard_error"] / MARI,
            0.7,
            1.3,
            seeds - 1,
        ),
        Statement(
            "Pe = 1: η_r at τ_I/τ_B = 0.01 over that at 0.001",
            "L4.6b",
            *ratio_of(thermal[1], thermal[0]),
            0.5,
            2,
            seeds - 1,
        ),
        Statement(
            "Pe = 1: η_r is below that of Pe = 10^4",
            "L4.9a",
            thermal[1]["viscosity"],
            thermal[1]["standard_error"],
            1,
            6.11,
            seeds - 1,
        ),
    ]


main(HERE, TITLE, measure, quick_measure)
