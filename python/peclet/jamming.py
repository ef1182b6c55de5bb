"""Estimates the jamming point of curves of viscosity over volume fraction, and proposes further volume fractions.

These are the fits of `peclet jamming`, whose output jamming_report.py makes:

    points = [(0.56, 41.2, 0.8, 16), ...]     # volume fraction, viscosity > 0, its standard error > 0, number of seeds
    law = peclet.jamming.fit_law(points, flowing=0.62)
    print(law.phi_m, law.interval, law.exponent)

The law is fitted to ln eta by least squares:

    eta = A (1 - phi / phi_m)^-beta
    error of ln eta_i: s_i = c_i (standard error / mean)_i,    c^2 = (n - 1) / (n - 3)

eta is the viscosity, phi the volume fraction, phi_m the jamming point, A the prefactor, beta the exponent, n the number
of seeds. c^2 is the mean of Student's t squared with n - 1 degrees of freedom. It accounts for the uncertain spread of
a few seeds; without it chi^2 is too large and intervals are too narrow. Given phi_m the law is a line in
x_i = -ln(1 - phi_i / phi_m). ln A and beta then follow in closed form, and only phi_m is searched for (variable
projection: G. Golub and V. Pereyra, SIAM J. Numer. Anal. 10, 413, 1973).

The interval of phi_m is the range in which

    chi^2(phi_m) <= least chi^2 + z^2 max(1, least chi^2 / degrees of freedom)

with z = 1 for the standard error (half its width) and z = 1.96 for 95 %. A poor fit has wider intervals. The interval
is not symmetric: points far from jamming bound phi_m better from below than from above.
"""
import copy
import dataclasses
import json
import math

import numpy as np

Z_95 = 1.959963984540054  # half-width of a 95 % interval in standard errors
FEWEST_SEEDS = 4  # of a point; c is not finite for fewer
FEWEST_POINTS = 4  # of a fit
SMALLEST_GAP, GAPS = 1e-7, 400  # smallest phi_m - flowing that is tried, and the number of tries up to phi_m = 1
EXPONENTS = np.linspace(0.25, 6, 116)  # tried for a common exponent


class NotDetermined(Exception):
    """The points do not determine the jamming point or the exponent; the text says why."""


@dataclasses.dataclass
class Law:
    """A fitted law. Pairs are a number and its standard error, which is 0 for given numbers."""

    phi_m: tuple
    interval: tuple  # 95 % interval of phi_m
    exponent: tuple  # beta
    prefactor: tuple  # A
    chi_squared: float
    degrees: int  # degrees of freedom: points less parameters


@dataclasses.dataclass
class Line:
    """A least-squares fit of y = constant + slope x; a parameter that is not fitted is 0 with variance 0."""

    constant: float
    slope: float
    constant_variance: float
    slope_variance: float
    chi_squared: float


def weighted_line(x, y, weights, with_constant=True, with_slope=True):
    """Returns the Line fitted to each row of x (..., n), y (..., n) or (n,), with weights (n,), 1 / variance."""
    total = weights.sum()

    def mean(values):
        return (values @ weights / total)[..., None] if with_constant else 0.0

    x_mean, y_mean = mean(x), mean(y)
    dx, dy = x - x_mean, y - y_mean
    slope = slope_variance = constant = constant_variance = np.zeros(np.shape(x)[:-1])
    if with_slope:
        slope_variance = 1 / (dx * dx @ weights)
        slope = (dx * dy @ weights) * slope_variance
    if with_constant:
        constant = y_mean[..., 0] - slope * x_mean[..., 0]
        constant_variance = 1 / total + x_mean[..., 0] ** 2 * slope_variance
    left = dy - slope[..., None] * dx
    return Line(constant, slope, constant_variance, slope_variance, left * left @ weights)


def weights_of(points):
    """Returns the weights 1 / s_i^2 of points (fraction, viscosity, standard error, seeds), an array (n,)."""
    _, value, error, count = np.asarray(points, float).T
    return (count - 3) / (count - 1) / (error / value) ** 2


def lowest(function, low, high):
    """Returns place and value of the minimum, between low and high (rows,), of a function of arrays (rows, places)."""
    rows = np.arange(len(low))
    for _ in range(6):  # each round has a tenth of the width
        places = np.linspace(low, high, 21, axis=-1)
        values = function(places)
        at = np.argmin(values, axis=-1)
        low, high = places[rows, np.maximum(at - 1, 0)], places[rows, np.minimum(at + 1, 20)]
    return places[rows, at], values[rows, at]


def crossing(function, inside, outside, bound):
    """Returns the place, from `inside` to `outside`, at which a function of arrays first exceeds `bound`.

    The function must exceed the bound at `outside`.
    """
    for _ in range(8):  # each round has a twentieth of the width
        places = np.linspace(inside, outside, 21)
        beyond = np.argmax(function(places) > bound)
        inside, outside = places[max(beyond - 1, 0)], places[beyond]
    return float(inside)


class Fit:
    """chi^2 of one curve over the gap ln(phi_m - flowing), at the best prefactor and exponent. Arguments: fit_law()."""

    def __init__(self, points, flowing, unit_prefactor):
        self.fractions, values = np.asarray(points, float).T[:2]
        self.logarithms, self.weights = np.log(values), weights_of(points)
        self.flowing, self.unit_prefactor = flowing, unit_prefactor
        self.gaps = np.linspace(math.log(SMALLEST_GAP), math.log(1 - flowing), GAPS)

    def degrees(self, exponent):
        """Returns the degrees of freedom; `exponent` is None if it is fitted."""
        return len(self.fractions) - 3 + (exponent is not None) + self.unit_prefactor

    def line(self, jamming, exponent=None):
        """Returns the Line in x for each phi_m in `jamming`, with fitted or given exponents."""
        x = -np.log1p(-self.fractions / np.asarray(jamming)[..., None])
        if exponent is None:
            return weighted_line(x, self.logarithms, self.weights, not self.unit_prefactor)
        slope = np.asarray(exponent)
        line = weighted_line(x, self.logarithms - slope[..., None] * x, self.weights, not self.unit_prefactor, False)
        return dataclasses.replace(line, slope=slope)

    def chi_squared(self, gaps, exponents=None):
        """Returns the chi^2 at these gaps, with fitted or given exponents."""
        return self.line(self.flowing + np.exp(gaps), exponents).chi_squared

    def least(self, exponents=None):
        """Returns, for each exponent, chi^2 at all gaps, the best gap, and the minimum of chi^2.

        The minimum is infinity if it lies at the first gap, NaN if the points do not bound phi_m from above.
        """
        column = None if exponents is None else np.asarray(exponents)[:, None]
        of_gaps = np.atleast_2d(self.chi_squared(self.gaps, column))
        at = np.argmin(of_gaps, axis=1)
        ends = self.gaps[np.maximum(at - 1, 0)], self.gaps[np.minimum(at + 1, GAPS - 1)]
        best, least = lowest(lambda gaps: self.chi_squared(gaps, column), *ends)
        beyond = np.where(self.gaps > best[:, None], of_gaps, -np.inf).max(axis=1)
        degrees = self.degrees(exponents)
        is_bounded = (at < GAPS - 1) & (beyond > least + Z_95**2 * np.maximum(1, least / degrees))
        return of_gaps, best, np.where(at == 0, np.inf, np.where(is_bounded, least, np.nan))

    def crossing(self, of_gaps, best, direction, bound, exponent):
        """Returns the phi_m below (-1) or above (1) the best gap at which chi^2 exceeds the bound; else `flowing`."""
        places = np.flatnonzero((self.gaps - best) * direction > 0)[::direction]
        beyond = np.flatnonzero(of_gaps[places] > bound)
        if not len(beyond):
            return self.flowing
        outside = self.gaps[places[beyond[0]]]
        inside = self.gaps[places[beyond[0] - 1]] if beyond[0] > 0 else best
        return self.flowing + math.exp(crossing(lambda gaps: self.chi_squared(gaps, exponent), inside, outside, bound))

    def of_rows(self, logarithms, exponent=None):
        """Returns phi_m, beta, A and chi^2, arrays (rows,), fitted to other ln eta (rows, n) at the same fractions.

        A phi_m that is not bounded lies at an end of the search.
        """
        own = copy.copy(self)
        own.logarithms = logarithms[:, None, :]
        _, best, _ = own.least(None if exponent is None else [exponent])
        line = own.line((self.flowing + np.exp(best))[:, None], exponent)
        numbers = (line.slope, np.exp(line.constant), line.chi_squared)
        return self.flowing + np.exp(best), *(np.broadcast_to(one, (len(best), 1))[:, 0] for one in numbers)

    def law(self, exponent=None):
        """Returns the fitted Law. Raises NotDetermined."""
        of_gaps, best, chi = (found[0] for found in self.least(None if exponent is None else [exponent]))
        jamming = self.flowing + math.exp(best)
        line = self.line(jamming, exponent)
        if chi == math.inf:
            raise NotDetermined(
                "the points rise more steeply than any power law that diverges above "
                f"{self.flowing:.6g}, which flows"
            )
        if not line.slope > 0:
            raise NotDetermined("the viscosity does not rise with the fraction")
        if math.isnan(chi):
            raise NotDetermined(
                "the points do not bound it from above: points nearer to jamming, or smaller errors, would"
            )
        degrees = self.degrees(exponent)
        scale = max(1.0, chi / degrees)
        low, high, below, above = (
            self.crossing(of_gaps, best, direction, chi + z * z * scale, exponent)
            for z in (Z_95, 1)
            for direction in (-1, 1)
        )
        error = (above - below) / 2
        # Variance of another parameter p: var(p) = var(p given phi_m) + (d p / d phi_m)^2 var(phi_m).
        step = 1e-3 * (jamming - self.flowing)
        nearer, farther = self.line(jamming - step, exponent), self.line(jamming + step, exponent)

        def whole(own, change):
            return math.sqrt(own * scale + (change / (2 * step) * error) ** 2)

        factor = math.exp(line.constant)
        exponent_error = whole(line.slope_variance, farther.slope - nearer.slope)
        factor_error = factor * whole(line.constant_variance, farther.constant - nearer.constant)
        pairs = (float(line.slope), exponent_error), (factor, factor_error)
        return Law((jamming, error), (low, high), *pairs, float(chi), degrees)


def fit_law(points, flowing, exponent=None, unit_prefactor=False):
    """Returns the Law fitted to one curve.

    points            sequence of (volume fraction, viscosity > 0, standard error > 0, number of seeds > 3)
    flowing           largest volume fraction that is known to flow; phi_m is searched for from there to 1
    exponent          beta; None: fitted
    unit_prefactor    True: A = 1; False: fitted

    Raises NotDetermined.
    """
    if len(points) < FEWEST_POINTS:
        raise NotDetermined(f"{len(points)} of the {FEWEST_POINTS} points that a fit needs")
    return Fit(points, flowing, unit_prefactor).law(exponent)


@dataclasses.dataclass
class CommonExponent:
    """An exponent that several curves share."""

    exponent: tuple  # beta and its standard error
    curves: int  # their number
    chi_squared: float
    degrees: int


def find_common_exponent(curves, unit_prefactor):
    """Returns the CommonExponent of curves (points, flowing).

    beta minimises the sum over the curves of their least chi^2. Its standard error is half the width of the range in
    which the sum is at most its least value plus max(1, chi^2 / degrees). Curves that no exponent describes are left
    out. Raises NotDetermined.
    """
    fits = [Fit(points, flowing, unit_prefactor) for points, flowing in curves]

    def least(fit, exponents):
        chi = fit.least(exponents)[2]
        return np.where(np.isnan(chi), np.inf, chi)

    of_curves = [(fit, least(fit, EXPONENTS)) for fit in fits]
    of_curves = [(fit, chi) for fit, chi in of_curves if np.isfinite(chi).any()]
    fits, sums = [fit for fit, _ in of_curves], sum(chi for _, chi in of_curves)
    at, last = int(np.argmin(sums)), len(EXPONENTS) - 1
    if len(fits) < 2 or at in (0, last) or sums[at] == math.inf:
        ends = f"{EXPONENTS[0]:g} to {EXPONENTS[-1]:g}"
        raise NotDetermined(f"no exponent from {ends} describes two curves or more together")

    def chi_squared(exponents):
        return sum(least(fit, np.ravel(exponents)) for fit in fits).reshape(np.shape(exponents))

    best, chi = (float(found[0]) for found in lowest(chi_squared, EXPONENTS[[at - 1]], EXPONENTS[[at + 1]]))
    degrees = sum(fit.degrees(best) for fit in fits) - 1
    bound = chi + max(1.0, chi / degrees)
    if min(sums[0], sums[-1]) <= bound:
        raise NotDetermined(
            "the points do not bound the common exponent: smaller errors, or points nearer to jamming, would"
        )
    below, above = (crossing(chi_squared, best, end, bound) for end in EXPONENTS[[0, -1]])
    return CommonExponent((best, (above - below) / 2), len(fits), chi, degrees)


def law_with(points, flowing, common, unit_prefactor):
    """Returns the Law of a curve at the common exponent.

    The errors of phi_m and the prefactor include that of the exponent, added in quadrature: from the laws at the
    exponent plus and minus its error, or from one of these if the other does not exist. Raises NotDetermined.
    """
    value, error = common.exponent
    laws = []
    for exponent in (value - error, value, value + error):
        try:
            laws.append(fit_law(points, flowing, exponent, unit_prefactor))
        except NotDetermined:
            if exponent == value:
                raise
            laws.append(None)
    below, law, above = laws
    if not below and not above:
        raise NotDetermined("the error of the common exponent leaves it without a law")
    sides = 2 if below and above else 1

    def moved(pair):
        return (getattr(above or law, pair)[0] - getattr(below or law, pair)[0]) / sides

    fraction, (low, high), shift = law.phi_m[0], law.interval, Z_95 * moved("phi_m")
    interval = max(flowing, fraction - math.hypot(fraction - low, shift)), fraction + math.hypot(high - fraction, shift)
    pairs = {
        name: (getattr(law, name)[0], math.hypot(getattr(law, name)[1], moved(name))) for name in ("phi_m", "prefactor")
    }
    return dataclasses.replace(law, interval=interval, exponent=common.exponent, **pairs)


def fit_common_law(curves, unit_prefactor=False):
    """Fits laws with one exponent to several curves.

    curves            sequence of (points, flowing), each as for fit_law()
    unit_prefactor    True: A = 1 for all; False: fitted for each

    Returns the CommonExponent, and a list with the Law of each curve. A NotDetermined, which says why, stands in the
    place of each that is not determined.
    """
    try:
        common = find_common_exponent(curves, unit_prefactor)
    except NotDetermined as why:
        return why, [why] * len(curves)
    return common, [or_why(law_with, points, flowing, common, unit_prefactor) for points, flowing in curves]


def or_why(function, *arguments):
    """Returns the value of function(*arguments), or the NotDetermined that it raises."""
    try:
        return function(*arguments)
    except NotDetermined as why:
        return why


def is_found(answer):
    """Returns False for a NotDetermined."""
    return not isinstance(answer, NotDetermined)


@dataclasses.dataclass
class Steepest:
    """The jamming point by the steepest rise of a curve."""

    phi_m: tuple  # middle of the interval with the largest slope, and its standard error
    width: float  # of that interval
    to_jammed: bool = False  # it lies between the last point that flows and the first one that is jammed


def find_steepest(points, jammed=None, seed=1, draws=2000):
    """Returns the Steepest rise of a curve: the interval of neighbouring fractions with the largest slope.

    points    as for fit_law(), in ascending order
    jammed    smallest volume fraction that is known to be jammed, or None
    seed      of the random numbers
    draws     number of curves that are drawn

    phi_m is the middle of the interval. Its error has a part of the grid and a part of the values:

        error^2 = width^2 / 12 + mean of (middle* - middle)^2

    middle* belongs to a curve whose values are drawn with their standard errors. If the slope is largest in the last
    interval, the curve may rise further: phi_m then lies between the last fraction and `jammed`. Raises NotDetermined
    if `jammed` is absent then, or with fewer than 3 points.
    """
    if len(points) < 3:
        raise NotDetermined(f"{len(points)} of the 3 points that it needs")
    fractions, values, errors = np.asarray(points, float).T[:3]
    widths, middles = np.diff(fractions), (fractions[1:] + fractions[:-1]) / 2
    best = int(np.argmax(np.diff(values) / widths))
    if best + 1 < len(widths):
        drawn = values + errors * np.random.default_rng(seed).standard_normal((draws, len(values)))
        moved = middles[np.argmax(np.diff(drawn) / widths, axis=1)] - middles[best]
        error = math.sqrt(widths[best] ** 2 / 12 + np.mean(moved**2))
        return Steepest((float(middles[best]), error), float(widths[best]))
    last = float(fractions[-1])
    if jammed is None or jammed <= last:
        raise NotDetermined("the viscosity rises most steeply up to the last point")
    return Steepest(((last + jammed) / 2, (jammed - last) / math.sqrt(12)), jammed - last, True)


# Curves in the form of the program: {"name", "settings", "points": [{"fraction", "state", "mean", ...}]}.


def law_point(point):
    """Returns a point of the program as fit_law() needs it."""
    return point["fraction"], point["mean"], point["standard_error"], point["count"]


def has_error(point):
    """Returns True if the point can be part of a fit."""
    return point["count"] >= FEWEST_SEEDS and (point["mean"] or 0) > 0 and (point["standard_error"] or 0) > 0


WHY_LEFT_OUT = {
    "soft": "soft, a larger normal_stiffness makes spheres harder",
    "partly jammed": "some seeds jammed and the mean is of those that happened to flow",
    "lost": "half of the seeds or more were lost, for other reasons than jamming",
    "suspect": "suspect, a seed gave two different results",
    "open": "no seed has ended yet",
}


def why_left_out(point):
    """Returns why a point is left out of the law, and a detail. Returns None for fitted and for jammed points."""
    state = point["state"]
    if state == "flowing" and not has_error(point):
        return f"no error yet, {FEWEST_SEEDS} seeds with a value are needed", str(point["count"])
    if state == "soft":
        mean, largest = point["overlap"], point["largest_overlap"]
        return WHY_LEFT_OUT[state], f"overlap {mean:.2g}" if mean is not None else f"overlap {largest:.2g} at most"
    if state == "partly jammed":
        return WHY_LEFT_OUT[state], f"{point['jammed']} of {point['seeds']}"
    return (WHY_LEFT_OUT[state], "") if state in WHY_LEFT_OUT else None


class Estimate:
    """The jamming point of a curve of the program. The law is fitted to flowing points with a viscosity over `above`.

    `law` is a Law and `steepest` a Steepest, or each a NotDetermined. `remarks` are pairs: a text that is the same for
    every curve, and the point.
    """

    def __init__(self, curve, above):
        self.name, self.settings, self.points = curve["name"], curve["settings"], curve["points"]
        flowing = [point for point in self.points if point["state"] == "flowing"]
        self.flowing = len(flowing)
        self.largest_flowing = flowing[-1]["fraction"] if flowing else None
        beyond = self.largest_flowing or 0
        stuck = (p for p in self.points if p["state"] in ("jammed", "soft") and p["fraction"] > beyond)
        self.smallest_stuck = next(stuck, None)
        self.fitted = [law_point(p) for p in flowing if has_error(p) and p["mean"] > above]
        self.remarks = []
        for point in self.points:
            if why := why_left_out(point):
                detail = f" ({why[1]})" if why[1] else ""
                self.remarks.append(("left out, " + why[0], f"{point['fraction']:.6g}{detail}"))
        measured = [law_point(p) for p in self.points if has_error(p) and p["state"] in ("flowing", "soft")]
        self.steepest = or_why(find_steepest, measured, self.jammed_at())
        self.law = NotDetermined(
            f"{len(self.fitted)} of the {FEWEST_POINTS} flowing points with a viscosity above {above:g} that it needs"
        )

    def jammed_at(self):
        """Returns the smallest fraction beyond the flowing ones, if it is jammed; else None."""
        stuck = self.smallest_stuck
        return stuck["fraction"] if stuck and stuck["state"] == "jammed" else None

    def has_enough_points(self):
        return len(self.fitted) >= FEWEST_POINTS

    def add_contradictions(self):
        """Adds remarks about jammed points that contradict flowing ones or the law, and about a poor fit."""
        stuck = self.smallest_stuck["fraction"] if self.smallest_stuck else math.inf
        for point in self.points:
            if point["state"] == "jammed" and point["fraction"] < stuck:
                place = f"{point['fraction']:.6g} (below {self.largest_flowing or 0:.6g})"
                self.remarks.append(("jammed, although a larger fraction flows", place))
        if not is_found(self.law):
            return
        jammed, poor = self.jammed_at(), 3
        if jammed is not None and self.law.interval[0] > jammed:
            self.remarks.append(("the law diverges above a fraction that is jammed", f"{jammed:.6g}"))
        if self.law.chi_squared > poor * self.law.degrees:
            what = "the law does not describe the points, so its errors are made wider by the root of chi^2 per degree"
            self.remarks.append((what, ""))


def estimate_all(curves, above=10, exponent=None, unit_prefactor=False, common_exponent=False):
    """Estimates the jamming points of several curves.

    curves             as from the program
    above              the law is fitted to flowing points with a larger viscosity than this
    exponent           beta; None: fitted
    unit_prefactor     True: A = 1
    common_exponent    True: one exponent is fitted to all curves

    Returns a list of Estimates, and the CommonExponent or a NotDetermined (None if not asked for). The steepest rise is
    that of all points with an error.
    """
    made, common = [Estimate(curve, above) for curve in curves], None
    enough = [one for one in made if one.has_enough_points()]
    if common_exponent:
        common, laws = fit_common_law([(one.fitted, one.largest_flowing) for one in enough], unit_prefactor)
    else:
        laws = [or_why(fit_law, one.fitted, one.largest_flowing, exponent, unit_prefactor) for one in enough]
    for one, law in zip(enough, laws):
        one.law = law
    for one in made:
        one.add_contradictions()
    return made, common


FINEST = 1e-4  # resolution of proposed fractions
NEAREST = 0.0015  # smallest distance of a fraction proposed for the law from other points
MOST_POINTS = 20  # of one proposal


class Neighbours:
    """The volume fractions of a curve, and those that have been proposed."""

    def __init__(self, estimate, proposed):
        self.taken = np.sort([*proposed, *(point["fraction"] for point in estimate.points)])

    def is_free(self, fraction, distance):
        """Returns True if the fraction is in (0, 1) and at least `distance` from all others."""
        return 0 < fraction < 1 and not (abs(self.taken - fraction) < distance).any()

    def widest_gap(self, low, high, least):
        """Returns the middle of the widest gap, of `least` or more, between neighbours in [low, high], or None."""
        found = None
        for left, right in zip(self.taken, self.taken[1:]):
            if left >= low - FINEST and right <= high + FINEST and right - left >= least:
                found, least = (left + right) / 2, (right - left) * (1 + 1e-9)
        return found


def best_of_law(estimate, exponent, unit_prefactor, proposed):
    """Returns the volume fraction at which another point makes the error of phi_m smallest, and why.

        var(phi_m) = 1 / sum_i w_i (g_i - fit of g_i by the law's other columns)^2
        g = d ln eta / d phi_m = -beta phi / (phi_m (phi_m - phi))

    The new point has the median weight of the fitted ones. Fractions are at most two errors below phi_m, and at most
    half-way from the flowing ones to phi_m, because nearer to it a small system may jam. Returns None if no fraction
    reduces the error.
    """
    law, stuck = estimate.law, estimate.smallest_stuck
    jamming, error = law.phi_m
    last = min(jamming - 2 * error, (estimate.largest_flowing + jamming) / 2)
    if stuck:
        last = min(last, stuck["fraction"] - NEAREST)
    own = weights_of(estimate.fitted)
    usual = np.sort(own)[len(own) // 2]
    known = [*(point[0] for point in estimate.fitted), *(phi for phi in proposed if phi <= last)]

    def error_with(fractions):
        phi = np.array(fractions)
        weights = np.concatenate([own, np.full(len(phi) - len(own), usual)])
        x, g = -np.log1p(-phi / jamming), -law.exponent[0] * phi / (jamming * (jamming - phi))
        return 1 / math.sqrt(weighted_line(x, g, weights, not unit_prefactor, exponent is None).chi_squared)

    neighbours, now, best = Neighbours(estimate, proposed), error_with(known), None
    least, phi = now, estimate.fitted[0][0]
    while phi <= last:
        rounded = round(phi / FINEST) * FINEST
        if neighbours.is_free(rounded, NEAREST) and (then := error_with([*known, rounded])) < least:
            least, best = then, float(f"{phi:.4f}")
        phi += 0.001
    share = 100 * least / now
    return best and (best, f"lessens the error of the law's phi_m most, to {share:.0f} % of it")


def bisection(estimate, proposed):
    """Returns a volume fraction by bisection, and why; None if it is taken.

    It is half-way between the largest flowing fraction and the smallest one that does not flow. If these are near each
    other, it is in the widest gap of flowing fractions. If all flow, it is beyond the last one; if none flows, below
    the first one.
    """
    fine_grid, stride = 0.005, 0.02
    neighbours = Neighbours(estimate, proposed)
    flowing, stuck = estimate.largest_flowing, estimate.smallest_stuck
    middle = reason = None
    if flowing is not None and stuck:
        middle = neighbours.widest_gap(flowing, stuck["fraction"], fine_grid)
        reason = f"half-way between {flowing:.6g}, which flows, and {stuck['fraction']:.6g}, which is {stuck['state']}"
    elif flowing is not None:
        middle = max([flowing, *proposed]) + stride
        reason = f"beyond {flowing:.6g}, up to which all flows"
    else:
        middle = min([stuck["fraction"] if stuck else 0, *proposed]) - stride
        reason = "below all that is known, as nothing flows yet"
    if middle is None and estimate.fitted:
        middle = neighbours.widest_gap(estimate.fitted[0][0], flowing, fine_grid)
        reason = "in the widest gap of what flows near jamming"
    if middle is None or not neighbours.is_free(middle, FINEST / 2):
        return None
    return float(f"{middle:.4f}"), reason


def next_fraction(estimate, proposed=(), exponent=None, unit_prefactor=False):
    """Returns the next volume fraction of an Estimate, and why, or None.

    proposed    fractions that have been proposed for any curve
    exponent, unit_prefactor    as for fit_law()
    """
    of_law = best_of_law(estimate, exponent, unit_prefactor, proposed) if is_found(estimate.law) else None
    return of_law or bisection(estimate, proposed)


def propose(estimates, budget=None, exponent=None, unit_prefactor=False):
    """Proposes volume fractions for further points, taking the curves in turn.

    estimates    list of Estimates
    budget       processor time [s] to be spent; None: one fraction for each curve
    exponent, unit_prefactor    as for fit_law()

    Returns a list of (fraction, reason); the cost of one fraction at all curves [s], taken from the most expensive
    point of each; and why there are no fractions, or "".
    """
    cost = sum(max((point["cpu_seconds"] for point in one.points), default=0) for one in estimates)
    most = len(estimates)
    if budget is not None:
        most = math.floor(budget / cost) if cost > 0 else 1
        if most == 0:
            return (
                [],
                cost,
                f"a point takes some {cost:.3g} s of processor time, as the dearest one did: more than the budget",
            )
    made, is_any = [], True
    while is_any and len(made) < min(most, MOST_POINTS):
        is_any = False
        for one in estimates[: min(most, MOST_POINTS) - len(made)]:
            if found := next_fraction(one, [fraction for fraction, _ in made], exponent, unit_prefactor):
                is_any = True
                made.append((found[0], f"{one.name}: {found[1]}" if one.name else found[1]))
    return made, cost, "" if made else "no fraction would reduce the error of phi_m: more seeds would"


class Refused(Exception):
    """An entry of the campaign file cannot be used: its JSON pointer, its value, and the rule that it breaks."""


def added_to_sweep(sweep, over, fractions):
    """Adds volume fractions to a sweep.

    sweep        list of entries of a campaign file, with lists in the place of ranges
    over         JSON pointer of the volume fraction
    fractions    list of numbers

    Returns the JSON patch (RFC 6902) and the changed sweep. Raises Refused if no entry sets `over`, or if an entry sets
    it in step with other keys, whose values at new fractions are unknown.
    """
    for place, entry in enumerate(sweep):
        pointers = entry["set"] if isinstance(entry["set"], list) else [entry["set"]]
        if over not in pointers:
            continue
        if len(pointers) > 1:
            rule = "sets the fraction in step with others, whose values at new fractions are yours to choose: add the"
            raise Refused(f"/sweep/{place}/set", json.dumps(pointers, separators=(",", ":")), rule + " rows by hand")
        rows = [[fraction] if isinstance(entry["set"], list) else fraction for fraction in fractions]
        changed = {**entry, "values": [*entry["values"], *rows]}
        patch = [{"op": "replace", "path": f"/sweep/{place}/values", "value": changed["values"]}]
        return patch, [*sweep[:place], changed, *sweep[place + 1 :]]
    raise Refused("/sweep", over, "is set by no entry")
