"""Solves for the profiles of a driven flow, from momentum balance, a law of mu and phi, and a range of fluctuations.

    d sigma / dy = -c phi (u_driving - u),  c = 6 pi eta <a> / <4 pi a^3 / 3>    (the drag on the spheres)
    sigma = mu P du/dy / |du/dy|,  P uniform, for the given mean volume fraction
    du' = G_l * (q(phi) a |du/dy|),  Theta = eta du' / (a P)                      (closure with the reach l)
    mu and phi: functions of J = eta |du/dy| / P and Theta

q(phi) is from uniform flow. G_l(y) = exp(-|y| / l) / (2 l) spreads the fluctuations of a layer over its surroundings;
* is the convolution over y.
"""
import math

import numpy as np

from studies.inhomogeneous import LARGER_RADIUS, MEAN_RADIUS, MEAN_VOLUME, RADIUS, VISCOSITY

DRAG = 6 * math.pi * VISCOSITY * MEAN_RADIUS / MEAN_VOLUME


def spread(values, height, reach):
    """Returns the convolution G_l * values of a periodic function on equal bins (bins,)."""
    waves = 2 * math.pi * np.fft.rfftfreq(len(values), height / len(values))
    return np.fft.irfft(np.fft.rfft(values) / (1 + (reach * waves) ** 2), len(values))


def velocity_of(driving, fraction, viscosity, width):
    """Returns u (bins,) from d/dy (viscosity du/dy) = -c phi (u_driving - u), periodic, by second differences.

    `width` is that of a bin. Viscosities between the bins are harmonic means.
    """
    count = len(driving)
    between = 2 / (1 / viscosity + 1 / np.roll(viscosity, -1)) / width**2  # above bin k
    drag = DRAG * fraction
    system = np.zeros((count, count))
    for k in range(count):
        above, below = between[k], between[k - 1]
        system[k, k] = above + below + drag[k]
        system[k, (k + 1) % count] -= above
        system[k, (k - 1) % count] -= below
    return np.linalg.solve(system, drag * driving)


def rates_of(velocity, width):
    return (np.roll(velocity, -1) - np.roll(velocity, 1)) / (2 * width)


def drag_by_share(largest_share):
    """Returns the drag coefficient 6 pi eta a n per volume fraction; `largest_share` is that of the larger spheres."""
    of = [6 * math.pi * VISCOSITY * radius / (4 * math.pi / 3 * radius**3) for radius in (RADIUS, LARGER_RADIUS)]
    return of[0] + (of[1] - of[0]) * largest_share


def stress_of_drag(table, width):
    """Returns sigma_xy in the bins of a flow from its velocities and volume fractions alone.

    It is the integral of the drag by the trapezoidal rule, with a mean of 0 where the rate changes its sign.
    """
    density = drag_by_share(table["largest share"]) * table["fraction"] * (table["driving"] - table["velocity"])
    steps = -width * 0.5 * (density + np.roll(density, -1))  # from the middle of a bin to that of the next one
    steps -= steps.mean()
    stress = np.concatenate([[0], np.cumsum(steps)[:-1]])
    rate, above = table["rate"], np.roll(table["rate"], -1)
    turns = np.nonzero(np.sign(rate) != np.sign(above))[0]
    part = rate[turns] / (rate[turns] - above[turns])
    return stress - float(np.mean(stress[turns] + part * steps[turns]))


class Law:
    """The law of mu and phi: ln mu and phi are polynomials of second degree in ln J and ln Theta.

    tables     of the bins of flows, to which the law and the reach are fitted
    uniform    table of uniform flow, which gives q(phi) and takes part in the fit
    heights    of the cells of the flows
    """

    def __init__(self, tables, uniform, heights):
        together = {
            name: np.concatenate([table[name] for table in (*tables, uniform)])
            for name in ("J", "Theta", "mu", "fraction")
        }
        moving = together["J"] > 1e-6
        j, theta = (np.log(together[name][moving]) for name in ("J", "Theta"))
        terms = self._terms(j, theta)
        self._mu = np.linalg.lstsq(terms, np.log(together["mu"][moving]), rcond=None)[0]
        self._fraction = np.linalg.lstsq(terms, together["fraction"][moving], rcond=None)[0]
        self._limits = [(v.min(), v.max()) for v in (j, theta)]
        self._source = np.polyfit(uniform["fraction"], np.log(uniform["Theta"] / uniform["J"]), 2)
        self._densest = float(np.max(uniform["fraction"]))
        self.reach = self._fitted_reach(tables, heights)

    @staticmethod
    def _terms(j, theta):
        return np.column_stack([np.ones_like(j), j, theta, j * j, j * theta, theta * theta])

    def source(self, fraction, rate):
        """Returns the fluctuations q(phi) |du/dy| of uniform flow, over a."""
        return np.exp(np.polyval(self._source, np.minimum(fraction, self._densest))) * np.abs(rate)

    def _fitted_reach(self, tables, heights):
        def left(reach):
            total = 0.0
            for table, height in zip(tables, heights):
                made = spread(self.source(table["fraction"], table["rate"]), height, reach)
                theta = VISCOSITY * made / (RADIUS * table["pressure"])
                total += float(np.sum(np.log(theta / table["Theta"]) ** 2))
            return total

        reaches = np.linspace(0.5, 12, 47)
        return float(reaches[int(np.argmin([left(r) for r in reaches]))])

    def __call__(self, j, theta):
        """Returns mu and phi. Arguments beyond the fitted range are taken at its border."""
        inside = [np.clip(np.log(np.maximum(v, 1e-12)), *limits) for v, limits in zip((j, theta), self._limits)]
        terms = self._terms(*inside)
        # Below the smallest fitted J, mu is extrapolated with its slope there.
        slope = self._mu[1] + 2 * self._mu[3] * inside[0] + self._mu[4] * inside[1]
        beyond = np.log(np.maximum(j, 1e-12)) - inside[0]
        return np.exp(terms @ self._mu + slope * np.minimum(beyond, 0)), terms @ self._fraction


class Solution:
    """Profiles by bin, the pressure, and the number of iterations."""

    def __init__(self, velocity, fraction, rate, pressure, mu, steps):
        self.velocity, self.fraction, self.rate, self.pressure = velocity, fraction, rate, pressure
        self.mu, self.steps = mu, steps


def solve(flow, law, most=4000, tolerance=1e-6):
    """Returns the Solution for a studies.inhomogeneous.Flow, by damped iteration with a factor of 0.1.

    Raises ArithmeticError if it does not converge within `most` iterations.
    """
    driving, width = flow.driving_of_bins(), flow.height / flow.bins
    velocity, fraction = 0.9 * driving, np.full(flow.bins, flow.fraction)
    pressure = 20 * VISCOSITY * flow.largest_rate()
    smallest = 1e-4 * flow.largest_rate()
    for step in range(1, most + 1):
        rate = rates_of(velocity, width)
        speed = np.sqrt(rate**2 + smallest**2)
        theta = VISCOSITY * spread(law.source(fraction, speed), flow.height, law.reach) / (RADIUS * pressure)
        mu, wanted = law(VISCOSITY * speed / pressure, theta)
        found = velocity_of(driving, fraction, mu * pressure / speed, width)
        change = max(
            float(np.max(np.abs(found - velocity)) / np.max(np.abs(driving))), float(np.max(np.abs(wanted - fraction)))
        )
        velocity = velocity + 0.1 * (found - velocity)
        fraction = fraction + 0.1 * (wanted - fraction)
        # The volume fraction grows with the pressure.
        pressure *= math.exp(np.clip(3 * (flow.fraction - float(wanted.mean())), -0.1, 0.1))
        if change < tolerance and abs(float(wanted.mean()) - flow.fraction) < tolerance:
            return Solution(velocity, fraction, rates_of(velocity, width), pressure, mu, step)
    raise ArithmeticError(f"{flow.name}: no solution after {most} iterations: the last one changed it by {change:.2g}")
