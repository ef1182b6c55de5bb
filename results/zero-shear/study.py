#!/usr/bin/python3
"""Brownian viscosity of suspensions at rest, from the correlation of the structural Brownian stress."""
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from studies.driver import BLUE, Figure, Finding, LONGEST, RED, REFERENCE_SCENE, SHORTER, Statement, entries, estimate
from studies.driver import first, fit_with_errors, in_brownian_times, logarithm, main, merged, number, over, quotient
from studies.driver import read_numbers, read_rows, row_ratio, shade, viscosity_up_to, write_numbers, write_rows
import numpy as np

TITLE = "Zero-shear viscosity by Green and Kubo"
FRACTIONS = (0.30, 0.40, 0.45, 0.48, 0.50, 0.52, 0.54, 0.56)
# The error at the largest volume fraction decides that of the fit of the study divergence.
SEEDS, SEEDS_OF_DENSEST = 24, 128
VISCOSITY, THERMAL_ENERGY = 0.1, 0.017
BROWNIAN_TIME = VISCOSITY / THERMAL_ENERGY
SCENE = merged(
    REFERENCE_SCENE,
    in_brownian_times(20, 200),
    particles={"count": 250},
    flow={"shear_rate": 0},
    fluid={"thermal_energy": THERMAL_ENERGY},
    observables=["stress", "stress_correlation"],
)
EXPLICIT = {"integrator": {"method": "explicit"}, **in_brownian_times(5, 40)}


def measured(program, fractions, seeds, patch=None, name="zero-shear"):
    settings = [{"/volume_fraction": f} for f in fractions]
    points = program.run(name, merged(SCENE, patch or {}), settings, seeds, "green_kubo_viscosity")
    table, curves = [], {}
    for fraction, point in zip(fractions, points):
        times, values = viscosity_up_to(point, BROWNIAN_TIME)
        viscosity, tau = fit_up_to(LONGEST, times, values)
        row = {"fraction": fraction, "seeds": len(values)} | entries("viscosity", viscosity) | entries("time", tau)
        for end in SHORTER:
            found = fit_up_to(end, times, values)[0] if times[-1] >= end else (np.nan, np.inf)
            row |= entries(f"viscosity to {end}", found)
        table.append(row)
        curves[fraction] = [(t, *estimate(values[:, k])) for k, t in enumerate(times) if 0 < t <= LONGEST]
    return table, curves


def fit_up_to(end, times, values):
    """Returns η_φ and τ_φ with their errors, from lags up to `end`."""
    some = times <= end
    return list(zip(*fit_with_errors(times[some], values[:, some])))


def growth(low, high):
    """Returns d ln(time) / d phi between two rows, and its errors from either row."""
    width = high["fraction"] - low["fraction"]
    (a, da), (b, db) = (over(logarithm(number(row, "time")), width) for row in (low, high))
    return b - a, da, db


def growth_rows(rows, degrees):
    """Yields statements about τ_φ, published as "short and weakly varying" below 0.5 and "grows quickly" above: without
    numbers, so that the two rates are compared."""
    lowest, dense, densest = rows[min(rows)], rows[max(f for f in rows if f <= 0.5)], rows[max(rows)]
    below, low_error, before_error = growth(lowest, dense)
    above, after_error, high_error = growth(dense, densest)
    # The time at 0.5 enters both rates.
    error = np.hypot(np.hypot(low_error, high_error), before_error + after_error)
    text = "growth rate d ln τ_φ / dφ above φ = 0.5 less that below: weakly varying, then growing quickly"
    yield Statement(text, "L4.3b", above - below, float(error), low=0, degrees=degrees)
    text = f"τ_φ at φ = {densest['fraction']:g} over that at 0.5: it grows"
    yield Statement(text, "L4.3b", *row_ratio(densest, dense, "time"), low=1, degrees=degrees)
    text = f"η_φ at φ = {densest['fraction']:g} over that at {lowest['fraction']:g}"
    yield Finding(text, "L4.3b", *row_ratio(densest, lowest, "viscosity"), degrees)


def distance_of(row, points):
    """Returns the largest distance of the curve from the fitted exponential, over η_φ, with its error."""
    t, values, errors = np.array(points).T
    distances = abs(values - row["viscosity"] * (1 - np.exp(-t / row["time"])))
    worst = np.argmax(distances)
    return over((float(distances[worst]), float(errors[worst])), row["viscosity"])


EXPLICIT_NAME = f"φ = 0.4: η_φ from lags to {SHORTER[0]} τ_B by implicit steps over that by explicit ones"


def judge():
    rows, numbers = {row["fraction"]: row for row in read_rows(HERE / "table.csv")}, read_numbers(HERE / "numbers.csv")
    degrees = min(row["seeds"] for row in rows.values()) - 1
    yield from growth_rows(rows, degrees)
    for fraction, row in rows.items():
        yield Finding(f"φ = {fraction:g}: τ_φ over ηa³/k_BT", "L4.3b", *number(row, "time"), degrees)
    densest = rows[max(rows)]
    for end in SHORTER:
        text = f"φ = {densest['fraction']:g}: η_φ from lags to {end} τ_B over that from lags to {LONGEST} τ_B"
        ratio = quotient(number(densest, f"viscosity to {end}"), number(densest, "viscosity"))
        yield Finding(text, "L4.3b", *ratio, densest["seeds"] - 1)
    for name, (value, error, seeds) in numbers.items():
        # The agreement of the curve with an exponential is not published.
        yield Finding(name, "method" if name == EXPLICIT_NAME else "L4.3b", value, error, seeds)


def draw(table, curves):
    figure = Figure(HERE / "chart.png", columns=2)
    panel = figure.panel("t / τ_B", "η_B(t) / η", log="xy", powers="x", key="top left")
    for row, points in zip(table, curves.values()):
        fraction, viscosity, tau = row["fraction"], row["viscosity"], row["time"]
        colour = shade((fraction - 0.3) / 0.26)
        panel.points(points, f"φ = {fraction:g}", colour, size=0.4)
        ends = points[0][0], points[-1][0]
        panel.curve(lambda t, eta=viscosity, tau=tau: eta * (1 - np.exp(-t / tau)), None, colour, ends)
    panel = figure.panel("φ", "η_φ / η,   τ_φ / τ_B", log="y", key="top left", x_range=(0.28, 0.58))
    for name, title, colour, mark in (("viscosity", "η_φ / η", BLUE, 7), ("time", "τ_φ / τ_B", RED, 5)):
        rows = [(r["fraction"], r[name], 2 * r[f"{name}_error"]) for r in table]
        panel.points(rows, title, colour, mark, joined=True)
    figure.draw()


def measure(program):
    table, curves = [], {}
    for fraction in FRACTIONS:
        seeds = SEEDS if fraction < max(FRACTIONS) else SEEDS_OF_DENSEST
        rows, of_fraction = measured(program, [fraction], seeds, name=f"zero-shear-{fraction:g}")
        table += rows
        curves |= of_fraction
    write_rows(HERE / "table.csv", table, 5)
    draw(table, curves)
    degrees, numbers = min(row["seeds"] for row in table) - 1, {}
    for row in table:
        if row["fraction"] <= 0.5:
            name = f"φ = {row['fraction']:g}: largest distance of η_B(t) from η_φ (1 - exp(-t/τ)), over η_φ"
            numbers[name] = (*distance_of(row, curves[row["fraction"]]), degrees)
    explicit = measured(program, [0.4], 4, EXPLICIT, "zero-shear-explicit")[0][0]
    ratio = row_ratio(first(table, fraction=0.4), explicit, f"viscosity to {SHORTER[0]}")
    write_numbers(HERE / "numbers.csv", numbers | {EXPLICIT_NAME: (*ratio, explicit["seeds"] - 1)})


def quick_measure(program):
    small = {"particles": {"count": 100}, **in_brownian_times(3, 20)}
    low, high = measured(program, (0.3, 0.5), 16, small)[0]
    yield Statement("η_φ at φ = 0.3", "L4.3b", *number(low, "viscosity"), 0.05, 5, 15)
    yield Statement("η_φ at φ = 0.5 over that at 0.3", "L4.3b", *row_ratio(high, low, "viscosity"), 1.2, 50, 15)


main(HERE, TITLE, measure, quick_measure, judge)
