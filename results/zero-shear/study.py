#!/usr/bin/python3
"""Brownian viscosity of suspensions at rest, from the correlation of the structural Brownian stress.

study.py BIN [FOLDER] [--quick]
"""
import math
import os
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.dirname(HERE))
from campaigns import REFERENCE_SCENE, estimate, merged, number, quotient, write_table  # noqa: E402
from green_kubo import curve, fit_with_errors  # noqa: E402
from studies import Statement, data_block, gnuplot, main  # noqa: E402

TITLE = "Zero-shear viscosity by Green and Kubo"
FRACTIONS = (0.30, 0.40, 0.45, 0.48, 0.50, 0.52, 0.54, 0.56)
VISCOSITY, THERMAL_ENERGY = 0.1, 0.017
BROWNIAN_TIME = VISCOSITY / THERMAL_ENERGY
# The longest lag is between an eighth and a quarter of the window: 15 samples times a power of two.
SCENE = merged(
    REFERENCE_SCENE,
    {
        "particles": {"count": 250},
        "flow": {"shear_rate": 0},
        "fluid": {"thermal_energy": THERMAL_ENERGY},
        "observables": ["stress", "stress_correlation"],
        "duration": {"equilibration": {"brownian_times": 20}, "production": {"brownian_times": 200}},
    },
)


def measured(program, fractions, seeds, patch=None, name="zero-shear"):
    settings = [{"/volume_fraction": f} for f in fractions]
    points = program.run(name, merged(SCENE, patch or {}), settings, seeds, "green_kubo_viscosity")
    table, curves = [], {}
    for fraction, point in zip(fractions, points):
        times, values = curve(point, BROWNIAN_TIME)
        (viscosity, tau), (viscosity_error, tau_error) = fit_with_errors(times, values)
        table.append(
            {
                "fraction": fraction,
                "seeds": len(values),
                "viscosity": viscosity,
                "viscosity_error": viscosity_error,
                "time": tau,
                "time_error": tau_error,
            }
        )
        curves[fraction] = [(t, *estimate([v[k] for v in values])) for k, t in enumerate(times) if t > 0]
    return table, curves


def statements_of(table, curves, seeds):
    rows = {row["fraction"]: row for row in table}

    for fraction, row in rows.items():
        if fraction < 0.5:
            # The thesis says "short"; the number is a reading.
            yield Statement(
                f"φ = {fraction:g}: τ_φ in Brownian times is short below 0.5",
                "L4.3b",
                row["time"],
                row["time_error"],
                high=1,
                degrees=seeds - 1,
                essential=False,
            )
    lowest, dense, densest = min(rows), max(f for f in rows if f <= 0.5), max(rows)
    # Per unit of volume fraction, so that both sides of 0.5 can be compared; the time at 0.5 is in both rates.
    below, above = 1 / (dense - lowest), 1 / (densest - dense)
    logs = {f: math.log(rows[f]["time"]) for f in (lowest, dense, densest)}
    errors = {f: rows[f]["time_error"] / rows[f]["time"] for f in logs}
    yield Statement(
        "growth rate d ln τ_φ / dφ above φ = 0.5 less that below",
        "L4.3b",
        (logs[densest] - logs[dense]) * above - (logs[dense] - logs[lowest]) * below,
        math.hypot(errors[densest] * above, errors[dense] * (above + below), errors[lowest] * below),
        low=0,
        degrees=seeds - 1,
    )
    rise, rise_error = quotient(number(rows[densest], "viscosity"), number(rows[lowest], "viscosity"))
    yield Statement(
        f"η_φ at φ = {densest:g} over that at {lowest:g}", "L4.3b", rise, rise_error, low=1, degrees=seeds - 1
    )
    for fraction in rows:
        row = rows[fraction]
        if fraction > 0.5:
            continue
        distances = [abs(v - row["viscosity"] * (1 - math.exp(-t / row["time"]))) for t, v, _ in curves[fraction]]
        worst = max(range(len(distances)), key=lambda k: distances[k])
        yield Statement(
            f"φ = {fraction:g}: largest distance of η_B(t) from η_φ (1 - exp(-t/τ)), over η_φ",
            "L4.3b",
            distances[worst] / row["viscosity"],
            curves[fraction][worst][2] / row["viscosity"],
            high=0.1,
            degrees=seeds - 1,
            essential=False,
        )


def draw(table, curves):
    lines = [
        "set terminal pngcairo size 1100, 480 font 'Sans,11'",
        f"set output '{os.path.join(HERE, 'chart.png')}'",
        "set multiplot layout 1, 2",
        "set grid lc rgb '#d8d8d8'",
        "set palette defined (0.3 '#2060b0', 0.45 '#308030', 0.56 '#c03028'); set cbrange [0.3:0.56]; unset colorbox",
    ]
    for k, rows in enumerate(curves.values()):
        lines += data_block(f"c{k}", rows)
    lines += [
        "set logscale xy; set xlabel 't / τ_B'; set ylabel 'η_B(t) / η'; set key top left; set format x '10^{%L}'"
    ]
    lines.append(
        "plot "
        + ", ".join(
            f"$c{k} using 1:2:3 with yerrorbars pt 7 ps 0.4 lc palette cb {row['fraction']} title 'φ = {row['fraction']:g}', "
            f"{row['viscosity']:.6g} * (1 - exp(-x / {row['time']:.6g})) with lines lc palette cb {row['fraction']} notitle"
            for k, row in enumerate(table)
        )
    )
    lines += data_block(
        "t", [(r["fraction"], r["viscosity"], 2 * r["viscosity_error"], r["time"], 2 * r["time_error"]) for r in table]
    )
    lines += [
        "unset logscale x; set format '%g'; set logscale y; set xlabel 'φ'; set ylabel 'η_φ / η,   τ_φ / τ_B'; set xrange [0.28:0.58]",
        "plot $t using 1:2:3 with yerrorlines pt 7 lc rgb '#2060b0' title 'η_φ / η', $t using 1:4:5 with yerrorlines pt 5 lc rgb '#c03028' title 'τ_φ / τ_B'",
    ]
    gnuplot(lines)


def measure(program):
    table, curves = measured(program, FRACTIONS, 24)
    write_table(os.path.join(HERE, "table.csv"), list(table[0]), table, 5)
    draw(table, curves)
    explicit, _ = measured(
        program,
        [0.4],
        4,
        {
            "integrator": {"method": "explicit"},
            "duration": {"equilibration": {"brownian_times": 5}, "production": {"brownian_times": 40}},
        },
        "zero-shear-explicit",
    )
    implicit = next(row for row in table if row["fraction"] == 0.4)
    comparison = implicit["viscosity"] / explicit[0]["viscosity"]
    error = comparison * math.hypot(
        implicit["viscosity_error"] / implicit["viscosity"], explicit[0]["viscosity_error"] / explicit[0]["viscosity"]
    )
    return [
        *statements_of(table, curves, min(row["seeds"] for row in table)),
        Statement(
            "φ = 0.4: η_φ by implicit steps over that by explicit ones",
            "method",
            comparison,
            error,
            0.5,
            1.5,
            explicit[0]["seeds"] - 1,
        ),
    ]


def quick_measure(program):
    seeds = 16
    table, _ = measured(
        program,
        (0.3, 0.5),
        seeds,
        {
            "particles": {"count": 100},
            "duration": {"equilibration": {"brownian_times": 3}, "production": {"brownian_times": 20}},
        },
    )
    low, high = table
    rise = high["viscosity"] / low["viscosity"]
    error = rise * math.hypot(low["viscosity_error"] / low["viscosity"], high["viscosity_error"] / high["viscosity"])
    return [
        Statement("η_φ at φ = 0.3", "L4.3b", low["viscosity"], low["viscosity_error"], 0.05, 5, seeds - 1),
        Statement("η_φ at φ = 0.5 over that at 0.3", "L4.3b", rise, error, 1.2, 50, seeds - 1),
    ]


main(HERE, TITLE, measure, quick_measure)
