"""The viscosity of a suspension at rest from the correlation of its structural Brownian stress: its curve over the lag,
and what is fitted to it."""
from pathlib import Path

import numpy as np

from studies.estimates import jackknife
from studies.fits import multiples
from studies.tables import read_table

TIMES = 1e-3 * 10 ** (np.arange(400) / 80)  # the grid on which tau is looked for


def table_at_rest():
    """What the zero-shear study has measured, by volume fraction: viscosity over the solvent's, time in Brownian ones,
    and their standard errors."""
    rows = read_table(Path(__file__).resolve().parents[1] / "zero-shear" / "table.csv")
    return {row["fraction"]: row for row in rows}


def curve(point, unit):
    """Lags in this unit of time and, a row for each seed, the viscosity up to them."""
    correlations = [mean["stress_correlation"] for mean in point.means]
    return np.array(correlations[0]["time"]) / unit, np.array([c["viscosity"] for c in correlations])


def fitted(times, values):
    """eta_phi and tau of eta_phi (1 - exp(-t / tau)), by least squares over lags that are even in log t; tau by a
    search over a fine grid, eta_phi as the linear coefficient."""
    later = times > 0
    shapes = 1 - np.exp(-times[later] / TIMES[:, None])
    scales, left = multiples(shapes, values[later])
    best = np.argmin(left)
    return float(scales[best]), float(TIMES[best])


def fit_with_errors(times, seeds):
    """The fit to the mean over seeds, and its errors by leaving out one seed at a time."""
    return jackknife(lambda chosen: fitted(times, seeds[chosen].mean(axis=0)), len(seeds))
