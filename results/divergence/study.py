#!/usr/bin/python3
"""How the viscosity of frictionless spheres diverges with their volume fraction, at rest, at Pe = 4.6 and at Pe = 10^4.

study.py BIN [FOLDER] [--quick]
"""
import math
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from studies.command_line import main
from studies.estimates import difference, jackknife, propagated, quotient
from studies.figure import BLUE, GREEN, RED, Figure
from studies.fits import lines, multiples
from studies.green_kubo import table_at_rest
from studies.published import JAMMED_AT_REST, JAMMED_IN_STRONG_FLOW, diverging
from studies.scenes import TABLE_SCENE, during, merged
from studies.tables import columns_of, entries, number, write_table
from studies.verdicts import Statement
from studies.viscosities import viscosity_row

import numpy as np

TITLE = "Divergence of the viscosity with volume fraction"
PECLET = (4.6, 1e4)
NAMES = {0: "Pe → 0", 4.6: "Pe = 4.6", 1e4: "Pe = 10⁴"}
FRACTIONS = (0.40, 0.45, 0.48, 0.50, 0.52, 0.54, 0.56, 0.58, 0.59, 0.60, 0.61)
SHEARED = merged(TABLE_SCENE, {"duration": {"production": {"strain": 3}}})
SEEDS = 5

# At rest: what the zero-shear study has of these volume fractions, and lubrication at a small Peclet number.
REST_FRACTIONS = FRACTIONS[:7]
SLOW = merged(TABLE_SCENE, {"peclet": 0.22, **during({"brownian_times": 20}, {"brownian_times": 20})})
SLOW_SEEDS = 3

PUBLISHED = {0: (JAMMED_AT_REST, 1.5), 4.6: (None, 1.5), 1e4: (JAMMED_IN_STRONG_FLOW, 1.5)}


def candidates(fractions):
    """Values of phi_J to be tried, and a row of -ln(1 - phi / phi_J) for each."""
    jammed = max(fractions) + 0.0005 * np.arange(1, 401)
    return jammed, -np.log(1 - np.asarray(fractions) / jammed[:, None])


def fitted(fractions, values):
    """phi_J and lambda of (1 - phi / phi_J)^-lambda: least squares in the logarithm, all points with the same weight;
    phi_J by a search in steps of 0.0005, lambda as the linear coefficient."""
    jammed, shapes = candidates(fractions)
    exponents, left = multiples(shapes, np.log(np.maximum(values, 1e-9)))
    best = np.argmin(left)
    return float(jammed[best]), float(exponents[best])


def fit_with_error(rows, quantity):
    """The fit, and of both numbers the standard error: that of the viscosities by drawing them again, and what leaving
    out one volume fraction at a time does, in quadrature; and these two."""
    fractions, numbers = np.array([r["fraction"] for r in rows]), [number(r, quantity) for r in rows]
    values = np.array([v for v, _ in numbers])
    whole, by_fractions = jackknife(lambda chosen: fitted(fractions[chosen], values[chosen]), len(rows))
    _, by_seeds = propagated(numbers, lambda drawn: fitted(fractions, drawn), 100)
    return [(value, math.hypot(a, b), a, b) for value, a, b in zip(whole, by_seeds, by_fractions)]


def other_forms(rows, quantity, lowest):
    """Of the points from `lowest` on: phi_J with lambda = 1.5; and phi_J, lambda and prefactor of
    c (1 - phi / phi_J)^-lambda. Least squares in the logarithm as above, with the root of the mean square of what is
    left."""
    chosen = [r for r in rows if r["fraction"] >= lowest]
    values = np.log([r[quantity] for r in chosen])
    jammed, shapes = candidates([r["fraction"] for r in chosen])
    fixed_rest = np.sqrt(np.square(values - 1.5 * shapes).mean(axis=1))
    constants, exponents, left = lines(shapes, values)
    free_rest = np.sqrt(left / len(values))
    fixed, free = np.argmin(fixed_rest), np.argmin(free_rest)
    return {
        "fixed_jammed": jammed[fixed],
        "fixed_rest": fixed_rest[fixed],
        "free_jammed": jammed[free],
        "free_exponent": exponents[free],
        "free_prefactor": math.exp(constants[free]),
        "free_rest": free_rest[free],
    }


def sheared(program, name, cases, seeds, patch=None):
    """Rows of (Peclet number, volume fraction)."""
    settings = [{"/peclet": p, "/volume_fraction": f} for p, f in cases]
    points = program.run(name, merged(SHEARED, patch or {}), settings, seeds)
    return [{"peclet": p, "fraction": f, **viscosity_row(point)} for (p, f), point in zip(cases, points)]


def at_rest(program):
    """Rows of eta_phi / eta (zero-shear's), the lubrication viscosity, and their sum."""
    measured = table_at_rest()
    settings = [{"/volume_fraction": f} for f in REST_FRACTIONS]
    rows = []
    for fraction, slow in zip(REST_FRACTIONS, program.run("slow", SLOW, settings, SLOW_SEEDS)):
        rest = measured[fraction]
        brownian, lubrication = number(rest, "viscosity"), number(viscosity_row(slow), "lubrication")
        pairs, error = brownian[0] + lubrication[0], math.hypot(brownian[1], lubrication[1])
        row = {"peclet": 0, "fraction": fraction, "seeds": round(rest["seeds"]), "lost": 0, "transient": 0}
        row |= entries("brownian", brownian) | entries("time", number(rest, "time"))
        row |= entries("lubrication", lubrication) | entries("pairs", (pairs, error))
        rows.append(row | entries("viscosity", (1 + 2.5 * fraction + pairs, error)))
    return rows


def fit_statements(peclet, fits, degrees):
    jammed, exponent = PUBLISHED[peclet]
    for quantity, text, essential in (("pairs", "η_r of pairs", True), ("viscosity", "η_r with 1 + 2.5 φ", False)):
        (found_jammed, jammed_error, *_), (found_exponent, exponent_error, *_) = fits[peclet, quantity]
        if jammed:
            line = f"{NAMES[peclet]}: φ_J of {text} (published: {jammed})"
            bounds = jammed - 0.01, jammed + 0.01
            yield Statement(line, "L4.9a", found_jammed, jammed_error, *bounds, degrees, essential)
        line = f"{NAMES[peclet]}: λ of {text} (published: 1.5)"
        bounds = exponent - 0.2, exponent + 0.2
        yield Statement(line, "L4.9a", found_exponent, exponent_error, *bounds, degrees, essential)


def statements_of(curves, fits):
    for peclet, rows in curves.items():
        yield from fit_statements(peclet, fits, len(rows) - 2)
    shift = difference(*(fits[peclet, "pairs"][0][:2] for peclet in PECLET))
    text = "φ_J at Pe = 4.6 less that at 10⁴ (marginally above)"
    yield Statement(text, "L4.9a", *shift, 0, 0.02, len(FRACTIONS) - 2, essential=False)
    middle = {r["fraction"]: r for r in curves[4.6]}
    degrees = min(r["seeds"] for r in curves[4.6]) - 1
    for peclet in (0, 1e4):
        ratios = [(quotient(number(middle[r["fraction"]], "pairs"), number(r, "pairs")), r) for r in curves[peclet]]
        ratio, row = max(ratios, key=lambda r: r[0][0])
        text = f"largest η_r of pairs at Pe = 4.6 over that at {NAMES[peclet]} (at φ = {row['fraction']:g})"
        yield Statement(text, "L4.9a", *ratio, high=1, degrees=degrees)


def write_tables(curves, methods, fits):
    rows = [{"method": "implicit", **r} for c in curves.values() for r in c]
    rows += [{"method": f"{m} at rate 0.045", **r} for m, r in methods.items()]
    quantities = columns_of("viscosity", "pairs", "lubrication", "contact", "brownian", "time")
    columns = ["method", "peclet", "fraction", "seeds", "lost", "transient", *quantities]
    write_table(HERE / "table.csv", columns, rows, 4)
    parts = ("", "_error", "_by_seeds", "_by_fractions")
    columns = ["peclet", "quantity", *(name + part for name in ("jammed", "exponent") for part in parts)]
    rows = [dict(zip(columns, [*key, *jammed, *exponent])) for key, (jammed, exponent) in fits.items()]
    write_table(HERE / "fits.csv", columns, rows, 4)
    cases = [(p, q, f) for p in curves for q in ("pairs", "viscosity") for f in (0.40, 0.48)]
    rows = [{"peclet": p, "quantity": q, "lowest": f, **other_forms(curves[p], q, f)} for p, q, f in cases]
    write_table(HERE / "forms.csv", list(rows[0]), rows, 4)


def measure(program):
    rows = sheared(program, "sheared", [(p, f) for p in PECLET for f in FRACTIONS], SEEDS)
    curves = {0: at_rest(program), **{p: [r for r in rows if r["peclet"] == p] for p in PECLET}}
    fits = {(p, q): fit_with_error(c, q) for p, c in curves.items() for q in ("pairs", "viscosity")}
    fast = {"limits": {"shear_rate": 0.045}, "duration": {"production": {"strain": 2}}}
    methods = {}
    for method in ("implicit", "explicit"):
        patch = merged(fast, {"integrator": {"method": method}})
        methods[method] = sheared(program, method, [(1e4, 0.5)], 6, patch)[0]
    write_tables(curves, methods, fits)
    draw(curves, {peclet: [found[0] for found in fits[peclet, "pairs"]] for peclet in curves})
    ratio = quotient(*(number(methods[m], "viscosity") for m in ("implicit", "explicit")))
    text = "φ = 0.5, Pe = 10⁴, rate 0.045: η_r with implicit steps over that with explicit ones"
    comparison = Statement(text, "method", *ratio, 0.9, 1.1, methods["explicit"]["seeds"] - 1)
    return [*statements_of(curves, fits), comparison]


def draw_divergence(panel, title, colour, power, jammed, exponent, **style):
    ends = 0.38, min(jammed, 0.66) - 1e-5
    panel.curve(lambda f: diverging(f, jammed, exponent) ** power, title, colour, ends, **style)


def draw(curves, fits):
    """`fits`: of each curve phi_J and lambda."""
    figure = Figure(HERE / "chart.png", columns=2)
    ends = {"x_range": (0.38, 0.66)}
    of_pairs = figure.panel("φ", "η_r of pairs", log="y", y_range=(1, 300), key="top left", **ends)
    straight = figure.panel("φ", "(η_r of pairs)^{-2/3}", y_range=(0, 0.6), **ends)
    for (peclet, rows), colour in zip(curves.items(), (BLUE, GREEN, RED)):
        numbers = [(r["fraction"], *number(r, "pairs")) for r in rows]
        raised = [(f, v ** (-2 / 3), e * 2 / 3 * v ** (-5 / 3)) if v > 0 else (f, math.nan, 0) for f, v, e in numbers]
        fit, (jammed, exponent) = fits[peclet], PUBLISHED[peclet]
        for panel, points, power in ((of_pairs, numbers, 1), (straight, raised, -2 / 3)):
            panel.points(points, NAMES[peclet], colour, size=0.8)

            draw_divergence(panel, None, colour, power, *fit)
            if jammed:
                draw_divergence(panel, f"published, φ_J = {jammed}", colour, power, jammed, exponent, dash=2)
    figure.draw()


def quick_measure(program):
    fractions = (0.40, 0.50, 0.55)
    cases = [*((1e4, f) for f in fractions), (4.6, 0.5)]
    *fast, slow = sheared(program, "quick", cases, 8, {"particles": {"count": 150}})
    found = propagated([number(r, "pairs") for r in fast], lambda values: fitted(fractions, values), 100)
    jammed, exponent = zip(*found)
    ratio = quotient(number(slow, "pairs"), number(fast[1], "pairs"))
    return [
        Statement("Pe = 10⁴: φ_J of η_r of pairs", "L4.9a", *jammed, 0.58, 0.72, 7),
        Statement("Pe = 10⁴: its λ", "L4.9a", *exponent, 1, 2.2, 7),
        Statement("φ = 0.5: η_r of pairs at Pe = 4.6 over that at 10⁴", "L4.9a", *ratio, 0.3, 0.9, 7),
    ]


main(HERE, TITLE, measure, quick_measure)
