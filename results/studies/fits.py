"""Fits lines and curves to numbers with errors."""
import math

import numpy as np
from scipy.optimize import curve_fit

from studies.estimates import jackknife, propagated
from studies.tables import number


def line_through(x, y, errors):
    """Returns intercept, slope and the slope's standard error of a least-squares line with weights 1 / error^2."""
    coefficients, covariance = np.polyfit(x, y, 1, w=1 / np.asarray(errors, float), cov="unscaled")
    slope, intercept = coefficients.tolist()
    return intercept, slope, math.sqrt(covariance[0, 0])


def multiples(shapes, values):
    """Returns, for each row of `shapes`, the factor c of least squares in c * shape = values, and the residual sum of
    squares."""
    factors = shapes @ values / np.square(shapes).sum(axis=1)
    return factors, np.square(factors[:, None] * shapes - values).sum(axis=1)


def lines(shapes, values):
    """Returns, for each row of `shapes`, constant and slope of least squares in constant + slope * shape = values, and
    the residual sum of squares."""
    values = np.asarray(values, float)
    centred = shapes - shapes.mean(axis=1, keepdims=True)
    slopes, left = multiples(centred, values - values.mean())
    return values.mean() - slopes * shapes.mean(axis=1), slopes, left


def shapes_of(fractions):
    """Returns trial values of phi_J (400,), and -ln(1 - phi / phi_J), a row for each."""
    jammed = max(fractions) + 0.0005 * np.arange(1, 401)
    return jammed, -np.log(1 - np.asarray(fractions) / jammed[:, None])


def jammed_and_exponent(fractions, values):
    """Returns phi_J and lambda of (1 - phi / phi_J)^-lambda, fitted to the logarithm with equal weights.

    phi_J is found by a search in steps of 0.0005; lambda is the linear coefficient.
    """
    jammed, shapes = shapes_of(fractions)
    exponents, left = multiples(shapes, np.log(np.maximum(values, 1e-9)))
    best = np.argmin(left)
    return float(jammed[best]), float(exponents[best])


def fit_with_error(rows, quantity, function=jammed_and_exponent):
    """Returns, for both numbers of the fit: value, standard error, its part from the viscosities, and its part from
    leaving out one volume fraction at a time, added in quadrature."""
    fractions, numbers = np.array([r["fraction"] for r in rows]), [number(r, quantity) for r in rows]
    values = np.array([v for v, _ in numbers])
    whole, by_fractions = jackknife(lambda chosen: function(fractions[chosen], values[chosen]), len(rows))
    _, by_seeds = propagated(numbers, lambda drawn: function(fractions, drawn), 100)
    return [(value, math.hypot(a, b), a, b) for value, a, b in zip(whole, by_seeds, by_fractions)]


def log_minimum(abscissae, values):
    """Returns log10 of the place of the minimum of a positive curve.

    It is the vertex of the parabola through the lowest point and its neighbours, in logarithms. If the lowest point is
    at an end, it is that point.
    """
    x, y = np.log10(abscissae), np.log(np.maximum(values, 1e-9))
    lowest = int(np.argmin(values))
    if lowest in (0, len(x) - 1):
        return float(x[lowest])
    (left, right), ends = (
        np.diff(y[lowest - 1 : lowest + 2]) / np.diff(x[lowest - 1 : lowest + 2]),
        x[[lowest - 1, lowest + 1]],
    )
    return float((ends[0] + x[lowest]) / 2 - left * (ends[1] - ends[0]) / 2 / (right - left))


def log_of_rise(abscissae, values, rise):
    """Returns log10 of the place at which the logarithm of a curve has risen by `rise` above its lowest point.

    Logarithms are interpolated linearly. If the rise is not reached, returns the last point.
    """
    x, logs = np.log10(np.maximum(abscissae, 1e-9)), np.log(np.maximum(values, 1e-9))
    lowest = int(np.argmin(logs))
    level = logs[lowest] + rise
    for k in range(lowest, len(logs) - 1):
        if logs[k] <= level < logs[k + 1]:
            return float(x[k] + (level - logs[k]) / (logs[k + 1] - logs[k]) * (x[k + 1] - x[k]))
    return float(x[-1])


def log_of_share(abscissae, values, share):
    """Returns log10 of the place at which a curve has risen by `share` of ln(last / lowest) above its lowest point."""
    lowest, last = (max(value, 1e-9) for value in (min(values), values[-1]))
    return log_of_rise(abscissae, values, share * math.log(last / lowest))


def thickening_decades(abscissae, values, share):
    """Returns the decades from the lowest point of a curve to this share of its rise in logarithms."""
    return log_of_share(abscissae, values, share) - log_minimum(abscissae, values)


def decades_of_rise(abscissae, values):
    """Returns the decades in which a curve makes the middle four fifths of its rise, from a tenth of it to nine tenths,
    in logarithms."""
    return log_of_share(abscissae, values, 0.9) - log_of_share(abscissae, values, 0.1)


def divergence(fractions, numbers, start):
    """Returns c, phi_J and lambda of c (1 - phi / phi_J)^-lambda, each with its standard error.

    Least squares in the logarithm with weights 1 / (relative error)^2, starting from `start`. Errors are multiplied by
    the root of chi^2 per degree of freedom if that is above 1, where the form does not describe the numbers.
    """
    fractions, (values, errors) = np.asarray(fractions, float), np.transpose(numbers)

    def logarithm(fraction, factor, jammed, exponent):
        return factor - exponent * np.log1p(-fraction / jammed)

    weights = errors / values
    guess = (math.log(start[0]), max(start[1], fractions.max() + 0.005), start[2])
    bounds = (-np.inf, fractions.max() + 1e-6, 0), (np.inf, 1, np.inf)
    found, covariance = curve_fit(
        logarithm, fractions, np.log(values), guess, weights, absolute_sigma=True, bounds=bounds
    )
    left = np.square((np.log(values) - logarithm(fractions, *found)) / weights).sum() / max(len(values) - 3, 1)
    wide = np.sqrt(np.diag(covariance) * max(left, 1))
    factor = math.exp(found[0])
    return (factor, float(factor * wide[0])), (float(found[1]), float(wide[1])), (float(found[2]), float(wide[2]))
