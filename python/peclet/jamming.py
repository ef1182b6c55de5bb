"""The jamming point of curves of viscosity over volume fraction, and which volume fractions would tell more.

The fits of `peclet jamming` (jamming_report.py beside this file says what it prints):

    points = [(0.56, 41.2, 0.8, 16), ...]     # volume fraction, viscosity > 0, its standard error > 0, number of seeds
    law = peclet.jamming.fit_law(points, flowing=0.62)
    print(law.phi_m, law.interval, law.exponent)

The law is eta = A (1 - phi / phi_m)^-beta, fitted by least squares in ln eta with the errors s_i = (standard error /
mean)_i c_i. c^2 = (n - 1) / (n - 3) is the mean of Student's t squared with n - 1 degrees of freedom: the spread of a
few seeds is itself uncertain, and without c the weights of points whose spread came out small by luck make chi^2 too
large and intervals too narrow. Given phi_m the law is a line in x_i = -ln(1 - phi_i / phi_m), so that ln A and beta
follow in closed form and only phi_m is searched for (variable projection: G. Golub and V. Pereyra, SIAM J. Numer. Anal.
10, 413, 1973).

The interval of phi_m is where chi^2(phi_m) <= least chi^2 + z^2 max(1, chi^2 / degrees), z = 1 for the standard error
(half the width) and 1.96 for 95 %: a law that does not describe the points has wider ones. It is not symmetric: far
points hold phi_m from below better than from above.
"""
import dataclasses
import json
import math

import numpy as np

Z_95 = 1.959963984540054  # standard errors to either end of an interval of 95 %
FEWEST_SEEDS = 4  # of a point: c is not finite for fewer
FEWEST_POINTS = 4  # of a fit
SMALLEST_GAP, GAPS = 1e-7, 400  # between phi_m and the largest fraction that flows; phi_m is below 1
EXPONENTS = np.linspace(0.25, 6, 116)  # among which a common one is searched for


class NotDetermined(Exception):
    """Why there is no jamming point, or no exponent."""


@dataclasses.dataclass
class Law:
    """Pairs are a number and its standard error, which is 0 of what was given."""

    phi_m: tuple
    interval: tuple  # of 95 %
    exponent: tuple  # beta
    prefactor: tuple  # A
    chi_squared: float
    degrees: int  # of freedom: points less parameters


@dataclasses.dataclass
class Line:
    """Least squares of y = constant + slope x; what is not fitted is 0 with the variance 0."""

    constant: float
    slope: float
    constant_variance: float
    slope_variance: float
    chi_squared: float


def weighted_line(x, y, weights, with_constant=True, with_slope=True):
    """The line through the points of the last axis, for each row of x. Requires as many points as parameters."""
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
    """1 / s_i^2 of each point."""
    _, value, error, count = np.asarray(points, float).T
    return (count - 3) / (count - 1) / (error / value) ** 2


def lowest(function, low, high):
    """Where a function of rows of places is smallest between `low` and `high`, and its value there, for each row."""
    rows = np.arange(len(low))
    for _ in range(6):  # each a tenth as wide
        places = np.linspace(low, high, 21, axis=-1)
        values = function(places)
        at = np.argmin(values, axis=-1)
        low, high = places[rows, np.maximum(at - 1, 0)], places[rows, np.minimum(at + 1, 20)]
    return places[rows, at], values[rows, at]


def crossing(function, inside, outside, bound):
    """The last place before the first one, on the way from `inside` to `outside`, at which the function of places is
    more than the bound. Requires that it is at `outside`."""
    for _ in range(8):  # each a twentieth as wide
        places = np.linspace(inside, outside, 21)
        beyond = np.argmax(function(places) > bound)
        inside, outside = places[max(beyond - 1, 0)], places[beyond]
    return float(inside)


class Fit:
    """chi^2 over ln(phi_m - flowing), at the best prefactor and, unless exponents are given, at the best exponent."""

    def __init__(self, points, flowing, unit_prefactor):
        self.fractions, values = np.asarray(points, float).T[:2]
        self.logarithms, self.weights = np.log(values), weights_of(points)
        self.flowing, self.unit_prefactor = flowing, unit_prefactor
        self.gaps = np.linspace(math.log(SMALLEST_GAP), math.log(1 - flowing), GAPS)

    def degrees(self, exponent):
        return len(self.fractions) - 3 + (exponent is not None) + self.unit_prefactor

    def line(self, jamming, exponent=None):
        x = -np.log1p(-self.fractions / np.asarray(jamming)[..., None])
        if exponent is None:
            return weighted_line(x, self.logarithms, self.weights, not self.unit_prefactor)
        slope = np.asarray(exponent)
        line = weighted_line(x, self.logarithms - slope[..., None] * x, self.weights, not self.unit_prefactor, False)
        return dataclasses.replace(line, slope=slope)

    def chi_squared(self, gaps, exponents=None):
        return self.line(self.flowing + np.exp(gaps), exponents).chi_squared

    def least(self, exponents=None):
        """For each exponent chi^2 at all gaps, the gap at which it is smallest, and its value there; infinite where
        that is the first gap, and NaN where chi^2 has no bound above it."""
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
        """The fraction at which chi^2 first exceeds the bound on the way from the best gap; else `flowing`."""
        places = np.flatnonzero((self.gaps - best) * direction > 0)[::direction]
        beyond = np.flatnonzero(of_gaps[places] > bound)
        if not len(beyond):
            return self.flowing
        outside = self.gaps[places[beyond[0]]]
        inside = self.gaps[places[beyond[0] - 1]] if beyond[0] > 0 else best
        return self.flowing + math.exp(crossing(lambda gaps: self.chi_squared(gaps, exponent), inside, outside, bound))

    def law(self, exponent=None):
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
        # How the line turns with phi_m: var = var given phi_m + (d / d phi_m)^2 var of phi_m.
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
    """The Law through points (fraction, viscosity, standard error, seeds). `flowing`: the largest fraction of which it
    is known that it flows; phi_m is searched for from there to 1. Throws NotDetermined."""
    if len(points) < FEWEST_POINTS:
        raise NotDetermined(f"{len(points)} of the {FEWEST_POINTS} points that a fit needs")
    return Fit(points, flowing, unit_prefactor).law(exponent)


@dataclasses.dataclass
class CommonExponent:
    exponent: tuple
    curves: int  # that it is of
    chi_squared: float
    degrees: int


def find_common_exponent(curves, unit_prefactor):
    """The CommonExponent: beta is where the sum over the curves of their least chi^2 is smallest. Its standard error is
    half the width of the range in which the sum is at most its least value plus max(1, chi^2 / degrees). Curves that no
    exponent describes take no part."""
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
    """The law of a curve at the common exponent. What phi_m and prefactor owe to the error of the exponent is added in
    quadrature, by how they move with it; where one side of it has no law, by the other side."""
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
    """Of curves (points, flowing), each as for fit_law(): the CommonExponent, or the NotDetermined that says why there
    is none; and for each curve its Law, or such a reason."""
    try:
        common = find_common_exponent(curves, unit_prefactor)
    except NotDetermined as why:
        return why, [why] * len(curves)
    return common, [or_why(law_with, points, flowing, common, unit_prefactor) for points, flowing in curves]


def or_why(function, *arguments):
    """What the function returns, or the NotDetermined that it throws."""
    try:
        return function(*arguments)
    except NotDetermined as why:
        return why


def is_found(answer):
    return not isinstance(answer, NotDetermined)


@dataclasses.dataclass
class Steepest:
    phi_m: tuple  # middle of the interval of the grid where the slope is largest, and its standard error
    width: float  # of that interval
    to_jammed: bool = False  # it lies between the last point that flows and the first one that is jammed


def find_steepest(points, jammed=None, seed=1, draws=2000):
    """The interval of neighbouring fractions in which Delta eta / Delta phi is largest, of points as for fit_law() in
    ascending order. Its error has two parts,
        error^2 = width^2 / 12 + mean of (middle* - middle)^2,
    the grid's and that of the values: middle* is of curves whose values are drawn again with their standard errors, by
    random numbers that follow from `seed`. Where the slope is largest in the last interval the curve may go on to rise:
    then phi_m lies between the last fraction and `jammed`, the smallest one that is jammed, or is not determined."""
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


# Curves as the program gives them: {"name", "settings", "points": [{"fraction", "state", "mean", ...}]}.


def law_point(point):
    return point["fraction"], point["mean"], point["standard_error"], point["count"]


def has_error(point):
    """Whether the point can enter a fit."""
    return point["count"] >= FEWEST_SEEDS and (point["mean"] or 0) > 0 and (point["standard_error"] or 0) > 0


WHY_LEFT_OUT = {
    "soft": "soft, a larger normal_stiffness makes spheres harder",
    "partly jammed": "some seeds jammed and the mean is of those that happened to flow",
    "lost": "half of the seeds or more were lost, for other reasons than jamming",
    "suspect": "suspect, a seed gave two different results",
    "open": "no seed has ended yet",
}


def why_left_out(point):
    """Why a point is no part of the law, and a detail; None if it is one, or is jammed, which the table says."""
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
    """The jamming point of a curve by both definitions, what went into them, and `remarks`: pairs of what is said, in
    the same words for every curve, and of which point."""

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
        stuck = self.smallest_stuck
        return stuck["fraction"] if stuck and stuck["state"] == "jammed" else None

    def has_enough_points(self):
        return len(self.fitted) >= FEWEST_POINTS

    def add_contradictions(self):
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
    """An Estimate of each curve, and the CommonExponent, or why there is none; None unless it is asked for. The law is
    of flowing points whose viscosity is more than `above`, the steepest rise of all with an error."""
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


FINEST = 1e-4  # decimals of a proposed fraction
NEAREST = 0.0015  # distance of one for the law to a point of the campaign
MOST_POINTS = 20


class Neighbours:
    """The fractions of a curve and those that have been proposed."""

    def __init__(self, estimate, proposed):
        self.taken = np.sort([*proposed, *(point["fraction"] for point in estimate.points)])

    def is_free(self, fraction, distance):
        return 0 < fraction < 1 and not (abs(self.taken - fraction) < distance).any()

    def widest_gap(self, low, high, least):
        """The middle of the widest gap between neighbours from `low` to `high`; None if all are below `least`."""
        found = None
        for left, right in zip(self.taken, self.taken[1:]):
            if left >= low - FINEST and right <= high + FINEST and right - left >= least:
                found, least = (left + right) / 2, (right - left) * (1 + 1e-9)
        return found


def best_of_law(estimate, exponent, unit_prefactor, proposed):
    """The fraction that makes the error of phi_m smallest,
        var(phi_m) = 1 / sum_i w_i (g_i - its fit by the law's other columns)^2,
        g = -beta phi / (phi_m (phi_m - phi)),
    with one more point of the fitted ones' median weight, among fractions up to two errors below phi_m and up to
    half-way from what flows to phi_m: nearer to it a small system may jam. None if nothing is to be gained."""
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
    """The fraction half-way between the largest that flows and the smallest that does not; the middle of the widest gap
    among flowing ones where these are near each other; beyond the last one, or before the first, where all flow or
    none does. None where it is taken."""
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
    """The next fraction of a curve and why, given what has been proposed of all; None if nothing is to be gained."""
    of_law = best_of_law(estimate, exponent, unit_prefactor, proposed) if is_found(estimate.law) else None
    return of_law or bisection(estimate, proposed)


def propose(estimates, budget=None, exponent=None, unit_prefactor=False):
    """Fractions with reasons, one after the other, turn by turn of the curves: as many as `budget` (seconds of
    processor time) pays, one a curve unless given; the cost of one at all curves, as the dearest point of each took;
    and why there are none."""
    cost = sum(max((point["cpu_seconds"] for point in one.points), default=0) for one in estimates)
    most = len(estimates)
    if budget is not None:
        most = math.floor(budget / cost) if cost > 0 else 1
        if most == 0:
            return (
                [],
                cost,
                f"a point takes some {cost:.3g} s of processor time, as the dearest has: more than the budget",
            )
    made, is_any = [], True
    while is_any and len(made) < min(most, MOST_POINTS):
        is_any = False
        for one in estimates[: min(most, MOST_POINTS) - len(made)]:
            if found := next_fraction(one, [fraction for fraction, _ in made], exponent, unit_prefactor):
                is_any = True
                made.append((found[0], f"{one.name}: {found[1]}" if one.name else found[1]))
    return made, cost, "" if made else "no fraction would make phi_m better known: more seeds would"


class Refused(Exception):
    """Something of the campaign file: its place, its value, and the rule that it breaks."""


def added_to_sweep(sweep, over, fractions):
    """The operations (RFC 6902) that add fractions to the entry of a sweep that sets `over`, and the sweep with them.
    Throws Refused for an entry that sets it in step with others, whose values at new fractions are unknown."""
    for place, entry in enumerate(sweep):
        pointers = entry["set"] if isinstance(entry["set"], list) else [entry["set"]]
        if over not in pointers:
            continue
        if len(pointers) > 1:
            rule = "sets the fraction in step with others, whose values at new fractions are yours to choose: add the"
            raise Refused(f"/sweep/{place}/set", json.dumps(pointers, separators=(",", ":")), rule + " rows by hand")
        rows = [[fraction] if isinstance(entry["set"], list) else fraction for fraction in fractions]
        patch = [{"op": "add", "path": f"/sweep/{place}/values/-", "value": row} for row in rows]
        changed = {**entry, "values": [*entry["values"], *rows]}
        return patch, [*sweep[:place], changed, *sweep[place + 1 :]]
    raise Refused("/sweep", over, "is set by no entry")
