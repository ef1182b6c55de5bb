#!/usr/bin/python3
"""fits.py: fits laws to the tables of other studies, and writes fits.csv and chart.png beside published numbers."""
import math
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE.parent), str(HERE.parents[1] / "python")]
from studies.figure import BLACK, BLUE, GREEN, ORANGE, RED, Figure
from studies.tables import read_rows, where, write_rows
from peclet import laws
import numpy as np


def arrays(rows, *names):
    return [np.array([row[name] for row in rows]) for name in names]


def diverging():
    """Yields (title, source, Fitted, published numbers by parameter) of the divergence."""
    table = where(read_rows(HERE.parent / "divergence/table.csv"), method="implicit", peclet=1e4)
    rest = where(read_rows(HERE.parent / "at-rest/table.csv"), count=100, step="automatic", by="momentum")
    rest = [row for row in rest if row["fraction"] >= 0.40]
    for row in rest:
        row["pairs"], row["pairs_error"] = row["viscosity"] - 1 - 2.5 * row["fraction"], row["viscosity_error"]
    for name, rows, published in (("at rest", rest, 0.587), ("Pe = 10⁴", table, 0.642)):
        for quantity, what, fixed in (
            ("pairs", "η_r of pairs, prefactor 1", {"prefactor": 1}),
            ("pairs", "η_r of pairs", None),
            ("viscosity", "η_r, prefactor 1", {"prefactor": 1}),
            ("viscosity", "η_r", None),
        ):
            given = arrays(rows, "fraction", quantity, f"{quantity}_error", "seeds")
            fit = laws.divergence(*given, fixed=fixed)
            yield f"{name}: {what}", "L4.9a", fit, {"phi_m": published, "exponent": 1.5}


def thickening():
    """Returns fits of the law of Wyart and Cates, the points of stress-control that flow, those of which seeds jam with
    their bounds, and published numbers."""
    rows = where(read_rows(HERE.parent / "stress-control/table.csv"), kind="thickening", control="stress")
    flowing = [row for row in rows if row["flowing"] == 1]
    fraction, stress, viscosity, error = arrays(flowing, "fraction", "at", "viscosity", "viscosity_error")
    # Points have fewer seeds than an error needs: the relative spread is that of all points together.
    pooled = math.sqrt(np.mean(np.square(error / viscosity)))
    jammed = [(row["fraction"], row["at"], viscosity.max()) for row in rows if row["flowing"] < 1]
    seeds = sum(row["seeds"] - 1 for row in flowing) + 1
    points = fraction, stress, viscosity, pooled * viscosity
    published = {"phi_0": 0.66, "phi_mu": 0.575, "discontinuous_from": 0.56}
    fits = {
        "exponent 2, prefactor 1": laws.wyart_cates(*points, seeds, jammed),
        "free exponent and prefactor": laws.wyart_cates(*points, seeds, jammed, free=["exponent", "prefactor"]),
        "free exponent, prefactor and sharpness": laws.wyart_cates(
            *points, seeds, jammed, free=["exponent", "prefactor", "sharpness"]
        ),
    }
    return fits, points, jammed, published


def uniform():
    """Returns the laws of the viscous number of uniform flow, without friction of the spheres, and its rows."""
    rows = read_rows(HERE.parent / "inhomogeneous-flow/uniform.csv")
    given = arrays(rows, "fraction", "J", "J_error", "mu", "mu_error", "seeds")
    return laws.mu_of_j(*given), rows


def rows_of(study, title, fit, published):
    for name, number in {**fit.parameters, **fit.derived}.items():
        low, high = number.interval or (math.nan, math.nan)
        row = {"study": study, "fit": title, "parameter": name, "value": number.value, "error": number.standard_error}
        row |= {"low": low, "high": high, "published": published.get(name, math.nan), "obstacle": number.obstacle}
        for end, other in fit.ends.items():
            known = {**other.parameters, **other.derived}.get(name) if isinstance(other, laws.Fitted) else None
            row[end] = known.value if known and known.value is not None else math.nan
        yield {**row, "chi_squared": fit.chi_squared, "degrees": float(fit.degrees), "p": fit.p_value}


def main():
    rows = []
    for title, source, fit, published in diverging():
        rows += rows_of(f"divergence ({source})", title, fit, published)
    fits, points, jammed, published = thickening()
    for title, fit in fits.items():
        rows += rows_of("stress-control", title, fit, published)
    fit, uniform_rows = uniform()
    rows += rows_of(
        "inhomogeneous-flow, uniform", "P = −tr/3", fit, {"phi_m": 0.585, "mu_1": 0.32, "mu_2": 0.7, "I_0": 0.005}
    )
    write_rows(HERE / "fits.csv", rows, 4)
    draw(fits["free exponent and prefactor"], points, jammed, fit, uniform_rows)


def draw(thick, points, jammed, fit, rows):
    figure = Figure(HERE / "chart.png", columns=2)
    left = figure.panel("σ [F_{CL}/a²]", "η_r", "thickening", log="xy", key="top left")
    fraction, stress, viscosity, error = points
    for phi, colour in zip(np.unique(fraction), (BLUE, GREEN, ORANGE, RED)):
        own = fraction == phi
        left.points(list(zip(stress[own], viscosity[own], error[own])), f"φ = {phi:g}", colour)
        at = np.geomspace(0.1, 2, 200)
        value, low, high = thick.curve(phi, at)
        known = np.isfinite(value)
        left.line(list(zip(at[known], value[known])), None, colour)
        left.points([(at, bound) for of, at, bound in jammed if of == phi], None, colour, 9)
    right = figure.panel("J", "μ, φ", "uniform flow", log="xy", key="top left")
    viscous = np.geomspace(min(r["J"] for r in rows), max(r["J"] for r in rows), 200)
    mu, phi = np.split(fit.curve(viscous)[0], 2)
    right.points([(r["J"], r["mu"], r["mu_error"]) for r in rows], "μ", BLUE)
    right.points([(r["J"], r["fraction"], 0) for r in rows], "φ", RED)
    right.line(list(zip(viscous, mu)), "fit", BLACK)
    right.line(list(zip(viscous, phi)), None, BLACK)
    figure.draw()


main()
