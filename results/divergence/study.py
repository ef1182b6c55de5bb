#!/usr/bin/python3
"""Divergence of the viscosity of frictionless spheres with volume fraction, at rest, at Pe = 4.6 and at Pe = 10^4."""
import math
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from studies.driver import BLUE, Check, Figure, Finding, GREEN, JAMMED_AT_REST, JAMMED_IN_STRONG_FLOW, LONGEST, ORANGE
from studies.driver import RED, SHORTER, Statement, TABLE_SCENE, difference, diverging, entries, first, fit_with_error
from studies.driver import in_brownian_times, jammed_and_exponent, lines, main, merged, number, propagated, read_rows
from studies.driver import row_ratio, rows_at_rest, shapes_of, table_at_rest, where, write_rows, write_table
import numpy as np

TITLE = "Divergence of the viscosity with volume fraction"
PECLET = (4.6, 1e4)
NAMES = {0: "Pe → 0, by the recipe in print", 4.6: "Pe = 4.6", 1e4: "Pe = 10⁴"}
FRACTIONS = (0.40, 0.45, 0.48, 0.50, 0.52, 0.54, 0.56, 0.58, 0.59, 0.60, 0.61)
SHEARED = merged(TABLE_SCENE, duration={"production": {"strain": 3}})
SEEDS = 5

# Volume fractions at rest, with rows of the study zero-shear and lubrication at a small Peclet number.
REST_FRACTIONS = FRACTIONS[:7]
SLOW = merged(TABLE_SCENE, in_brownian_times(20, 20), peclet=0.22)
SLOW_SEEDS = 48

PUBLISHED = {0: (JAMMED_AT_REST, 1.5), 4.6: (None, None), 1e4: (JAMMED_IN_STRONG_FLOW, 1.5)}  # phi_J and lambda


def jammed_at(fractions, values):
    """Returns phi_J of (1 - phi / phi_J)^-1.5, with the published exponent; twice, as fit_with_error() needs a pair."""
    jammed, shapes = shapes_of(fractions)
    best = jammed[np.argmin(np.square(np.log(np.maximum(values, 1e-9)) - 1.5 * shapes).sum(axis=1))]
    return float(best), float(best)


def rest_of(rows, quantity, jammed, exponent):
    """Returns the rms residual of ln η_r of a fit with the prefactor 1."""
    return math.sqrt(
        np.square([math.log(r[quantity] / diverging(r["fraction"], jammed, exponent)) for r in rows]).mean()
    )


def other_forms(rows, quantity, lowest):
    """Returns other fits to points from `lowest` on: phi_J with lambda = 1.5; phi_J, lambda and c of
    c (1 - phi / phi_J)^-lambda. Least squares in the logarithm, with rms residuals."""
    chosen = [r for r in rows if r["fraction"] >= lowest]
    values = np.log([r[quantity] for r in chosen])
    jammed, shapes = shapes_of([r["fraction"] for r in chosen])
    fixed_rest = np.sqrt(np.square(values - 1.5 * shapes).mean(axis=1))
    constants, exponents, left = lines(shapes, values)
    free_rest = np.sqrt(left / len(values))
    fixed, free = np.argmin(fixed_rest), np.argmin(free_rest)
    found = {"fixed_jammed": jammed[fixed], "fixed_rest": fixed_rest[fixed], "free_jammed": jammed[free]}
    found |= {"free_exponent": exponents[free], "free_prefactor": math.exp(constants[free])}
    return found | {"free_rest": free_rest[free]}


def sheared(program, name, cases, seeds, patch=None):
    """Returns rows for cases (Peclet number, volume fraction)."""
    pointers = {"peclet": "/peclet", "fraction": "/volume_fraction"}
    return program.rows(name, merged(SHEARED, patch or {}), pointers, cases, seeds)


def at_rest(program):
    """Yields rows at rest: eta_phi / eta of the study zero-shear, the lubrication viscosity, and their sum."""
    cases = [(fraction,) for fraction in REST_FRACTIONS]
    for slow in program.rows("slow", SLOW, {"fraction": "/volume_fraction"}, cases, SLOW_SEEDS):
        fraction = slow["fraction"]
        rest = table_at_rest()[fraction]
        brownian, lubrication = number(rest, "viscosity"), number(slow, "lubrication")
        pairs, error = brownian[0] + lubrication[0], math.hypot(brownian[1], lubrication[1])
        row = {"peclet": 0, "fraction": fraction, "seeds": round(rest["seeds"]), "lost": 0, "transient": 0}
        row |= entries("brownian", brownian) | entries("time", number(rest, "time"))
        row |= entries("lubrication", lubrication) | entries("pairs", (pairs, error))
        yield row | entries("viscosity", (1 + 2.5 * fraction + pairs, error))


READINGS = {"pairs": "η_r of pairs", "viscosity": "η_r with 1 + 2.5 φ"}


def fit_rows(peclet, name, curve, essential=True):
    """Yields statements about φ_J and λ.

    It is not published whether η_r of pairs, as in the figures, or with 1 + 2.5 φ was fitted; the nearer one decides.
    φ_J is published with three digits, λ as "about 1.5", which is no essential statement. Errors include that by
    leaving out volume fractions, which tests the form.
    """
    jammed, exponent = PUBLISHED[peclet]
    fits = {reading: fit_with_error(curve, reading) for reading in READINGS}
    nearer = min(fits, key=lambda reading: abs(fits[reading][0][0] - jammed))
    degrees = max(len(curve) - 2, 1)
    for reading, of in READINGS.items():
        (found, error), (power, power_error) = (numbers[:2] for numbers in fits[reading])
        ends = jammed - 0.01, jammed + 0.01
        text = f"{name}: φ_J of {of} (published: {jammed})"
        yield Statement(text, "L4.9a", found, error, *ends, degrees, essential and reading == nearer)
        text = f"{name}: λ of {of} (published: about 1.5)"
        yield Statement(text, "L4.9a", power, power_error, exponent - 0.2, exponent + 0.2, degrees, False)


def lag_rows(curve):
    """Yields findings about the recipe with shorter lags."""
    rest = table_at_rest()
    for end in SHORTER:
        rows = []
        for row in curve:
            fraction, (brownian, error) = row["fraction"], number(rest[row["fraction"]], f"viscosity to {end}")
            pairs, error = row["lubrication"] + brownian, math.hypot(error, row["lubrication_error"])
            both = entries("pairs", (pairs, error)) | entries("viscosity", (1 + 2.5 * fraction + pairs, error))
            rows.append({"fraction": fraction, **both})
        for reading, of in READINGS.items():
            name = f"{NAMES[0]} with lags to {end} τ_B, not {LONGEST}"
            for symbol, (found, error, _, _) in zip(("φ_J", "λ"), fit_with_error(rows, reading)):
                yield Finding(f"{name}: {symbol} of {of}", "L4.9a", found, error, len(rows) - 2)


def shift_rows(curves):
    """Yields rows about the shift of φ_J, with λ = 1.5 as published, and with λ fitted."""
    for reading, of in READINGS.items():
        held = difference(*(fit_with_error(curves[p], reading, jammed_at)[0][:2] for p in PECLET))
        free = difference(*(fit_with_error(curves[p], reading)[0][:2] for p in PECLET))
        text = f"φ_J of {of} at Pe = 4.6 less that at 10⁴, λ = 1.5 (published: marginally increased)"
        yield Statement(text, "L4.9a", *held, 0, 0.02, len(FRACTIONS) - 2, essential=False)
        yield Finding(f"φ_J of {of} at Pe = 4.6 less that at 10⁴, λ free", "form", *free, len(FRACTIONS) - 2)


def lowest_rows(curves, name):
    """Yields statements that the curve at the intermediate Pe lies below both others."""
    middle = {r["fraction"]: r for r in curves[4.6]}
    for peclet, of in ((0, name), (1e4, NAMES[1e4])):
        both = [(middle[r["fraction"]], r) for r in curves[peclet] if r["fraction"] in middle]
        ratios = [(row_ratio(a, b, "pairs"), b) for a, b in both]
        ratio, row = max(ratios, key=lambda r: r[0][0])
        text = f"largest η_r of pairs at Pe = 4.6 over that at {of} (at φ = {row['fraction']:g})"
        yield Statement(text, "L4.9a", *ratio, high=1, degrees=SEEDS - 1)
    for fraction in (FRACTIONS[0], FRACTIONS[-1]):
        pair = (first(curves[p], fraction=fraction) for p in PECLET)
        text = f"φ = {fraction:g}: η_r of pairs at Pe = 4.6 over that at 10⁴ (one φ_J for both: the same at every φ)"
        yield Finding(text, "form", *row_ratio(*pair, "pairs"), SEEDS - 1)
    for peclet in PECLET:
        steps = [row_ratio(b, a, "pairs") for a, b in zip(curves[peclet], curves[peclet][1:])]
        text = f"{NAMES[peclet]}: least η_r of pairs at a φ over that at the next lower one (increasing sharply)"
        yield Statement(text, "L4.5d", *min(steps), 1, degrees=SEEDS - 1)


def curves_of_table():
    table = read_rows(HERE / "table.csv")
    rows = where(table, method="implicit")
    return {p: where(rows, peclet=p) for p in (0, *PECLET)}, table


def judge():
    curves, table = curves_of_table()
    rest, how = rows_at_rest()
    name = f"Pe → 0 ({how})"
    recipe, curves[0] = curves[0], [rest[f] for f in sorted(rest) if f >= FRACTIONS[0]]
    # The published estimate of the limit is the Green-Kubo integral of the structural stress, plus lubrication. It is
    # biased for soft spheres, so that the exact limit, by linear response, is another statement.
    # What it gives goes with the longest lag, which is not in print.
    yield from fit_rows(0, NAMES[0], recipe, essential=False)
    yield from lag_rows(recipe)
    yield from fit_rows(0, name, curves[0], essential=False)
    for reading, of in READINGS.items():  # at rest one exponent does not describe all volume fractions
        found = fit_with_error(curves[0], reading, jammed_at)[0][:2]
        yield Finding(f"{name}: φ_J of {of}, λ = 1.5", "form", *found, len(curves[0]) - 1)
    yield from fit_rows(1e4, NAMES[1e4], curves[1e4])
    yield from shift_rows(curves)
    yield from lowest_rows(curves, name)
    methods = [first(table, method=f"{m} at rate 0.045") for m in ("implicit", "explicit")]
    text = "φ = 0.5, Pe = 10⁴, rate 0.045: η_r with implicit steps over that with explicit ones"
    yield Check(text, "method", *row_ratio(*methods, "viscosity"), 0.9, 1.1, methods[1]["seeds"] - 1)


def measure(program):
    rows = sheared(program, "sheared", [(p, f) for p in PECLET for f in FRACTIONS], SEEDS)
    curves = {0: list(at_rest(program)), **{p: where(rows, peclet=p) for p in PECLET}}
    table = [{"method": "implicit", **row} for curve in curves.values() for row in curve]
    fast = {"limits": {"shear_rate": 0.045}, "duration": {"production": {"strain": 2}}}
    for method in ("implicit", "explicit"):
        (row,) = sheared(program, method, [(1e4, 0.5)], 6, merged(fast, integrator={"method": method}))
        table.append({"method": f"{method} at rate 0.045", **row})
    names = "method, peclet, fraction, seeds, lost, transient, viscosity±, pairs±, lubrication±, contact±, brownian±"
    write_table(HERE / "table.csv", f"{names}, time±", table, 4)


def write_fits(curves):
    """Writes fits.csv and forms.csv, for curves by name."""
    parts = ("", "_error", "_by_seeds", "_by_fractions")
    columns = ["of", "quantity", *(name + part for name in ("jammed", "exponent") for part in parts)]
    fits = [(name, q, *sum(fit_with_error(curves[name], q), ())) for name in curves for q in READINGS]
    rows = [{**dict(zip(columns, fit)), "rest": rest_of(curves[fit[0]], fit[1], fit[2], fit[6])} for fit in fits]
    write_rows(HERE / "fits.csv", rows, 4)
    cases = [(name, q, f) for name in curves for q in READINGS for f in (0.40, 0.48)]
    rows = [{"of": name, "quantity": q, "lowest": f, **other_forms(curves[name], q, f)} for name, q, f in cases]
    write_rows(HERE / "forms.csv", rows, 4)


def draw_divergence(panel, title, colour, power, jammed, exponent, **style):
    ends = 0.38, min(jammed, 0.66) - 1e-5
    panel.curve(lambda f: diverging(f, jammed, exponent) ** power, title, colour, ends, **style)


def draw():
    curves, _ = curves_of_table()
    rest, how = rows_at_rest()
    by_response = [rest[f] for f in sorted(rest) if f >= FRACTIONS[0]]
    write_fits({**{NAMES[p]: rows for p, rows in curves.items()}, f"Pe → 0, {how}": by_response})
    figure = Figure(HERE / "chart.png", columns=2)
    ends = {"x_range": (0.38, 0.66)}
    of_pairs = figure.panel("φ", "η_r of pairs", log="y", y_range=(1, 1000), key="top left", **ends)
    straight = figure.panel("φ", "(η_r of pairs)^{-2/3}", y_range=(0, 0.85), key=None, **ends)
    shown = [*((NAMES[p], rows, PUBLISHED[p], c, 7) for (p, rows), c in zip(curves.items(), (BLUE, GREEN, RED)))]
    shown.append((f"Pe → 0, {how}", by_response, (None, None), ORANGE, 5))
    for name, rows, (jammed, exponent), colour, mark in shown:
        numbers = [(r["fraction"], *number(r, "pairs")) for r in rows]
        raised = [(f, v ** (-2 / 3), e * 2 / 3 * v ** (-5 / 3)) if v > 0 else (f, math.nan, 0) for f, v, e in numbers]
        fit = [found[0] for found in fit_with_error(rows, "pairs")]
        for panel, points, power in ((of_pairs, numbers, 1), (straight, raised, -2 / 3)):
            panel.points(points, name, colour, mark, 0.8)
            draw_divergence(panel, None, colour, power, *fit)
            if jammed:
                draw_divergence(panel, f"published, φ_J = {jammed}", colour, power, jammed, exponent, dash=2)
    figure.draw()


def quick_measure(program):
    fractions = (0.40, 0.50, 0.55)
    cases = [*((1e4, f) for f in fractions), (4.6, 0.5)]
    *fast, slow = sheared(program, "quick", cases, 8, {"particles": {"count": 150}})
    found = propagated([number(r, "pairs") for r in fast], lambda values: jammed_and_exponent(fractions, values), 100)
    jammed, exponent = zip(*found)
    yield Statement("Pe = 10⁴: φ_J of η_r of pairs", "L4.9a", *jammed, 0.58, 0.72, 7)
    yield Statement("Pe = 10⁴: its λ", "L4.9a", *exponent, 1, 2.2, 7)
    ratio = row_ratio(slow, fast[1], "pairs")
    yield Statement("φ = 0.5: η_r of pairs at Pe = 4.6 over that at 10⁴", "L4.9a", *ratio, 0.3, 0.9, 7)


main(HERE, TITLE, measure, quick_measure, judge, draw)
