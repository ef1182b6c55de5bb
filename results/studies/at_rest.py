"""The viscosity at rest, Pe → 0: of the studies of it, by the correlation of the structural Brownian stress, and what
storage and loss of linear response say of each other."""
from pathlib import Path

import numpy as np
from scipy.interpolate import CubicSpline

from studies.estimates import jackknife
from studies.fits import multiples
from studies.tables import entries, number, read_rows, where

RESULTS = Path(__file__).resolve().parents[1]
TIMES = 1e-3 * 10 ** (np.arange(400) / 80)  # the grid on which tau is looked for
SLOWEST = 0.046  # the lowest Peclet number that slow shear knows to a few per cent
SLOW_SHEAR = f"slow shear, Pe = {SLOWEST:g}"


def slow_rows():
    """Returns the rows of the study flow-curve, by volume fraction."""
    table = read_rows(RESULTS / "flow-curve" / "table.csv")
    return {r["fraction"]: r for r in where(table, method="implicit", count=250, peclet=SLOWEST)}


def exact_rows():
    """Returns the rows of the study at-rest, by momentum with its usual step: the best known one of each volume
    fraction."""
    rows = where(read_rows(RESULTS / "at-rest" / "table.csv"), by="momentum", step="automatic")
    rows.sort(key=lambda row: -row["viscosity_error"])
    return {row["fraction"]: with_pairs(row) for row in rows}


def with_pairs(row):
    """Returns a row with `pairs`: its viscosity without 1 + 2.5 phi."""
    value, error = number(row, "viscosity")
    return row | entries("pairs", (value - 1 - 2.5 * row["fraction"], error))


def rows_at_rest():
    """Returns, by volume fraction, `viscosity` with 1 + 2.5 phi and `pairs` without, with their standard errors, and
    seeds; and where they are from: linear response, and slow shear at volume fractions that have no other row."""
    slow, exact = slow_rows(), exact_rows()
    rest = [f for f in slow if f not in exact]
    others = f"; φ = {', '.join(f'{f:g}' for f in rest)}: {SLOW_SHEAR}" if rest else ""
    return slow | exact, f"linear response{others}"


def table_at_rest():
    """Returns what the zero-shear study has measured, by volume fraction: viscosity over the solvent's, time in
    Brownian ones, and their standard errors."""
    return {row["fraction"]: row for row in read_rows(RESULTS / "zero-shear" / "table.csv")}


def viscosity_up_to(point, unit):
    """Returns lags in this unit of time and, a row for each seed, the viscosity up to them."""
    correlations = [mean["stress_correlation"] for mean in point.means]
    return np.array(correlations[0]["time"]) / unit, np.array([c["viscosity"] for c in correlations])


def fitted(times, values):
    """Returns eta_phi and tau of eta_phi (1 - exp(-t / tau)), by least squares over lags that are even in log t; tau by
    a search over a fine grid, eta_phi as the linear coefficient."""
    later = times > 0
    shapes = 1 - np.exp(-times[later] / TIMES[:, None])
    scales, left = multiples(shapes, values[later])
    best = np.argmin(left)
    return float(scales[best]), float(TIMES[best])


def fit_with_errors(times, seeds):
    """Returns the fit to the mean over seeds, and its errors by leaving out one seed at a time."""
    return jackknife(lambda chosen: fitted(times, seeds[chosen].mean(axis=0)), len(seeds))


def storage_by_loss(frequency, loss, samples=4001):
    """Returns the storage modulus G' by Kramers and Kronig, from the loss modulus G'' at increasing frequencies w:

        G'(w) / w = -(2 w / pi) P int_0^inf eta'(x) / (x^2 - w^2) dx,    eta'(x) = G''(x) / x,

    with eta' a cubic spline over ln x, and constant beyond both ends. Since P int_0^inf dx / (x^2 - w^2) = 0, what is
    integrated is (eta'(x) - eta'(w)) / (x^2 - w^2), which has no pole."""
    viscosity = loss / frequency
    spline = CubicSpline(np.log(frequency), viscosity)
    places = np.linspace(np.log(frequency[0]), np.log(frequency[-1]), samples)
    x, values = np.exp(places), spline(places)
    storage = []
    for w, there in zip(frequency, viscosity):
        near = np.abs(x / w - 1) < 1e-9
        distance = np.where(near, 1, x**2 - w**2)
        inner = np.where(near, spline(np.log(w), 1) / (2 * w), (values - there) * x / distance)
        integral = np.sum((inner[1:] + inner[:-1]) / 2) * (places[1] - places[0])
        if w > frequency[0]:
            integral -= (viscosity[0] - there) * np.arctanh(frequency[0] / w) / w
        if w < frequency[-1]:
            integral += (viscosity[-1] - there) * np.arctanh(w / frequency[-1]) / w
        storage.append(-2 * w**2 / np.pi * integral)
    return np.array(storage)


def viscosity_at_high_frequency(fraction):
    """Returns that of hard spheres with all their hydrodynamic interactions, over the fluid's: Lionberger & Russel
    (1994), (1 + 3/2 phi S) / (1 - phi S), S = 1 + phi - 0.189 phi^2."""
    share = fraction * (1 + fraction - 0.189 * fraction**2)
    return (1 + 1.5 * share) / (1 - share)
