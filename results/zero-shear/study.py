#!/usr/bin/python3
"""Brownian viscosity of suspensions at rest, from the correlation of the structural Brownian stress.

study.py BIN [FOLDER] [--quick]
"""
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from studies.command_line import main
from studies.estimates import estimate, logarithm, over, quotient
from studies.figure import BLUE, GREEN, RED, Figure, shade
from studies.green_kubo import curve, fit_with_errors
from studies.scenes import REFERENCE_SCENE, during, merged
from studies.tables import entries, number, write_table
from studies.verdicts import Statement

import numpy as np

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
        **during({"brownian_times": 20}, {"brownian_times": 200}),
    },
)
EXPLICIT = {"integrator": {"method": "explicit"}, **during({"brownian_times": 5}, {"brownian_times": 40})}


def measured(program, fractions, seeds, patch=None, name="zero-shear"):
    settings = [{"/volume_fraction": f} for f in fractions]
    points = program.run(name, merged(SCENE, patch or {}), settings, seeds, "green_kubo_viscosity")
    table, curves = [], {}
    for fraction, point in zip(fractions, points):
        times, values = curve(point, BROWNIAN_TIME)
        (viscosity, tau), (viscosity_error, tau_error) = fit_with_errors(times, values)
        found = {**entries("viscosity", (viscosity, viscosity_error)), **entries("time", (tau, tau_error))}
        table.append({"fraction": fraction, "seeds": len(values), **found})
        curves[fraction] = [(t, *estimate(values[:, k])) for k, t in enumerate(times) if t > 0]
    return table, curves


def growth(low, high):
    """ln of the time in one row over that in another, for each unit of volume fraction; with the errors of both."""
    width = high["fraction"] - low["fraction"]
    (a, da), (b, db) = (over(logarithm(number(row, "time")), width) for row in (low, high))
    return b - a, da, db


def growth_statement(lowest, dense, densest, degrees):
    below, low_error, before_error = growth(lowest, dense)
    above, after_error, high_error = growth(dense, densest)
    # The time at 0.5 is in both rates.
    error = np.hypot(np.hypot(low_error, high_error), before_error + after_error)
    text = "growth rate d ln τ_φ / dφ above φ = 0.5 less that below"
    return Statement(text, "L4.3b", above - below, error, low=0, degrees=degrees)


def statements_of(table, curves, seeds):
    rows, degrees = {row["fraction"]: row for row in table}, seeds - 1
    for fraction, row in rows.items():
        if fraction < 0.5:
            # The thesis says "short"; the number is a reading.
            text = f"φ = {fraction:g}: τ_φ in Brownian times is short below 0.5"
            yield Statement(text, "L4.3b", *number(row, "time"), high=1, degrees=degrees, essential=False)
    lowest, dense, densest = rows[min(rows)], rows[max(f for f in rows if f <= 0.5)], rows[max(rows)]
    yield growth_statement(lowest, dense, densest, degrees)
    text = f"η_φ at φ = {densest['fraction']:g} over that at {lowest['fraction']:g}"
    rise = quotient(number(densest, "viscosity"), number(lowest, "viscosity"))
    yield Statement(text, "L4.3b", *rise, low=1, degrees=degrees)
    for fraction, row in rows.items():
        if fraction <= 0.5:
            t, values, errors = np.array(curves[fraction]).T
            distances = abs(values - row["viscosity"] * (1 - np.exp(-t / row["time"])))
            worst = np.argmax(distances)
            share = over((distances[worst], errors[worst]), row["viscosity"])
            text = f"φ = {fraction:g}: largest distance of η_B(t) from η_φ (1 - exp(-t/τ)), over η_φ"
            yield Statement(text, "L4.3b", *share, high=0.1, degrees=degrees, essential=False)


def draw(table, curves):
    figure = Figure(HERE / "chart.png", columns=2)
    panel = figure.panel("t / τ_B", "η_B(t) / η", log="xy", powers="x", key="top left")
    for row, points in zip(table, curves.values()):
        fraction, viscosity, tau = row["fraction"], row["viscosity"], row["time"]
        colour = shade((BLUE, GREEN, RED), (fraction - 0.3) / 0.26)
        panel.points(points, f"φ = {fraction:g}", colour, size=0.4)
        panel.curve(
            lambda t, eta=viscosity, tau=tau: eta * (1 - np.exp(-t / tau)), None, colour, (points[0][0], points[-1][0])
        )
    panel = figure.panel("φ", "η_φ / η,   τ_φ / τ_B", log="y", key="top left", x_range=(0.28, 0.58))
    for name, title, colour, mark in (("viscosity", "η_φ / η", BLUE, 7), ("time", "τ_φ / τ_B", RED, 5)):
        rows = [(r["fraction"], r[name], 2 * r[f"{name}_error"]) for r in table]
        panel.points(rows, title, colour, mark, joined=True)
    figure.draw()


def measure(program):
    table, curves = measured(program, FRACTIONS, 24)
    write_table(HERE / "table.csv", list(table[0]), table, 5)
    draw(table, curves)
    explicit = measured(program, [0.4], 4, EXPLICIT, "zero-shear-explicit")[0][0]
    implicit = next(row for row in table if row["fraction"] == 0.4)
    return [
        *statements_of(table, curves, min(row["seeds"] for row in table)),
        Statement(
            "φ = 0.4: η_φ by implicit steps over that by explicit ones",
            "method",
            *quotient(number(implicit, "viscosity"), number(explicit, "viscosity")),
            0.5,
            1.5,
            explicit["seeds"] - 1,
        ),
    ]


def quick_measure(program):
    seeds = 16
    small = {"particles": {"count": 100}, **during({"brownian_times": 3}, {"brownian_times": 20})}
    low, high = (number(row, "viscosity") for row in measured(program, (0.3, 0.5), seeds, small)[0])
    return [
        Statement("η_φ at φ = 0.3", "L4.3b", *low, 0.05, 5, seeds - 1),
        Statement("η_φ at φ = 0.5 over that at 0.3", "L4.3b", *quotient(high, low), 1.2, 50, seeds - 1),
    ]


main(HERE, TITLE, measure, quick_measure)
