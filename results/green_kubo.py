"""The viscosity of a suspension at rest from the correlation of its structural Brownian stress: its curve over the lag, and what is fitted to it."""
import csv
import math
import os


def table_at_rest():
    """What the zero-shear study has measured, by volume fraction: viscosity over the solvent's, time in Brownian ones, and their standard errors."""
    with open(os.path.join(os.path.dirname(os.path.abspath(__file__)), "zero-shear", "table.csv"), newline="") as f:
        return {
            float(row["fraction"]): {name: float(value) for name, value in row.items()} for row in csv.DictReader(f)
        }


def curve(point, unit):
    """Lags in this unit of time and, by seed, the viscosity up to them."""
    correlations = [r["mean"]["stress_correlation"] for r in point["realisations"] if r.get("mean")]
    return [t / unit for t in correlations[0]["time"]], [c["viscosity"] for c in correlations]


def fitted(times, values):
    """eta_phi and tau of eta_phi (1 - exp(-t / tau)), by least squares over lags that are even in log t; tau by a search over a fine
    grid, eta_phi as the linear coefficient."""
    chosen = [k for k, t in enumerate(times) if t > 0]
    best = None
    for step in range(400):
        tau = 1e-3 * 10 ** (step / 80)
        shape = [1 - math.exp(-times[k] / tau) for k in chosen]
        scale = sum(s * values[k] for s, k in zip(shape, chosen)) / sum(s * s for s in shape)
        misfit = sum((scale * s - values[k]) ** 2 for s, k in zip(shape, chosen))
        if best is None or misfit < best[0]:
            best = misfit, scale, tau
    return best[1:]


def fit_with_errors(times, seeds):
    """The fit to the mean over seeds, and its errors by leaving out one seed at a time (jackknife)."""
    n = len(seeds)
    total = [sum(column) for column in zip(*seeds)]
    whole = fitted(times, [v / n for v in total])
    parts = [fitted(times, [(v - w) / (n - 1) for v, w in zip(total, own)]) for own in seeds]
    errors = []
    for which in range(2):
        middle = sum(p[which] for p in parts) / n
        errors.append(math.sqrt((n - 1) / n * sum((p[which] - middle) ** 2 for p in parts)))
    return whole, errors
