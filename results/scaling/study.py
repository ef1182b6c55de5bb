#!/usr/bin/python3
"""Time of a run against the number of particles.

study.py BIN [FOLDER] [--quick]
"""
import math
import os
import statistics
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.dirname(HERE))
from campaigns import REFERENCE_SCENE, at_peclet, estimate, merged, write_table  # noqa: E402
from studies import Statement, data_block, gnuplot, line_through, main  # noqa: E402

TITLE = "Time against the number of particles"
SCENE = merged(REFERENCE_SCENE, {**at_peclet(1), "duration": {"equilibration": {"time": 0}}})
PUBLISHED = 10000  # the largest number in print
COUNTS = (10, 30, 100, 300, 1000, 3000, PUBLISHED, 30000, 100000)
ONE_THREAD = ("--workers", "1", "--threads", "1")
SHORT = 36  # steps of the shorter run of a pair; automatic steps are at most a 32nd of the window


def times(program, counts, rounds, particle_steps, method="implicit"):
    """By number of particles: of every round, ns of processor and of wall time for a step of a particle, from what a longer run takes more than a
    shorter one: packing, start and end drop out."""
    scene = merged(SCENE, {"integrator": {"method": method}})
    step = program.derived(merged(scene, {"duration": {"production": {"time": 1}}}))["timestep"]
    settings, more = [], [max(SHORT, round(particle_steps / count)) for count in counts]
    for count, steps in zip(counts, more):
        # Half a step less than whole ones, so that rounding makes none more.
        settings += [
            {"/particles/count": count, "/duration/production/time": (n - 0.5) * step} for n in (SHORT, SHORT + steps)
        ]
    points = program.run(f"scaling-{method}", scene, settings, rounds, "relative_viscosity_pair", ONE_THREAD)
    table = []
    for count, short, longer in zip(counts, points[::2], points[1::2]):
        row = {"particles": count}
        for time, key in (("processor", "cpu_seconds"), ("wall", "wall_seconds")):
            row[time] = []
            for a, b in zip(short["realisations"], longer["realisations"]):
                row["steps"] = b["steps"]["production"] - a["steps"]["production"]
                row[time].append(1e9 * (b["cost"][key] - a["cost"][key]) / (row["steps"] * count))
        table.append(row)
    return table


def exponent(table, largest, time):
    """Of the time of a step against N: least squares in logarithms through the medians of the rounds; the error is that of the mean of the
    exponents of single rounds."""
    rows = [r for r in table if r["particles"] <= largest]

    def slope(values):
        return line_through(
            [math.log(r["particles"]) for r in rows],
            [math.log(v * r["particles"]) for v, r in zip(values, rows)],
            [1.0] * len(rows),
        )[1]

    return (
        slope([statistics.median(r[time]) for r in rows]),
        estimate([slope(values) for values in zip(*(r[time] for r in rows))])[1],
    )


def statement(text, table, largest, width, time="processor", essential=True):
    return Statement(
        f"{text}exponent of {time} time, N = 10 to {largest}",
        "L4.4",
        *exponent(table, largest, time),
        1 - width,
        1 + width,
        len(table[0][time]) - 1,
        essential,
    )


def measure(program):
    implicit = times(program, COUNTS, 5, 1e6)
    # Their steps cost little: more of them, or the difference of two packings is what is measured.
    explicit = times(program, [n for n in COUNTS[::2] if n <= PUBLISHED], 10, 2e7, "explicit")
    rows = [
        {
            "method": method,
            "particles": r["particles"],
            "steps": r["steps"],
            **{
                f"{time}_{name}": of(r[time])
                for time in ("processor", "wall")
                for name, of in (("ns", statistics.median), ("lowest", min), ("highest", max))
            },
        }
        for method, table in (("implicit", implicit), ("explicit", explicit))
        for r in table
    ]
    write_table(os.path.join(HERE, "table.csv"), list(rows[0]), rows, 4)
    draw(implicit, explicit)
    return [
        statement("", implicit, PUBLISHED, 0.1),
        statement("", implicit, COUNTS[-1], 0.1, essential=False),
        statement("", implicit, PUBLISHED, 0.1, "wall", False),
        statement("explicit steps: ", explicit, PUBLISHED, 0.1),
    ]


def draw(implicit, explicit):
    lines = [
        "set terminal pngcairo size 1100, 480 font 'Sans,11'",
        f"set output '{os.path.join(HERE, 'chart.png')}'",
        "set multiplot layout 1, 2",
        "set grid lc rgb '#d8d8d8'",
    ]
    for name, table in (("implicit", implicit), ("explicit", explicit)):
        lines += data_block(
            name,
            [
                (r["particles"], statistics.median(r["processor"]), min(r["processor"]), max(r["processor"]))
                for r in table
            ],
        )
    middle = next(statistics.median(r["processor"]) for r in implicit if r["particles"] == 1000)
    lines += [
        "set logscale xy; set format '10^{%L}'; set xlabel 'N'; set ylabel 'processor time of a step, s'; set key top left; set xrange [5:200000]",
        f"plot {middle * 1e-9:.6g} * x lc rgb 'black' title 'proportional to N', $implicit using 1:($1*$2*1e-9):($1*$3*1e-9):($1*$4*1e-9) with yerrorbars pt 7 lc rgb '#2060b0' title 'implicit steps', "
        "$explicit using 1:($1*$2*1e-9):($1*$3*1e-9):($1*$4*1e-9) with yerrorbars pt 5 lc rgb '#c03028' title 'explicit steps'",
        "set format y '%g'; set ylabel 'processor time of a step of a particle, ns'; set yrange [30:5000]; set key top left",
        "plot $implicit using 1:2:3:4 with yerrorlines pt 7 lc rgb '#2060b0' title 'implicit steps', $explicit using 1:2:3:4 with yerrorlines pt 5 lc rgb '#c03028' title 'explicit steps'",
    ]
    gnuplot(lines)


def quick_measure(program):
    table = times(program, (10, 100, 1000, 4000), 3, 2e5)
    return [statement("", table, 4000, 0.3)]


main(HERE, TITLE, measure, quick_measure)
