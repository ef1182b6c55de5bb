#!/usr/bin/python3
"""Evaluates the Gaussian process of runner/statistics/curve_fit.h in another way, and prints the numbers of its test.

The marginal likelihood is that of the contrasts, which are free of the trend; the posterior is that of universal
kriging; and each residual follows from a fit that lacks the datum.
"""
import math

import numpy as np
from scipy.linalg import null_space
from scipy.stats import multivariate_normal, t

AXIS = np.array([0.01, 0.05, 0.2, 1, 5, 20, 100])
MEAN = np.array([7.5, 7.1, 6.6, 5.4, 5.0, 6.1, 7.4])
ERROR = np.array([0.5, 0.3, 0.2, 0.1, 0.08, 0.1, 0.09])
COUNT = np.array([8, 10, 13, 8, 8, 17, 8])
NEW = np.array([0.02, 2, 50])
GAIN_AT, GAIN_NOISE = 3, 0.001


def kernel(one, other, amplitude, length):
    r = math.sqrt(5) * np.abs(one[:, None] - other[None, :]) / length
    return amplitude**2 * (1 + r + r**2 / 3) * np.exp(-r)


def trend(x):
    return np.stack([np.ones_like(x), x], axis=1)


def posterior(x, y, noise, places, model):
    """Solves the system of universal kriging: weights and multipliers of each place."""
    functions = trend(x)
    system = np.block([[kernel(x, x, *model) + np.diag(noise), functions], [functions.T, np.zeros((2, 2))]])
    right = np.concatenate([kernel(x, places, *model), trend(places).T])
    solved = np.linalg.solve(system, right)
    return solved[: len(x)].T @ y, kernel(places, places, *model) - solved.T @ right


def likelihoods(x, y, noise, grid):
    contrasts = null_space(trend(x).T)
    covariances = [contrasts.T @ (kernel(x, x, *model) + np.diag(noise)) @ contrasts for model in grid]
    return np.array([multivariate_normal.logpdf(contrasts.T @ y, cov=covariance) for covariance in covariances])


def models(x, y, noise):
    """Yields amplitude and length of the grid with their weights."""
    distances = np.abs(x[:, None] - x[None, :])
    nearest = distances[distances > 0].min()
    scatter = y.std()
    smallest = max(0.1 * scatter, 0.3 * math.sqrt(sorted(noise)[len(noise) // 2]))
    lengths = np.geomspace(0.5 * nearest, 3 * distances.max(), 10)
    amplitudes = np.geomspace(smallest, 10 * max(scatter, smallest), 10)
    grid = [(amplitude, length) for length in lengths for amplitude in amplitudes]
    logs = likelihoods(x, y, noise, grid)
    weights = np.exp(logs - logs.max())
    weights[weights < 1e-4] = 0
    return grid, weights / weights.sum()


def mixed(weights, means, variances):
    mean = weights @ means
    return mean, np.sqrt(weights @ (variances + means**2) - mean**2)


def main():
    x, y = np.log(AXIS), np.log(MEAN)
    noise = (ERROR / MEAN) ** 2 * (COUNT - 1) / (COUNT - 3)
    grid, weights = models(x, y, noise)
    for places in (x, np.log(NEW)):
        found = [posterior(x, y, noise, places, model) for model in grid]
        means, variances = np.array([m for m, _ in found]), np.array([np.diag(c) for _, c in found])
        print("values", [list(map(float, pair)) for pair in np.round(mixed(weights, means, variances), 7)])
    residuals, variances = np.zeros((2, len(grid), len(x)))
    distances = []
    for i in range(len(x)):
        rest = np.arange(len(x)) != i
        for m, model in enumerate(grid):
            mean, covariance = posterior(x[rest], y[rest], noise[rest], x[i : i + 1], model)
            residuals[m, i], variances[m, i] = y[i] - mean[0], covariance[0, 0] + noise[i]
        logs = likelihoods(x[rest], y[rest], noise[rest], grid)
        of_others = np.exp(logs - logs.max())
        mean, deviation = mixed(of_others / of_others.sum(), residuals[:, i], variances[:, i])
        distances.append(mean / deviation)
    print("residuals", np.round(distances, 6).tolist())
    allowed = t.ppf(1 - 0.05 / len(x) / 2, COUNT - 1) * np.sqrt((COUNT - 3) / (COUNT - 1))
    print("allowed", np.round(allowed, 6).tolist())
    within, within_then, means = np.zeros(len(x)), np.zeros(len(x)), np.zeros((len(grid), len(x)))
    for m, (weight, model) in enumerate(zip(weights, grid)):
        means[m], before = posterior(x, y, noise, x, model)
        _, after = posterior(np.append(x, x[GAIN_AT]), np.append(y, 0), np.append(noise, GAIN_NOISE), x, model)
        within += weight * np.diag(before)
        within_then += weight * np.diag(after)
    between = weights @ means**2 - (weights @ means) ** 2
    print("gains", ((within + between) * (1 - within_then / within)).tolist())


if __name__ == "__main__":
    main()
