"""Fits the laws of suspensions to points whose errors are those of the seeds.

These are the fits of `peclet fit`, whose output laws_report.py makes:

    fitted = peclet.laws.cross(rate, viscosity, error, seeds)
    print(fitted.parameters["time"].interval, fitted.p_value)

Arrays have one element a point: the mean over its seeds, the standard error of this mean, and the number of seeds
(4 or more). Laws are fitted to logarithms, by least squares:

    chi^2 = sum_i (ln y_i - ln law_i)^2 / s_i^2
    s_i = c_i (standard error / mean)_i,    c^2 = (n - 1) / (n - 3)

c is that of jamming.py and accounts for the uncertain spread of n seeds.

Intervals are those of redraws: every point is drawn again, some hundred times, from a normal distribution around its
mean with the error s_i, and the law is fitted to each set. The interval of 95 % lies between the 2.5th and the 97.5th
percentile of a parameter. Weights that are themselves estimated make a fit worse than its normal equations say; so
errors of redraws are multiplied by the root of

    1 + 2 / (n - 1) (1 - p / N)

with N values and p parameters, the first term in 1 / (n - 1) beyond c (after P. Meier, Biometrics 9, 59, 1953, where
all values have one mean). The numbers are keyed by `seed`, so the answer is always the same. If chi^2 per degree of
freedom is above 1, errors of the redraws are multiplied by its root. p_value is the probability of a larger chi^2 if
the law holds: a small one means that it does not, and no interval includes that.

A parameter is not determined if its interval reaches the end of its search. A law is refused, by NotDetermined, if it
has as many parameters as points, or more.
"""
import dataclasses

import numpy as np
from scipy.stats import chi2

from peclet.jamming import FEWEST_SEEDS, Fit, NotDetermined, fit_law

DRAWS = 400  # redraws of a fit
PERCENTILES = (2.5, 97.5)
WITHIN = (15.87, 84.13)  # percentiles of one standard error to both sides
AT_END = 0.025  # share of redraws at an end of the search from which on the interval reaches it
POOR = 0.01  # p_value below which a fit is called poor
NEAREST = 1e-9  # smallest 1 - phi / phi_J; nearer to jamming, and beyond, the viscosity stays the same


class WrongParameter(ValueError):
    """A given or freed parameter that the law does not have, or with a value out of its range: name and rule."""


@dataclasses.dataclass
class Number:
    """A parameter of a law, or a number that follows from its parameters."""

    value: float  # None if it is not determined
    standard_error: float  # half of the range of 68.3 % of the redraws; 0 if the value was given
    interval: tuple  # 95 %; None if the value was given or is not determined
    obstacle: str = ""  # why it is not determined


@dataclasses.dataclass
class Fitted:
    """A fitted law."""

    law: str
    equation: str
    parameters: dict  # Numbers by name
    derived: dict  # Numbers by name, which follow from the parameters
    chi_squared: float
    degrees: int  # degrees of freedom: points less parameters
    p_value: float
    remarks: list  # sentences: what speaks against the fit
    ends: dict  # "without the lowest", "without the highest": Fitted or NotDetermined
    curve: object  # function of axis values (and others): the law's value, and the ends of its band of 95 %


@dataclasses.dataclass
class Parameter:
    """A parameter to search for: its range, and its value unless it is free."""

    name: str
    low: float
    high: float
    logarithmic: bool = False  # it is searched for in its logarithm
    usual: float = None
    is_limit: bool = False  # `low` is a limit of the law, such as a yield stress of 0, and not only of the search


def inner(parameter, value):
    """Returns a value of a parameter in the coordinate of its search."""
    return np.log(value) if parameter.logarithmic else np.asarray(value, float)


def least_squares(residuals, starts, low, high, iterations=200):
    """Returns the places (rows, p) of the minima of the sum of residuals^2, and these minima.

    residuals    function of places (some, p) and the numbers of their rows, returns (some, n)
    starts       places (rows, p) from which the searches begin
    low, high    ends of the search (p,)

    Takes the steps of Levenberg and Marquardt (D. Marquardt, J. Soc. Indust. Appl. Math. 11, 431, 1963) for all rows at
    once, with derivatives by differences. A row ends when a step gains less than 1e-9 of the sum.
    """
    places = np.clip(starts, low, high)
    rows = np.arange(len(places))
    sums = np.square(residuals(places, rows)).sum(axis=1)
    damping, shift = np.full(len(places), 1e-3), 1e-7 * (high - low)
    for _ in range(iterations):
        at, least = places[rows], sums[rows]
        left = residuals(at, rows)
        inwards = np.where(at + shift > high, -shift, shift)
        slopes = np.empty((*left.shape, at.shape[1]))
        for k in range(at.shape[1]):
            moved = at.copy()
            moved[:, k] += inwards[:, k]
            slopes[:, :, k] = (residuals(moved, rows) - left) / inwards[:, k, None]
        gradient = (left[:, None, :] @ slopes)[:, 0]
        # A parameter at an end of its range stays there if the sum falls beyond it.
        is_held = ((at <= low) & (gradient > 0)) | ((at >= high) & (gradient < 0))
        slopes *= ~is_held[:, None, :]
        gradient[is_held] = 0
        curvature = slopes.transpose(0, 2, 1) @ slopes
        diagonal = np.einsum("rpp->rp", curvature)
        scale = damping[rows, None] * diagonal + 1e-12 * diagonal.max(axis=1, keepdims=True) + 1e-300
        step = np.linalg.solve(curvature + scale[:, :, None] * np.eye(at.shape[1]), -gradient[:, :, None])[:, :, 0]
        tried = np.clip(at + step, low, high)
        gain = least - np.square(residuals(tried, rows)).sum(axis=1)
        is_better = gain > 0
        places[rows] = np.where(is_better[:, None], tried, at)
        sums[rows] = np.where(is_better, least - gain, least)
        is_over = (is_better & (gain <= 1e-9 * least + 1e-20)) | (tried == at).all(axis=1) | (damping[rows] > 1e10)
        damping[rows] = np.where(is_better, np.maximum(damping[rows] / 7, 1e-9), damping[rows] * 5)
        rows = rows[~is_over]
        if not len(rows):
            break
    return places, sums


def checked(name, values, positive=True):
    """Returns values as an array of one axis. Raises ValueError if one is not finite or, if asked, not > 0."""
    array = np.atleast_1d(np.asarray(values, float))
    if array.ndim != 1 or not np.isfinite(array).all() or (positive and not (array > 0).all()):
        raise ValueError(f"{name}: must be a list of finite numbers{' > 0' if positive else ''}")
    return array


def student_errors(errors, seeds):
    """Returns standard errors times c. Raises ValueError with fewer than 4 seeds."""
    seeds = checked("seeds", seeds) * np.ones(len(errors))
    if (seeds < FEWEST_SEEDS).any():
        raise ValueError(f"seeds: must be {FEWEST_SEEDS} or more at each point: the error of fewer is not known")
    return errors * np.sqrt((seeds - 1) / (seeds - 3))


def logarithms(name, values, errors, seeds):
    """Returns ln(values) and their errors s. Raises ValueError."""
    values, errors = checked(name, values), checked(f"errors of {name}", errors)
    if len(values) != len(errors):
        raise ValueError(f"errors of {name}: must be {len(values)} numbers, one a point")
    return np.log(values), student_errors(errors, seeds) / values


class Law:
    """A law with its points. Subclasses have `name`, `equation`, `axis` (n,), `columns` and the methods below.

    arrays     arguments of the constructor, one element a point; the last one is the number of seeds
    columns    list of measured (logarithms (n,), errors (n,)); redraws have rows (rows, n) of each
    """

    never_given = ()  # names of parameters that are always fitted

    def __init__(self, arrays, parameters, fixed, free):
        self.arrays, self.options = arrays, {"fixed": fixed, "free": free}
        known = {one.name: one for one in parameters}
        for name in [*(fixed or {}), *(free or ())]:
            if name not in known:
                raise WrongParameter(name, f"is no parameter of {self.name}; there are {', '.join(known)}")
        given = {one.name: one.usual for one in parameters if one.usual is not None and one.name not in (free or ())}
        self.given = given | {name: float(value) for name, value in (fixed or {}).items()}
        for name, value in self.given.items():
            if not known[name].low <= value <= known[name].high:
                raise WrongParameter(name, f"must be {known[name].low:.4g} to {known[name].high:.4g}")
        self.parameters = parameters
        self.free = [one for one in parameters if one.name not in self.given]
        if len(self.free) >= self.count():
            raise NotDetermined(
                f"{self.count()} points with an error for {len(self.free)} parameters: at least "
                f"{len(self.free) + 1} are needed"
            )

    def only(self, chosen):
        """Returns the law with the chosen points."""
        return type(self)(*(array[chosen] for array in self.arrays), **self.options)

    def with_given(self, name, value):
        """Returns the law with a value of one more parameter."""
        return type(self)(*self.arrays, **self.options | {"fixed": (self.options["fixed"] or {}) | {name: value}})

    def count(self):
        """Returns the number of measured values."""
        return sum(len(values) for values, _ in self.columns)

    def residuals(self, p, columns):
        """Returns the residuals over their errors (rows, n) of parameters {name: (rows, 1)}."""
        raise NotImplementedError

    def starts(self):
        """Returns values {name: list} of the free parameters from which the search begins, in all combinations."""
        raise NotImplementedError

    def value(self, p, x):
        """Returns the law (rows, n) at axis values x (n,)."""
        raise NotImplementedError

    def curves(self, p, *x):
        """Returns what Fitted.curve() shows."""
        return self.value(p, *x)

    def derived(self, p):
        """Returns further numbers {name: (rows,)} that follow from the parameters {name: (rows, 1)}."""
        return {}

    def own_remarks(self, p):
        """Returns remarks on the best parameters."""
        return []

    def named(self, places):
        """Returns all parameters {name: (rows, 1)} at places (rows, p) of the search."""
        own = {
            one.name: np.exp(places[:, [k]]) if one.logarithmic else places[:, [k]] for k, one in enumerate(self.free)
        }
        return {
            one.name: own.get(one.name, np.full((len(places), 1), self.given.get(one.name))) for one in self.parameters
        }

    def limits(self):
        return tuple(
            np.array([inner(one, end(one)) for one in self.free]) for end in (lambda p: p.low, lambda p: p.high)
        )

    def solve(self, columns, starts):
        """Returns the places (rows, p) of the fits to rows of columns, and chi^2 (rows,)."""
        columns = [np.broadcast_to(values, (len(starts), values.shape[1])) for values in columns]

        def residuals(places, rows):
            return self.residuals(self.named(places), [values[rows] for values in columns])

        return least_squares(residuals, starts, *self.limits())

    def best(self):
        """Returns the place (p,) of the best fit, and its chi^2."""
        grid = self.starts()
        axes = np.meshgrid(*(np.atleast_1d(inner(one, grid[one.name])) for one in self.free), indexing="ij")
        starts = np.stack([axis.ravel() for axis in axes], axis=1)
        places, chi = self.solve([values[None] for values, _ in self.columns], starts)
        return places[np.argmin(chi)], float(chi.min())


def fitted(law, draws=DRAWS, seed=1, ends=True):
    """Returns the Fitted of a Law: the best fit, redraws, and the fits without its ends. Raises NotDetermined."""
    best, chi = law.best()
    degrees = law.count() - len(law.free)
    wider = np.sqrt(max(1, chi / degrees))
    generator = np.random.default_rng(seed)
    wider = wider * np.sqrt(1 + 2 / (law.arrays[-1] - 1) * (1 - len(law.free) / law.count()))
    columns = [
        values + wider * errors * generator.standard_normal((draws, len(values))) for values, errors in law.columns
    ]
    places, _ = law.solve(columns, np.tile(best, (draws, 1)))
    mine, drawn = law.named(best[None]), law.named(places)
    low, high = law.limits()
    parameters, unbounded = {}, []
    for one in law.parameters:
        value = float(mine[one.name][0, 0])
        if one.name in law.given:
            parameters[one.name] = Number(value, 0.0, None)
            continue
        k = law.free.index(one)
        margin = 1e-6 * (high[k] - low[k]) if np.isfinite(high[k]) else 0
        at_end = [np.mean(places[:, k] <= low[k] + margin), np.mean(places[:, k] >= high[k] - margin)]
        parameters[one.name] = bounded(value, drawn[one.name][:, 0], at_end, (one.low, one.high))
        if parameters[one.name].obstacle and not (one.is_limit and at_end[1] < AT_END):
            unbounded.append((one, one.high if at_end[1] >= AT_END else one.low))
    for one, end in unbounded:
        parameters |= dependent(law, one, end, parameters)
    derived = {}
    if all(not number.obstacle for number in parameters.values()):
        others = law.derived(drawn)
        derived = {name: bounded(float(v[0]), others[name]) for name, v in law.derived(mine).items()}
    p_value, remarks = poor_fit("the law does not describe the points", chi, degrees)

    def curve(*x):
        """Returns the law and the two ends of its band at axis values."""
        ends = np.percentile(law.curves(drawn, *x), PERCENTILES, axis=0, method="nearest")  # infinite beyond jamming
        return law.curves(mine, *x)[0], *ends

    return Fitted(
        law.name,
        law.equation,
        parameters,
        derived,
        chi,
        degrees,
        p_value,
        remarks + law.own_remarks(mine),
        without_ends(law, draws, seed) if ends else {},
        curve,
    )


def dependent(law, unbounded, end, parameters):
    """Returns parameters, each with its obstacle, that move with one whose search has ended at `end`.

    They differ by more than their error between the fits with the end and with a value well within the search: a tenth
    of the end or ten times it for logarithmic searches, otherwise a tenth of the range away. If the law cannot be given
    that one, all others move with it.
    """
    text = f"it depends on {unbounded.name}, which is not determined"
    if unbounded.name in law.never_given:
        return {one.name: Number(None, None, None, text) for one in law.free if one is not unbounded}
    away = 1 if end == unbounded.low else -1
    near = end * 10.0**away if unbounded.logarithmic else end + away * (unbounded.high - unbounded.low) / 10
    at = [law.with_given(unbounded.name, value) for value in (end, near)]
    at = [one.named(one.best()[0][None]) for one in at]
    found = {}
    for name, number in parameters.items():
        if number.interval and abs(at[0][name] - at[1][name])[0, 0] > number.standard_error:
            found[name] = Number(None, None, None, text)
    return found


def poor_fit(what, chi, degrees):
    """Returns the p-value of a fit, and remarks that name a poor one."""
    p_value = float(chi2.sf(chi, degrees))
    text = f"{what}: chi^2 per degree of freedom is {chi / degrees:.3g} (p = {p_value:.1e})"
    return p_value, [text + ", and errors are made wider by its root"] if p_value < POOR else []


def bounded(value, drawn, at_end=(0, 0), search=(0, 0)):
    """Returns the Number of a value and its redraws; `at_end` are the shares of them at both ends of the search."""
    low, high = np.percentile(drawn, PERCENTILES)
    if max(at_end) >= AT_END:
        lower = at_end[0] >= AT_END
        text = f"its interval reaches {search[0] if lower else search[1]:.4g}, the end of its search"
        if min(at_end) < AT_END:
            text += f"; it is at {'most' if lower else 'least'} {high if lower else low:.4g} (97.5 %)"
        return Number(None, None, None, text)
    within = np.percentile(drawn, WITHIN)
    return Number(value, float(within[1] - within[0]) / 2, (float(low), float(high)))


def without_ends(law, draws, seed):
    """Returns the fits without the lowest and without the highest values of the axis, by name."""
    found = {}
    for name, end in (("without the lowest", law.axis.min()), ("without the highest", law.axis.max())):
        try:
            found[name] = fitted(law.only(law.axis != end), draws, seed, ends=False)
        except NotDetermined as why:
            found[name] = why
    return found


# The laws


class OneCurve(Law):
    """A law of one measured quantity over one axis; fits ln y."""

    quantity = "viscosity"

    def __init__(self, axis, values, errors, seeds, parameters, fixed, free):
        self.axis = checked(self.over, axis)
        self.columns = [logarithms(self.quantity, values, errors, seeds)]
        if len(self.axis) != self.count():
            raise ValueError(f"{self.over}: must be {self.count()} numbers, one a point")
        seeds = np.broadcast_to(np.asarray(seeds, float), self.axis.shape)
        arrays = self.axis, np.asarray(values, float), np.asarray(errors, float), seeds
        super().__init__(arrays, parameters, fixed, free)

    def residuals(self, p, columns):
        return (np.log(self.value(p, self.axis)) - columns[0]) / self.columns[0][1]


class Divergence(OneCurve):
    """A (1 - phi / phi_m)^-beta; the fit is that of jamming.py, which searches for phi_m alone."""

    name, over = "divergence", "fraction"
    equation = "η_r = prefactor (1 − φ/phi_m)^−exponent"
    never_given = ("phi_m",)

    def __init__(self, fraction, viscosity, error, seeds, fixed=None, free=None):
        largest = float(np.max(checked("fraction", fraction)))
        if largest >= 1:
            raise ValueError("fraction: must be < 1")
        # phi_m has the range of jamming.py, whose search is in ln(phi_m - largest fraction).
        parameters = [
            Parameter("phi_m", largest, 1),
            Parameter("exponent", 0, np.inf),
            Parameter("prefactor", 1e-300, np.inf, True),
        ]
        super().__init__(fraction, viscosity, error, seeds, parameters, fixed, free)
        if "phi_m" in self.given:
            raise WrongParameter("phi_m", "cannot be given")
        self.largest = largest
        factor = self.given.get("prefactor", 1.0)
        self.points = list(zip(self.axis, self.arrays[1] / factor, self.arrays[2] / factor, self.arrays[3]))
        self.form = {"exponent": self.given.get("exponent"), "unit_prefactor": "prefactor" in self.given}

    def placed(self, phi_m, beta, factor):
        own = {"phi_m": phi_m, "exponent": beta, "prefactor": np.log(factor)}
        return np.stack([own[one.name] for one in self.free], axis=-1)

    def best(self):
        law = fit_law(self.points, self.largest, **self.form)
        return self.placed(law.phi_m[0], law.exponent[0], law.prefactor[0]), law.chi_squared

    def solve(self, columns, starts):
        fit = Fit(self.points, self.largest, self.form["unit_prefactor"])
        phi_m, beta, factor, chi = fit.of_rows(
            columns[0] - np.log(self.given.get("prefactor", 1.0)), self.form["exponent"]
        )
        return self.placed(phi_m, beta, factor), chi

    def value(self, p, x):
        return p["prefactor"] * (1 - x / p["phi_m"]) ** -p["exponent"]


def divergence(fraction, viscosity, error, seeds, fixed=None, free=None, draws=DRAWS, seed=1):
    """Returns the Fitted divergence of the viscosity at the jamming point phi_m.

        eta_r = prefactor (1 - phi / phi_m)^-exponent

    With prefactor 1 and exponent 2 that of S. Maron and P. Pierce (J. Colloid Sci. 11, 80, 1956), with exponent
    2.5 phi_m that of I. Krieger and T. Dougherty (Trans. Soc. Rheol. 3, 137, 1959). The fit is jamming.fit_law().

    fraction     phi (n,), in (0, 1)
    viscosity    eta_r (n,) > 0, with the solvent's 1
    error        its standard error (n,) > 0
    seeds        number of seeds (n,) or one number, 4 or more
    fixed        values {"prefactor": 1, "exponent": 2} of parameters that are not fitted
    draws, seed  number of redraws, and their key

    phi_m is searched for from the largest fraction to 1. Raises NotDetermined and ValueError.
    """
    return fitted(Divergence(fraction, viscosity, error, seeds, fixed, free), draws, seed)


class HerschelBulkley(OneCurve):
    """sigma_y + K rate^n."""

    name, over, quantity = "herschel-bulkley", "rate", "stress"
    equation = "σ = yield_stress + consistency γ̇^flow_index"

    def __init__(self, rate, stress, error, seeds, fixed=None, free=None):
        high = float(np.max(checked("stress", stress)))
        self.middle = float(np.exp(np.mean(np.log(checked("rate", rate)))))
        # K belongs to the mean rate in the search, where it hardly depends on n.
        parameters = [
            Parameter("yield_stress", 0, high, is_limit=True),
            Parameter("consistency", high * 1e-6 / self.middle**3, high * 1e6 / self.middle**0.02, True),
            Parameter("flow_index", 0.02, 3),
        ]
        super().__init__(rate, stress, error, seeds, parameters, fixed, free)

    def starts(self):
        low, at = self.arrays[1].min(), int(np.argmax(self.axis))
        n = [0.3, 0.6, 1.0]
        scale = [self.arrays[1][at] / self.axis[at] ** power for power in n]
        return {"yield_stress": [0.03 * low, 0.5 * low, 0.9 * low], "consistency": scale, "flow_index": n}

    def value(self, p, x):
        return p["yield_stress"] + p["consistency"] * x ** p["flow_index"]

    def own_remarks(self, p):
        if "yield_stress" in self.given:
            return []
        lowest = self.arrays[1].min()
        text = f"no point lies below the yield stress: it is that of this law beyond the lowest stress, {lowest:.4g}"
        return [text + ", and other laws have another"]


def herschel_bulkley(rate, stress, error, seeds, fixed=None, free=None, draws=DRAWS, seed=1):
    """Returns the Fitted law of a yield stress fluid (W. Herschel and R. Bulkley, Kolloid-Z. 39, 291, 1926).

        sigma = yield_stress + consistency rate^flow_index

    rate         (n,) > 0 [1/time], or a Péclet number
    stress       sigma (n,) > 0 [stress], or viscosity times rate
    error        its standard error (n,) > 0
    seeds        number of seeds (n,) or one number, 4 or more
    fixed        values {"yield_stress": 0, "flow_index": 0.5} of parameters that are not fitted
    draws, seed  number of redraws, and their key

    The yield stress is searched for from 0 to the largest stress, the flow index from 0.02 to 3.
    Raises NotDetermined and ValueError.
    """
    return fitted(HerschelBulkley(rate, stress, error, seeds, fixed, free), draws, seed)


class Cross(OneCurve):
    """eta_inf + (eta_0 - eta_inf) / (1 + (lambda rate)^m)."""

    name, over = "cross", "rate"
    equation = "η = η_∞ + (η_0 − η_∞)/(1 + (time γ̇)^exponent), from the zero-rate to the infinite-rate viscosity"

    def __init__(self, rate, viscosity, error, seeds, fixed=None, free=None):
        rates, values = checked("rate", rate), checked("viscosity", viscosity)
        ends = float(values.min()) / 100, float(values.max()) * 100
        parameters = [
            Parameter("zero_rate_viscosity", *ends, True),
            Parameter("infinite_rate_viscosity", *ends, True, is_limit=True),
            Parameter("time", 0.01 / float(rates.max()), 100 / float(rates.min()), True),
            Parameter("exponent", 0.1, 6),
        ]
        super().__init__(rate, viscosity, error, seeds, parameters, fixed, free)

    def starts(self):
        values = self.arrays[1][np.argsort(self.axis)]
        ends = np.geomspace(self.axis.min(), self.axis.max(), 5)[1:4]
        return {
            "zero_rate_viscosity": [values[0], 1.5 * values[0]],
            "infinite_rate_viscosity": [values[-1], values[-1] / 1.5],
            "time": 1 / ends,
            "exponent": [0.6, 1.2],
        }

    def value(self, p, x):
        return p["infinite_rate_viscosity"] + (p["zero_rate_viscosity"] - p["infinite_rate_viscosity"]) / (
            1 + (p["time"] * x) ** p["exponent"]
        )


def cross(rate, viscosity, error, seeds, fixed=None, free=None, draws=DRAWS, seed=1):
    """Returns the Fitted law of thinning between two plateaus (M. Cross, J. Colloid Sci. 20, 417, 1965).

        eta = infinite + (zero - infinite) / (1 + (time rate)^exponent)

    with zero = zero_rate_viscosity and infinite = infinite_rate_viscosity.

    rate         (n,) > 0 [1/time], or a Péclet number
    viscosity    eta (n,) > 0, in any unit
    error        its standard error (n,) > 0
    seeds        number of seeds (n,) or one number, 4 or more
    fixed        values {"exponent": 1} of parameters that are not fitted
    draws, seed  number of redraws, and their key

    Plateaus are searched for from a hundredth of the smallest to a hundred times the largest viscosity, the time
    from 0.01 / largest to 100 / smallest rate, the exponent from 0.1 to 6. Raises NotDetermined and ValueError.
    """
    return fitted(Cross(rate, viscosity, error, seeds, fixed, free), draws, seed)


class WyartCates(Law):
    """Thickening as contacts become frictional."""

    name = "wyart-cates"
    equation = (
        "η_r = prefactor (1 − φ/φ_J)^−exponent, φ_J = f phi_mu + (1 − f) phi_0, f = exp(−(onset_stress/σ)^sharpness)"
    )

    def __init__(self, fraction, stress, viscosity, error, seeds, jammed=(), fixed=None, free=None):
        self.axis, self.stress = checked("fraction", fraction), checked("stress", stress)
        self.columns = [logarithms("viscosity", viscosity, error, seeds)]
        if not len(self.axis) == len(self.stress) == self.count():
            raise ValueError(f"fraction, stress: must be {self.count()} numbers, one a point")
        self.jammed = np.asarray(jammed, float).reshape(-1, 3)
        largest, ends = float(self.axis.max()), (float(self.stress.min()) / 100, float(self.stress.max()) * 100)
        parameters = [
            Parameter("phi_0", largest, 1),
            Parameter("phi_mu", 0.1, 1),
            Parameter("onset_stress", *ends, True),
            Parameter("exponent", 0.5, 6, usual=2),
            Parameter("prefactor", 1e-3, 1e3, True, usual=1),
            Parameter("sharpness", 0.2, 5, usual=1),
        ]
        arrays = [np.asarray(a, float) * np.ones(len(self.axis)) for a in (fraction, stress, viscosity, error, seeds)]
        super().__init__(arrays, parameters, fixed, free)
        self.options["jammed"] = self.jammed

    def starts(self):
        largest, low, high = self.axis.max(), np.log(self.stress.min()), np.log(self.stress.max())
        of_stress = np.exp(low + (high - low) * np.array([0.1, 0.4, 0.7]))
        return {
            "phi_0": largest + np.array([0.02, 0.06, 0.12]),
            "phi_mu": largest + np.array([-0.02, 0.003, 0.03]),
            "onset_stress": of_stress,
            "exponent": [1.5, 2.2],
            "prefactor": 1,
            "sharpness": 1,
        }

    def jamming(self, p, stress):
        """Returns phi_J at each stress."""
        share = np.exp(-((p["onset_stress"] / stress) ** p["sharpness"]))
        return share * p["phi_mu"] + (1 - share) * p["phi_0"]

    def logarithm(self, p, fraction, stress):
        gap = np.maximum(1 - fraction / self.jamming(p, stress), NEAREST)
        return np.log(p["prefactor"]) - p["exponent"] * np.log(gap)

    def residuals(self, p, columns):
        own = (self.logarithm(p, self.axis, self.stress) - columns[0]) / self.columns[0][1]
        if not len(self.jammed):
            return own
        # A point that jams is above its bound: it says nothing where the law is above it, too.
        fraction, stress, bound = self.jammed.T
        below = np.minimum(self.logarithm(p, fraction, stress) - np.log(bound), 0) / np.median(self.columns[0][1])
        return np.concatenate([own, below], axis=1)

    def value(self, p, fraction, stress):
        gap = 1 - fraction / self.jamming(p, stress)
        return np.where(gap > NEAREST, p["prefactor"] * np.maximum(gap, NEAREST) ** -p["exponent"], np.inf)

    def derived(self, p):
        """The rate sigma / eta has an extremum where d ln eta / d ln sigma = 1, which is where

            phi = phi_J^2 / (phi_J + alpha D),    D = -d phi_J / d ln sigma = (phi_0 - phi_mu) b z exp(-z)

        with z = (sigma* / sigma)^b. The smallest such phi is the onset of discontinuous thickening.
        """
        z = np.geomspace(1e-4, 50, 500)
        fall = p["phi_0"] - p["phi_mu"]
        at = p["phi_0"] - fall * np.exp(-z)
        onset = (at**2 / (at + p["exponent"] * fall * p["sharpness"] * z * np.exp(-z))).min(axis=1)
        return {"discontinuous_from": onset, "jammed_from": p["phi_mu"][:, 0]}


def wyart_cates(fraction, stress, viscosity, error, seeds, jammed=(), fixed=None, free=None, draws=DRAWS, seed=1):
    """Returns the Fitted law of thickening of M. Wyart and M. Cates (Phys. Rev. Lett. 112, 098302, 2014).

        eta_r = prefactor (1 - phi / phi_J)^-exponent
        phi_J = f phi_mu + (1 - f) phi_0,    f = exp(-(onset_stress / stress)^sharpness)

    fraction     phi (n,), in (0, 1)
    stress       sigma (n,) > 0, which is given, in any unit
    viscosity    eta_r (n,) > 0
    error        its standard error (n,) > 0
    seeds        number of seeds (n,) or one number, 4 or more
    jammed       rows (phi, sigma, bound) of points that jam: their viscosity is above `bound`
    fixed        values of parameters that are not fitted; unless freed, exponent = 2, prefactor = 1 and sharpness = 1
    free         names of these that are fitted
    draws, seed  number of redraws, and their key

    Jammed points are censored: they add to chi^2 where the law is below their bound, with the median error of the
    others. Derived are discontinuous_from, the phi from which on the rate falls over a range of stress
    (d rate / d stress = 0), and jammed_from = phi_mu, from which on large stresses jam. Raises NotDetermined and
    ValueError.
    """
    return fitted(WyartCates(fraction, stress, viscosity, error, seeds, jammed, fixed, free), draws, seed)


class MuOfJ(Law):
    """Friction and volume fraction over the viscous number."""

    name = "mu-of-j"
    equation = "φ = phi_m/(1 + √J), μ = mu_1 + (mu_2 − mu_1)/(1 + I_0/J) + J + 2.5 phi_m √J"

    def __init__(self, fraction, viscous, viscous_error, friction, friction_error, seeds, fixed=None, free=None):
        self.fraction = checked("fraction", fraction)
        self.columns = [
            logarithms("viscous number", viscous, viscous_error, seeds),
            logarithms("friction", friction, friction_error, seeds),
        ]
        self.axis = np.exp(self.columns[0][0])
        if not len(self.axis) == len(self.fraction) == len(self.columns[1][0]):
            raise ValueError("fraction, viscous number, friction: must be lists of the same length")
        parameters = [
            Parameter("phi_m", float(self.fraction.max()), 1),
            Parameter("mu_1", 0, 5, is_limit=True),
            Parameter("mu_2", 0, 50, is_limit=True),
            Parameter("I_0", float(self.axis.min()) / 100, float(self.axis.max()) * 100, True),
        ]
        arrays = [fraction, viscous, viscous_error, friction, friction_error, seeds]
        arrays = [np.asarray(array, float) * np.ones(len(self.axis)) for array in arrays]
        super().__init__(arrays, parameters, fixed, free)
        self.slope = 0.4  # d ln mu / d ln J, of the best fit after the first pass

    def starts(self):
        low = float(np.exp(self.columns[1][0].min()))
        return {
            "phi_m": self.fraction.max() + np.array([0.005, 0.02, 0.06]),
            "mu_1": [0.3 * low, 0.8 * low],
            "mu_2": [low, 3 * low],
            "I_0": np.geomspace(self.axis.min(), self.axis.max(), 4),
        }

    def best(self):
        place, chi = super().best()
        for _ in range(3):
            p, step = self.named(place[None]), 1.001
            self.slope = np.log(self.value(p, self.axis * step) / self.value(p, self.axis)) / np.log(step)
            places, sums = self.solve([values[None] for values, _ in self.columns], place[None])
            place, chi = places[0], float(sums[0])
        return place, chi

    def residuals(self, p, columns):
        viscous, friction = columns
        (_, error), (_, friction_error) = self.columns
        gap = np.maximum(p["phi_m"] / self.fraction - 1, NEAREST)
        both = np.hypot(friction_error, self.slope * error)
        of_fraction = (viscous - 2 * np.log(gap)) / error
        return np.concatenate([of_fraction, (np.log(self.value(p, np.exp(viscous))) - friction) / both], axis=1)

    def value(self, p, x):
        contact = p["mu_1"] + (p["mu_2"] - p["mu_1"]) / (1 + p["I_0"] / x)
        return contact + x + 2.5 * p["phi_m"] * np.sqrt(x)

    def curves(self, p, x):
        return np.concatenate([self.value(p, x), p["phi_m"] / (1 + np.sqrt(x))], axis=1)

    def own_remarks(self, p):
        parts = np.split(np.square(self.residuals(p, [values[None] for values, _ in self.columns]))[0], 2)
        return [
            "chi^2 of {} points: {:.3g} of phi(J), {:.3g} of mu(J)".format(len(self.axis), *(x.sum() for x in parts))
        ]


def mu_of_j(
    fraction, viscous, viscous_error, friction, friction_error, seeds, fixed=None, free=None, draws=DRAWS, seed=1
):
    """Returns the Fitted laws of F. Boyer, E. Guazzelli and O. Pouliquen (Phys. Rev. Lett. 107, 188301, 2011).

        phi = phi_m / (1 + sqrt(J))
        mu = mu_1 + (mu_2 - mu_1) / (1 + I_0 / J) + J + 2.5 phi_m sqrt(J)

    fraction                      phi (n,), in (0, 1), which is given
    viscous, viscous_error        J = eta rate / P (n,) > 0, and its standard error
    friction, friction_error      mu = sigma_xy / P (n,) > 0, and its standard error
    seeds                         number of seeds (n,) or one number, 4 or more
    fixed                         values {"mu_1": 0.32} of parameters that are not fitted
    draws, seed                   number of redraws, and their key

    Both share phi_m. P is the pressure of the particles: -tr(sigma) / 3 or -sigma_yy, which differ; theirs was
    -sigma_yy. As phi is given, the first law is fitted to ln J. Errors of J and mu are taken as independent; the error
    of ln mu has that of ln J times d ln mu / d ln J in it. `curve` returns mu(J), then phi(J). Raises NotDetermined and
    ValueError.
    """
    law = MuOfJ(fraction, viscous, viscous_error, friction, friction_error, seeds, fixed, free)
    return fitted(law, draws, seed)
