#!/usr/bin/python3
"""laws_study.py [REPETITIONS] [LAW ...]: how often the intervals of peclet.laws hold the truth, as a CSV table.

Each repetition draws every seed of every point around a law with known parameters, and fits it. Without LAW all.
"""
import csv
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "python"))
from peclet import laws, spectrum

SEEDS = (4, 8, 16)  # of a point
SPREAD = 0.06  # of a seed, relative
FRACTIONS = np.array((0.50, 0.52, 0.54, 0.56, 0.58, 0.59, 0.60, 0.61, 0.62))
RATES = np.geomspace(0.01, 100, 10)
PLANE = [axis.ravel() for axis in np.meshgrid((0.50, 0.54, 0.56, 0.57), (0.05, 0.1, 0.2, 0.4, 0.8, 2))]
VISCOUS = np.geomspace(0.001, 0.5, 10)
FREQUENCIES, TIMES = np.geomspace(0.01, 100, 16), np.geomspace(0.01, 30, 40)
MODES = ((3, 0.05), (2, 0.7), (1, 6))  # modulus and time
MODULUS, ZERO_SHEAR = sum(g for g, _ in MODES), sum(g * time for g, time in MODES)
INFINITE_FREQUENCY = 0.02


def sampled(generator, truth, seeds, deviation=None):
    """Returns means and standard errors of normal seeds; their standard deviation is by default SPREAD of the truth."""
    scale = SPREAD * truth if deviation is None else deviation
    values = truth[:, None] + scale[:, None] * generator.standard_normal((len(truth), seeds))
    return values.mean(axis=1), values.std(axis=1, ddof=1) / np.sqrt(seeds)


def wyart_cates(generator, seeds):
    fraction, stress = PLANE
    share = np.exp(-0.2 / stress)
    viscosity = (1 - fraction / (share * 0.58 + (1 - share) * 0.65)) ** -2
    return laws.WyartCates(fraction, stress, *sampled(generator, viscosity, seeds), seeds)


def mu_of_j(generator, seeds):
    friction = 0.32 + 0.38 / (1 + 0.005 / VISCOUS) + VISCOUS + 2.5 * 0.585 * np.sqrt(VISCOUS)
    measured = (*sampled(generator, VISCOUS, seeds), *sampled(generator, friction, seeds))
    return laws.MuOfJ(0.585 / (1 + np.sqrt(VISCOUS)), *measured, seeds)


def of_frequency(generator, seeds):
    x = FREQUENCIES[:, None] * [time for _, time in MODES]
    storage, loss = (part @ [g for g, _ in MODES] for part in (x * x / (1 + x * x), x / (1 + x * x)))
    loss, scale = loss + INFINITE_FREQUENCY * FREQUENCIES, SPREAD * np.hypot(storage, loss)
    measured = (*sampled(generator, storage, seeds, scale), *sampled(generator, loss, seeds, scale))
    return spectrum.maxwell_of_frequency(FREQUENCIES, *measured, seeds)


def of_time(generator, seeds):
    modulus = sum(g * np.exp(-TIMES / time) for g, time in MODES)
    return spectrum.maxwell_of_time(TIMES, *sampled(generator, modulus, seeds, SPREAD * (modulus + 1)), seeds)


def of_curve(law, axis, truth):
    return lambda generator, seeds: law(axis, *sampled(generator, truth, seeds), seeds)


ONSET = 0.567685  # phi from which on d ln eta / d ln sigma reaches 1, see laws_test.py
# The truth of a law: how its points are drawn, and its parameters.
LAWS = {
    "divergence": (
        of_curve(laws.Divergence, FRACTIONS, 1.4 * (1 - FRACTIONS / 0.65) ** -1.6),
        {"phi_m": 0.65, "exponent": 1.6, "prefactor": 1.4},
    ),
    "wyart-cates": (wyart_cates, {"phi_0": 0.65, "phi_mu": 0.58, "onset_stress": 0.2, "discontinuous_from": ONSET}),
    "mu-of-j": (mu_of_j, {"phi_m": 0.585, "mu_1": 0.32, "mu_2": 0.7, "I_0": 0.005}),
    "herschel-bulkley": (
        of_curve(laws.HerschelBulkley, RATES, 2 + 5 * RATES**0.6),
        {"yield_stress": 2, "consistency": 5, "flow_index": 0.6},
    ),
    "cross": (
        of_curve(laws.Cross, RATES, 3 + 17 / (1 + (2 * RATES) ** 0.8)),
        {"zero_rate_viscosity": 20, "infinite_rate_viscosity": 3, "time": 2, "exponent": 0.8},
    ),
    "maxwell, G′ and G″": (
        of_frequency,
        {
            "plateau_modulus": MODULUS,
            "zero_shear_viscosity": ZERO_SHEAR + INFINITE_FREQUENCY,
            "infinite_frequency_viscosity": INFINITE_FREQUENCY,
            "mean_time": ZERO_SHEAR / MODULUS,
        },
    ),
    "maxwell, G(t)": (
        of_time,
        {"plateau_modulus": MODULUS, "zero_shear_viscosity": ZERO_SHEAR, "mean_time": ZERO_SHEAR / MODULUS},
    ),
}


def coverage(name, seeds, repetitions):
    """Yields a row of the table for each parameter of a law."""
    made, truth = LAWS[name]
    intervals, small = {parameter: [] for parameter in truth}, 0
    for repetition in range(repetitions):
        law = made(np.random.default_rng((repetition, seeds)), seeds)
        fit = law if isinstance(law, laws.Fitted) else laws.fitted(law, ends=False)
        small += fit.p_value < 0.05
        known = fit.parameters | fit.derived
        for parameter in truth:
            if parameter in known and not known[parameter].obstacle:
                intervals[parameter].append(known[parameter].interval)
    for parameter, value in truth.items():
        low, high = np.array(intervals[parameter]).reshape(-1, 2).T
        count = max(len(low), 1)
        numbers = {"holds": (low <= value) & (value <= high), "too_low": high < value, "too_high": low > value}
        shares = {key: f"{100 * where.sum() / count:.1f}" for key, where in numbers.items()}
        row = {"law": name, "seeds": seeds, "parameter": parameter, "truth": f"{value:.6g}", "determined": len(low)}
        yield {**row, **shares, "p_below_5": f"{100 * small / repetitions:.1f}", "repetitions": repetitions}


def main():
    repetitions = int(sys.argv[1]) if len(sys.argv) > 1 else 400
    writer = None
    for name in sys.argv[2:] or LAWS:
        for seeds in SEEDS:
            for row in coverage(name, seeds, repetitions):
                if writer is None:
                    writer = csv.DictWriter(sys.stdout, list(row), lineterminator="\n")
                    writer.writeheader()
                writer.writerow(row)
                sys.stdout.flush()


if __name__ == "__main__":
    main()
