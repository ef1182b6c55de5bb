#!/usr/bin/python3
"""Flow curves with friction and with a repulsion whose strength is a multiple of kT.

study.py BIN [FOLDER] [--quick]
"""
import math
import os
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.dirname(HERE))
from campaigns import (
    TABLE_SCENE,
    columns_of,
    log_minimum,
    merged,
    number,
    propagated,
    quotient,
    viscosity_row,
    write_table,
)  # noqa: E402
from studies import Statement, data_block, gnuplot, main  # noqa: E402

TITLE = "Friction and repulsion in flow curves"
PECLET = (10, 100, 1e3, 1e4, 1e5, 1e6)
SLOW = 1  # the Peclet number at which friction should not matter; for A = 0 alone, with more seeds
FRICTIONS, STRENGTHS = (0, 0.1, 0.5, 1), (0, 1, 100, 1000)
# Curves: volume fraction, friction, repulsion over kT.
CURVES = [
    *((0.5, m, 0) for m in FRICTIONS),
    *((0.5, m, a) for m in (0.5, 1) for a in STRENGTHS[1:]),
    *((f, 0.5, a) for f in (0.45, 0.53) for a in (0, 100, 1000)),
]
SCENE = merged(
    TABLE_SCENE,
    {
        "contact": {"friction": 0},
        "repulsion": {"form": "exponential", "strength": 0},
        "duration": {
            "equilibration": {"strain": 2, "brownian_times": 25},
            "production": {"strain": 4, "brownian_times": 30},
        },
    },
)
SEEDS, SLOW_SEEDS = 5, 8
RATE, THERMAL_ENERGY, VISCOSITY, LENGTH = (
    0.009,
    0.017,
    0.1,
    0.02,
)  # largest rate and kT, eta, and kappa of two unit spheres


def thermal_energy(peclet):
    """That of a scene with `peclet` and the limits of the table."""
    return min(THERMAL_ENERGY, 6 * math.pi * VISCOSITY * RATE / peclet)


def measured(program, name, cases, seeds, patch=None):
    """Rows of (volume fraction, friction, strength, Peclet number)."""
    settings = [
        {"/volume_fraction": f, "/contact/friction": m, "/repulsion/strength": a * thermal_energy(p), "/peclet": p}
        for f, m, a, p in cases
    ]
    rows = []
    for (fraction, friction, strength, peclet), point in zip(
        cases, program.run(name, merged(SCENE, patch or {}), settings, seeds)
    ):
        row = {
            "fraction": fraction,
            "friction": friction,
            "strength": strength,
            "peclet": peclet,
            **viscosity_row(point),
        }
        row["stress"] = row["pairs"] * peclet / (6 * math.pi)  # sigma a^3 / kT
        row["stress_over_repulsion"] = (
            row["stress"] * LENGTH / strength if strength else math.nan
        )  # sigma a^2 kappa / A
        rows.append(row)
    return rows


def curve_of(rows, fraction, friction, strength):
    return sorted(
        (r for r in rows if (r["fraction"], r["friction"], r["strength"]) == (fraction, friction, strength)),
        key=lambda r: r["peclet"],
    )


def crossing(abscissae, values, share):
    """log10 of where a curve has risen by this share of ln(last / lowest) above its lowest point, by straight lines between its points."""
    logs = [math.log(max(v, 1e-9)) for v in values]
    lowest = min(range(len(logs)), key=lambda k: logs[k])
    level = logs[lowest] + share * (logs[-1] - logs[lowest])
    x = [math.log10(max(a, 1e-9)) for a in abscissae]
    for k in range(lowest, len(logs) - 1):
        if logs[k] <= level < logs[k + 1]:
            return x[k] + (level - logs[k]) / (logs[k + 1] - logs[k]) * (x[k + 1] - x[k])
    return x[-1]


def thickening(curve):
    """log10 Pe of the middle of the thickening, and its width in decades from a tenth to nine tenths, with standard errors."""
    numbers, x = [number(r, "pairs") for r in curve], [r["peclet"] for r in curve]
    return (
        propagated(numbers, lambda v: crossing(x, v, 0.5)),
        propagated(numbers, lambda v: crossing(x, v, 0.9) - crossing(x, v, 0.1)),
    )


def extent(curve):
    """Decades of Pe from the minimum to 95 % of the thickening, with its standard error."""
    x = [r["peclet"] for r in curve]
    return propagated([number(r, "pairs") for r in curve], lambda v: crossing(x, v, 0.95) - log_minimum(x, v))


def middle_stress(curve, scale):
    """log10 of the stress in the middle of the thickening, in units of A / (a^2 kappa) or, with `scale` 1, of kT / a^3."""
    factors = [r["peclet"] / (6 * math.pi) * scale for r in curve]
    return propagated(
        [number(r, "pairs") for r in curve], lambda v: crossing([a * f for a, f in zip(v, factors)], v, 0.5)
    )


def less(a, b):
    return a[0] - b[0], math.hypot(a[1], b[1])


def statements_of(rows):
    degrees = min(r["seeds"] for r in rows) - 1
    smooth = {r["peclet"]: r for r in curve_of(rows, 0.5, 0, 0)}
    for friction in FRICTIONS[1:]:
        rough = {r["peclet"]: r for r in curve_of(rows, 0.5, friction, 0)}
        name = f"φ = 0.5, A = 0: η_r of pairs with μ = {friction} over that without"
        yield Statement(
            f"{name}, Pe = 1",
            "L4.9b",
            *quotient(number(rough[SLOW], "pairs"), number(smooth[SLOW], "pairs")),
            0.9,
            1.1,
            rough[SLOW]["seeds"] - 1,
        )
        yield Statement(
            f"{name}, Pe = 10⁴",
            "L4.9b",
            *quotient(number(rough[1e4], "pairs"), number(smooth[1e4], "pairs")),
            low=1,
            degrees=degrees,
        )
    for a, b in zip(FRICTIONS[1:], FRICTIONS[2:]):
        yield Statement(
            f"φ = 0.5, A = 0, Pe = 10⁶: η_r of pairs with μ = {b} over that with {a}",
            "L4.9b",
            *quotient(number(curve_of(rows, 0.5, b, 0)[-1], "pairs"), number(curve_of(rows, 0.5, a, 0)[-1], "pairs")),
            low=1,
            degrees=degrees,
        )
    for fraction, friction, source in (
        (0.5, 0.5, "L4.9b"),
        (0.5, 1, "L4.9d"),
        (0.45, 0.5, "L4.9c"),
        (0.53, 0.5, "L4.9c"),
    ):
        name = f"φ = {fraction:g}, μ = {friction}"
        middle, width = thickening(curve_of(rows, fraction, friction, 0))
        if fraction == 0.5:
            yield Statement(
                f"{name}, A = 0: decades of Pe from a tenth to nine tenths of the thickening (published: 4 to 5 in all)",
                source,
                *width,
                3,
                5,
                degrees,
                essential=False,
            )
            yield Statement(
                f"{name}, A = 0: decades of Pe from the minimum to 95 % of the thickening (published: 4 to 5)",
                source,
                *extent(curve_of(rows, fraction, friction, 0)),
                3.5,
                5.5,
                degrees,
                essential=False,
            )
        for strength in (100, 1000):
            shifted, narrowed = thickening(curve_of(rows, fraction, friction, strength))
            yield Statement(
                f"{name}: width with A = {strength} kT less that with A = 0, decades of Pe",
                source,
                *less(narrowed, width),
                high=0,
                degrees=degrees,
            )
            yield Statement(
                f"{name}: middle of the thickening with A = {strength} kT less that with A = 0, decades of Pe",
                source,
                *less(shifted, middle),
                low=0,
                degrees=degrees,
            )
    for friction in (0.5, 1):
        a, b = (middle_stress(curve_of(rows, 0.5, friction, strength), LENGTH / strength) for strength in (100, 1000))
        yield Statement(
            f"φ = 0.5, μ = {friction}: log10 of σ a² κ / A in the middle of the thickening, A = 1000 kT less 100 kT (0: the repulsion alone sets the stress)",
            "not published",
            *less(b, a),
            -0.3,
            0.3,
            degrees,
            essential=False,
        )


def measure(program):
    rows = measured(program, "friction-repulsion", [(*c, p) for c in CURVES for p in PECLET], SEEDS)
    rows += measured(program, "slow", [(0.5, m, 0, SLOW) for m in FRICTIONS], SLOW_SEEDS)
    fast = {
        "limits": {"shear_rate": 0.045},
        "duration": {"equilibration": {"strain": 1}, "production": {"strain": 2}},
        "contact": {"friction": 0.5},
        "repulsion": {"strength": 1000 * thermal_energy(1e4) * 5},
    }
    methods = {m: measured_method(program, m, fast) for m in ("implicit", "explicit")}
    table = [{"method": "implicit", **r} for r in rows] + [
        {"method": f"{m} at rate 0.045", **r} for m, r in methods.items()
    ]
    write_table(
        os.path.join(HERE, "table.csv"),
        [
            "method",
            "fraction",
            "friction",
            "strength",
            "peclet",
            "seeds",
            "lost",
            "transient",
            *columns_of("viscosity", "pairs", "lubrication", "contact", "repulsion"),
            "stress",
            "stress_over_repulsion",
        ],
        table,
        4,
    )
    draw(rows)
    return [
        *statements_of(rows),
        Statement(
            "φ = 0.5, μ = 0.5, A = 1000 kT, Pe = 10⁴: η_r with implicit steps over that with explicit ones",
            "method",
            *quotient(number(methods["implicit"], "viscosity"), number(methods["explicit"], "viscosity")),
            0.9,
            1.1,
            methods["explicit"]["seeds"] - 1,
        ),
    ]


def measured_method(program, method, patch):
    """At five times the rate, where explicit steps cost a fifth; kT follows it."""
    (point,) = program.run(
        method, merged(SCENE, merged(patch, {"integrator": {"method": method}})), [{"/peclet": 1e4}], 6
    )
    return {"fraction": 0.5, "friction": 0.5, "strength": 1000, "peclet": 1e4, **viscosity_row(point)}


def draw(rows):
    lines = [
        "set terminal pngcairo size 1200, 900 font 'Sans,11'",
        f"set output '{os.path.join(HERE, 'chart.png')}'",
        "set multiplot layout 2, 2",
        "set grid lc rgb '#d8d8d8'; set logscale xy; set format x '10^{%L}'; set key top left; set ylabel 'η_r of pairs'",
    ]
    colours, blocks = ("#2060b0", "#308030", "#d08020", "#c03028"), 0

    def panel(curves, x_axis, label, limits):
        nonlocal blocks, lines
        parts = []
        for (fraction, friction, strength), title, colour, mark in curves:
            rows_of_curve = curve_of(rows, fraction, friction, strength)
            lines += data_block(f"b{blocks}", [(r[x_axis], *number(r, "pairs")) for r in rows_of_curve])
            parts.append(f"$b{blocks} using 1:2:3 with yerrorlines pt {mark} ps 0.8 lc rgb '{colour}' title '{title}'")
            blocks += 1
        lines += [f"set xlabel '{label}'; {limits}", "plot " + ", ".join(parts)]

    pe = "set xrange [0.5:2e6]; set yrange [2:300]"
    panel([((0.5, m, 0), f"φ = 0.5, A = 0, μ = {m}", c, 7) for m, c in zip(FRICTIONS, colours)], "peclet", "Pe", pe)
    panel(
        [((0.5, 0.5, a), f"φ = 0.5, μ = 0.5, A = {a} k_BT", c, 7) for a, c in zip(STRENGTHS, colours)],
        "peclet",
        "Pe",
        pe,
    )
    panel(
        [
            ((f, 0.5, a), f"φ = {f:g}, μ = 0.5, A = {a} k_BT", c, m)
            for f, m in ((0.45, 6), (0.5, 7), (0.53, 5))
            for a, c in ((0, colours[0]), (1000, colours[3]))
        ],
        "peclet",
        "Pe",
        "set xrange [0.5:2e6]; set yrange [1:2000]",
    )
    panel(
        [((0.5, 1, a), f"φ = 0.5, μ = 1, A = {a} k_BT", c, 7) for a, c in zip(STRENGTHS, colours)],
        "stress",
        "σ a³ / k_BT (pairs)",
        "set xrange [0.1:1e7]; set yrange [2:300]",
    )
    gnuplot(lines)


def quick_measure(program):
    cases = [(0.5, 0, 0, 1e4), (0.5, 1, 0, 1e4), (0.5, 1, 1000, 1e4), (0.5, 0, 0, 1), (0.5, 1, 0, 1)]
    rows = measured(
        program,
        "quick",
        cases,
        8,
        {
            "particles": {"count": 100},
            "duration": {
                "equilibration": {"strain": 1, "brownian_times": 5},
                "production": {"strain": 3, "brownian_times": 10},
            },
        },
    )
    smooth, rough, repelled, smooth_slow, rough_slow = (number(r, "pairs") for r in rows)
    return [
        Statement(
            "φ = 0.5, Pe = 10⁴: η_r of pairs with μ = 1 over that without", "L4.9b", *quotient(rough, smooth), 2, 12, 7
        ),
        Statement(
            "φ = 0.5, Pe = 10⁴, μ = 1: η_r of pairs with A = 1000 kT over that with A = 0",
            "L4.9b",
            *quotient(repelled, rough),
            0.05,
            0.8,
            7,
        ),
        Statement(
            "φ = 0.5, Pe = 1: η_r of pairs with μ = 1 over that without",
            "L4.9b",
            *quotient(rough_slow, smooth_slow),
            0.5,
            1.6,
            7,
        ),
    ]


main(HERE, TITLE, measure, quick_measure)
