"""The viscosity at rest, Pe → 0: tables of the studies that measure it, its estimate from the correlation of the
structural Brownian stress, and the Kramers-Kronig relation of storage and loss moduli."""
from pathlib import Path

import numpy as np
from scipy.interpolate import CubicSpline

from studies.estimates import jackknife
from studies.fits import multiples
from studies.tables import entries, number, read_rows, where

RESULTS = Path(__file__).resolve().parents[1]
STEP = 10 ** (1 / 80)
TIMES = 1e-3 * STEP ** np.arange(400)  # grid of the search for tau
# Longest lags of fits to the correlation [Brownian times]; print does not say its own, and that of a run goes with its
# step.
LONGEST, SHORTER = 26, (6.5, 13)
SLOWEST = 0.046  # lowest Peclet number at which slow shear has an error of a few per cent
SLOW_SHEAR = f"slow shear, Pe = {SLOWEST:g}"


def slow_rows():
    """Returns the rows of the study flow-curve with the most spheres, by volume fraction."""
    table = read_rows(RESULTS / "flow-curve" / "table.csv")
    rows = sorted(where(table, method="implicit", peclet=SLOWEST), key=lambda row: row["count"])
    return {row["fraction"]: row for row in rows}


def exact_rows():
    """Returns, by volume fraction, the rows of the study at-rest with the smallest error, among those by momentum with
    the automatic step."""
    rows = where(read_rows(RESULTS / "at-rest" / "table.csv"), by="momentum", step="automatic")
    rows.sort(key=lambda row: -row["viscosity_error"])
    return {row["fraction"]: with_pairs(row) for row in rows}


def with_pairs(row):
    """Returns the row with a further entry `pairs`: its viscosity minus 1 + 2.5 phi."""
    value, error = number(row, "viscosity")
    return row | entries("pairs", (value - 1 - 2.5 * row["fraction"], error))


def rows_at_rest():
    """Returns rows by volume fraction, and a text about their source.

    A row has `viscosity`, `pairs` (without 1 + 2.5 phi), their standard errors, and seeds. It is from linear response,
    or, at volume fractions without such a row, from slow shear.
    """
    slow, exact = slow_rows(), exact_rows()
    rest = [f for f in slow if f not in exact]
    others = f"; φ = {', '.join(f'{f:g}' for f in rest)}: {SLOW_SHEAR}" if rest else ""
    return slow | exact, f"linear response{others}"


def table_at_rest():
    """Returns the rows of the study zero-shear by volume fraction: viscosity over the solvent's, relaxation time in
    Brownian times, and their standard errors."""
    return {row["fraction"]: row for row in read_rows(RESULTS / "zero-shear" / "table.csv")}


def viscosity_up_to(point, unit):
    """Returns lags (n,) in this unit of time, and the viscosities integrated up to them (seeds, n)."""
    correlations = [mean["stress_correlation"] for mean in point.means]
    return np.array(correlations[0]["time"]) / unit, np.array([c["viscosity"] for c in correlations])


def fitted(times, values):
    """Returns eta_phi and tau of a least-squares fit of eta_phi (1 - exp(-t / tau)) to values (n,) at times (n,).

    tau is found by a search over the grid TIMES and a parabola through the least residual and its neighbours: without
    it, tau would jump by steps larger than one seed of many moves it, and jackknife errors would be too large. eta_phi
    is the linear coefficient.
    """
    later = times > 0

    def multiples_of(taus):
        return multiples(1 - np.exp(-times[later] / np.reshape(taus, (-1, 1))), values[later])

    _, left = multiples_of(TIMES)
    best = int(np.clip(np.argmin(left), 1, len(TIMES) - 2))
    before, least, after = left[best - 1 : best + 2]
    shift = float(np.clip(0.5 * (before - after) / (before - 2 * least + after), -1, 1))
    tau = TIMES[best] * STEP**shift
    (scale,), _ = multiples_of(tau)
    return float(scale), float(tau)


def fit_with_errors(times, seeds):
    """Returns the fit to the mean over seeds, and its jackknife errors."""
    return jackknife(lambda chosen: fitted(times, seeds[chosen].mean(axis=0)), len(seeds))


def storage_by_loss(frequency, loss, samples=4001):
    """Returns the storage modulus G' from the loss modulus G'' at increasing frequencies w (Kramers-Kronig relation)

        G'(w) / w = -(2 w / pi) P int_0^inf eta'(x) / (x^2 - w^2) dx,    eta'(x) = G''(x) / x.

    eta' is a cubic spline over ln x, constant beyond both ends. Because P int_0^inf dx / (x^2 - w^2) = 0, the integrand
    is (eta'(x) - eta'(w)) / (x^2 - w^2), which has no pole.
    """
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
    """Returns the relative viscosity of hard spheres at high frequency, with full hydrodynamics (Lionberger & Russel,
    1994): (1 + 3/2 phi S) / (1 - phi S), S = 1 + phi - 0.189 phi^2."""
    share = fraction * (1 + fraction - 0.189 * fraction**2)
    return (1 + 1.5 * share) / (1 - share)
