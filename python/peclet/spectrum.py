"""Fits Maxwell's spectrum of relaxation times to moduli over time or frequency, with errors of the seeds.

    spectrum = peclet.spectrum.maxwell_of_frequency(frequency, storage, storage_error, loss, loss_error, seeds)
    print(spectrum.derived["zero_shear_viscosity"].interval)

Moduli and the errors c (standard error), with the c of laws.py, enter least squares as they are, because noise may
have either sign.
"""
import dataclasses

import numpy as np
from scipy.optimize import nnls

from peclet.jamming import NotDetermined
from peclet.laws import DRAWS, PERCENTILES, WITHIN, Fitted, Number, checked, poor_fit, student_errors

MODES = 6  # times of the grid in a decade


@dataclasses.dataclass
class Spectrum(Fitted):
    """A fitted spectrum of relaxation times."""

    times: np.ndarray = None
    weights: np.ndarray = None  # moduli, one a time
    intervals: np.ndarray = None  # (times, 2), the spread of 95 % of the redraws


class Modes:
    """Moduli over a grid of times.

    design        data (n, modes) of each mode; the last column is that of a viscosity if `is_viscous`
    """

    def __init__(self, times, design, values, errors, is_viscous):
        self.times, self.is_viscous, self.values, self.errors = times, is_viscous, values, errors
        self.scaled = design / errors[:, None]
        count = len(times)
        bend = -2 * np.eye(count) + np.eye(count, k=1) + np.eye(count, k=-1)
        # Weights are measured by what they add to the data, so that their bend is that of like numbers.
        self.bend = np.zeros((count, design.shape[1]))
        self.bend[:, :count] = bend * np.linalg.norm(self.scaled[:, :count], axis=0)

    def solve(self, values, smoothness):
        """Returns the weights >= 0 that minimise chi^2 + smoothness |bend|^2, and their chi^2."""
        scaled = values / self.errors
        matrix, right = self.scaled, scaled
        if smoothness > 0:
            matrix = np.concatenate([matrix, np.sqrt(smoothness) * self.bend])
            right = np.concatenate([right, np.zeros(len(self.bend))])
        weights, _ = nnls(matrix, right, maxiter=50 * matrix.shape[1])
        return weights, float(np.square(self.scaled @ weights - scaled).sum())

    def smoothness(self, target):
        """Returns the largest smoothness with a chi^2 of at most `target`, by bisection of its logarithm."""
        low, high = -8.0, 6.0
        for _ in range(30):
            middle = (low + high) / 2
            low, high = (middle, high) if self.solve(self.values, 10**middle)[1] <= target else (low, middle)
        return 10**low

    def sums(self, weights):
        """Returns {name: (rows,)} of rows of weights."""
        moduli = weights[:, : len(self.times)]
        viscosity = moduli @ self.times
        found = {
            "plateau_modulus": moduli.sum(axis=1),
            "zero_shear_viscosity": viscosity,
            "mean_time": viscosity / moduli.sum(axis=1),
        }
        if self.is_viscous:
            found["zero_shear_viscosity"] = viscosity + weights[:, -1]
            found["infinite_frequency_viscosity"] = weights[:, -1]
        return found


def corrected(value, drawn):
    """Returns the Number of a sum over the spectrum, less the bias that its redraws around the spectrum show.

    Noise adds positive weights that nothing cancels. The interval is that of value - (redraw - value), from 0 on.
    """
    low, high = np.maximum(2 * value - np.percentile(drawn, PERCENTILES)[::-1], 0)
    within = np.percentile(drawn, WITHIN)
    best = max(2 * value - float(np.median(drawn)), 0.0)
    return Number(best, float(within[1] - within[0]) / 2, (float(low), float(high)))


def fitted_spectrum(modes, axis, slowest, design_at, equation, draws, seed):
    """Returns the Spectrum of Modes; `slowest` is the largest time within the data. Raises NotDetermined."""
    free, chi = modes.solve(modes.values, 0)
    used = int((free > 0).sum())
    degrees = len(modes.values) - used
    if degrees < 1:
        raise NotDetermined(f"{len(modes.values)} values with an error for {used} modes: more are needed")
    # The truth has a larger chi^2 than the fit, by one for each parameter in the mean.
    smoothness = modes.smoothness(chi + used)
    weights, _ = modes.solve(modes.values, smoothness)
    wider = np.sqrt(max(1, chi / degrees))
    drawn = np.random.default_rng(seed).standard_normal((draws, len(modes.values)))
    drawn = modes.errors * (modes.scaled @ weights + wider * drawn)
    drawn = np.array([modes.solve(row, smoothness)[0] for row in drawn])
    sums, of_draws = modes.sums(weights[None]), modes.sums(drawn)
    derived = {name: corrected(float(value[0]), of_draws[name]) for name, value in sums.items()}
    count = len(modes.times)
    share = (weights[:count] * modes.times)[modes.times > slowest].sum() / max(sums["zero_shear_viscosity"][0], 1e-300)
    if share > 0.1:
        text = f"{100 * share:.0f} % of eta_0 comes from times beyond the data, above {slowest:.4g}"
        derived |= {name: Number(None, None, None, text) for name in ("zero_shear_viscosity", "mean_time")}
    p_value, remarks = poor_fit("no spectrum describes the points", chi, degrees)

    def curve(x):
        """Returns the law and the two ends of its band at axis values."""
        design = design_at(np.asarray(x, float))
        return design @ weights, *np.percentile(drawn @ design.T, PERCENTILES, axis=0)

    return Spectrum(
        "maxwell",
        equation,
        {},
        derived,
        chi,
        degrees,
        p_value,
        remarks,
        {},
        curve,
        modes.times,
        weights[:count],
        np.percentile(drawn[:, :count], PERCENTILES, axis=0).T,
    )


def grid_of_times(fastest, slowest):
    count = int(np.ceil(MODES * np.log10(slowest / fastest))) + 1
    return np.geomspace(fastest, slowest, max(count, 2))


def maxwell_of_time(time, modulus, error, seeds, draws=DRAWS, seed=1):
    """Returns the Spectrum of relaxation times of a modulus G(t).

        G(t) = sum_k g_k exp(-t / tau_k),    g_k >= 0

    time         t (n,) > 0
    modulus      G (n,), of either sign where it is noise
    error        its standard error (n,) > 0
    seeds        number of seeds (n,) or one number, 4 or more
    draws, seed  number of redraws, and their key

    The grid has 6 times a decade, from the smallest t to 3 times the largest. Weights are those of non-negative least
    squares (C. Lawson and R. Hanson, Solving Least Squares Problems, 1974, ch. 23) with a penalty on their second
    differences (J. Honerkamp and J. Weese, Rheol. Acta 32, 65, 1993). The penalty is as large as the discrepancy
    principle allows: chi^2 rises above its least value by the number of modes in use. Redraws have the same penalty,
    and are made around the spectrum, so that they show its bias, of which the sums are freed. `intervals` are the
    spread of the weights, which the penalty smooths, and not intervals of single modes of the truth.

    derived has G_0 = sum g_k, eta_0 = sum g_k tau_k and tau = eta_0 / G_0 of the times of the grid; eta_0 is not
    determined if more than a tenth of it comes from times beyond the data. Raises NotDetermined and ValueError.
    """
    time, values = checked("time", time), checked("modulus", modulus, False)
    errors = student_errors(checked("errors of modulus", error), seeds)
    times = grid_of_times(time.min(), 3 * time.max())

    def design_at(t):
        return np.exp(-t[:, None] / times)

    modes = Modes(times, design_at(time), values, errors, False)
    return fitted_spectrum(modes, time, time.max(), design_at, "G = Σ g_k exp(−t/τ_k)", draws, seed)


def maxwell_of_frequency(frequency, storage, storage_error, loss, loss_error, seeds, draws=DRAWS, seed=1):
    """Returns the Spectrum of relaxation times of moduli G' and G''.

        G' = sum_k g_k x_k^2 / (1 + x_k^2)
        G'' = sum_k g_k x_k / (1 + x_k^2) + eta_inf omega,    x_k = omega tau_k

    frequency                omega (n,) > 0, in radians per time
    storage, storage_error   G' (n,), of either sign where it is noise, and its standard error
    loss, loss_error         G'' (n,), and its standard error
    seeds, draws, seed       as for maxwell_of_time()

    The grid has 6 times a decade, from 1 / largest to 3 / smallest frequency; faster modes are part of eta_inf >= 0.
    Penalty, sums and what is raised are those of maxwell_of_time(); eta_0 includes eta_inf. `curve` returns G', then
    G''.
    """
    frequency = checked("frequency", frequency)
    values = np.concatenate([checked("storage modulus", storage, False), checked("loss modulus", loss, False)])
    errors = [checked(f"errors of {name}", e) for name, e in (("storage", storage_error), ("loss", loss_error))]
    errors = np.concatenate([student_errors(one, seeds) for one in errors])
    times = grid_of_times(1 / frequency.max(), 3 / frequency.min())

    def design_at(omega):
        x = omega[:, None] * times
        storage = np.column_stack([x * x / (1 + x * x), np.zeros(len(omega))])
        return np.concatenate([storage, np.column_stack([x / (1 + x * x), omega])])

    modes = Modes(times, design_at(frequency), values, errors, True)
    equation = "G′ = Σ g_k x²/(1 + x²), G″ = Σ g_k x/(1 + x²) + η_∞ ω, x = ω τ_k"
    return fitted_spectrum(modes, frequency, 1 / frequency.min(), design_at, equation, draws, seed)
