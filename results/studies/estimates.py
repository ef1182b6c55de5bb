"""Means, ratios and other numbers with their standard errors, and control variates.

A number with its standard error is a pair (value, error). Errors are propagated to first order.
"""
import math
import random

import numpy as np
from scipy.special import stdtrit


def estimate(values):
    """Returns mean and standard error s / sqrt(n), s^2 = sum (v - mean)^2 / (n - 1); infinite for a single value."""
    values = np.asarray(values, float)
    if len(values) < 2:
        return float(values.mean()), math.inf
    return float(values.mean()), float(values.std(ddof=1) / math.sqrt(len(values)))


def student_quantile(degrees, probability):
    """Returns the quantile of Student's distribution with these degrees of freedom; infinite for less than one."""
    return math.inf if degrees < 1 else float(stdtrit(degrees, probability))


def weighted_mean(values, errors):
    """Returns the mean of independent numbers with weights 1 / error^2, and its standard error."""
    mean, weight = np.average(values, weights=1 / np.square(errors), returned=True)
    return float(mean), float(1 / math.sqrt(weight))


def difference(a, b):
    """Returns a - b of two independent numbers."""
    return a[0] - b[0], math.hypot(a[1], b[1])


def in_errors(a, b):
    """Returns a - b of two independent numbers over its standard error, and an error of 0."""
    value, error = difference(a, b)
    return value / error, 0.0


def quotient(a, b):
    """Returns a / b of two independent numbers."""
    value = a[0] / b[0]
    return value, math.hypot(a[1], value * b[1]) / abs(b[0])


def over(a, scale):
    """Returns a number divided by an exact one."""
    return a[0] / scale, a[1] / abs(scale)


def scaled(a, factor):
    """Returns a number multiplied by an exact one."""
    return a[0] * factor, a[1] * abs(factor)


def logarithm(a):
    """Returns ln of a number."""
    return math.log(a[0]), a[1] / a[0]


def relative_difference(values, reference, paired):
    """Returns the difference of two means over that of the reference, its standard error and degrees of freedom.

    values, reference    values by seed
    paired               True: only seeds of both are compared, because equal packings share most of the scatter
    """
    common = sorted(values.keys() & reference.keys())
    if paired and common:
        total, _ = estimate([reference[s] for s in common])
        return (*over(estimate([values[s] - reference[s] for s in common]), total), len(common) - 1)
    value, error = quotient(estimate(list(values.values())), estimate(list(reference.values())))
    return value - 1, error, min(len(values), len(reference)) - 1


def jackknife(function, count):
    """Returns function(indices) of all indices below `count`, and its standard error, by leaving out one at a time:

        error^2 = (n - 1) / n sum (f_k - mean f_k)^2    (Efron & Tibshirani 1993, eq. 11.5)

    Both are lists if the function returns several numbers.
    """
    everything = np.arange(count)
    parts = np.array([function(np.delete(everything, k)) for k in everything])
    errors = np.sqrt((count - 1) * parts.var(axis=0))
    return function(everything), errors.tolist()


def place_of_largest(places, numbers):
    """Returns the place whose number is largest, and its standard error, as propagated()."""
    return propagated(numbers, lambda values: float(places[int(np.argmax(values))]))


def propagated(numbers, function, draws=400):
    """Returns function([value, ...]) of independent numbers, and its standard error from normally distributed draws.

    Both are lists if the function returns several numbers.
    """
    generator = random.Random(1)
    drawn = np.array([function([generator.gauss(v, e) for v, e in numbers]) for _ in range(draws)])
    return function([v for v, _ in numbers]), drawn.std(axis=0, ddof=1).tolist()


def cross_fitted(values, controls, folds=10):
    """Returns values (n,) minus controls (n, m) times coefficients (m,), the control variates of mean zero.

    The coefficients of each fold are from a linear regression over the other folds, so that the mean has no bias.
    """
    values, controls = np.asarray(values, float), np.asarray(controls, float)
    fold = np.arange(len(values)) % folds
    found = np.empty_like(values)
    for k in range(folds):
        others, own = fold != k, fold == k
        centred = controls[others] - controls[others].mean(axis=0)
        coefficients = np.linalg.lstsq(centred, values[others] - values[others].mean(), rcond=None)[0]
        found[own] = values[own] - controls[own] @ coefficients
    return found


def variance_ratio(plain, controlled):
    """Returns the variance of `controlled` over that of `plain`, with its jackknife error.

    Each has a number, or a row of numbers, for each realisation.
    """
    plain, controlled = (np.asarray(rows, float).reshape(len(rows), -1) for rows in (plain, controlled))
    return jackknife(lambda chosen: controlled[chosen].var() / plain[chosen].var(), len(plain))


def propagated_lists(lists, function, draws=400):
    """Returns propagated() of a function of several lists of values."""
    ends = np.cumsum([len(numbers) for numbers in lists])[:-1]
    return propagated(
        [n for numbers in lists for n in numbers], lambda values: function(np.split(np.array(values), ends)), draws
    )
