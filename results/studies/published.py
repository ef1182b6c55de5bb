"""Published fits to viscosities, and published models of packings."""
import heapq
import math

import numpy as np
from scipy.optimize import brentq

# c, phi_J and lambda of fits c (1 - phi / phi_J)^-lambda to relative viscosities without noise, with solvent and
# stresslet, by friction coefficient: Mari et al. (2014), as quoted by Monti et al. (2021).
MARI_FITS = {0: (1.4, 0.66, 1.6), 1: (0.71, 0.575, 2.3)}


def mari_fit(fraction, friction):
    """Returns the relative viscosity by MARI_FITS."""
    factor, jammed, exponent = MARI_FITS[friction]
    return factor * diverging(fraction, jammed, exponent)


def diverging(fraction, jammed, exponent=1.5):
    """Returns (1 - phi / phi_J)^-lambda, the form of the fits of Li's thesis to viscosities of pairs."""
    return (1 - fraction / jammed) ** -exponent


JAMMED_AT_REST, JAMMED_IN_STRONG_FLOW = 0.587, 0.642  # phi_J of these fits without friction, with lambda = 1.5

# Li's thesis, Table 4.1: Peclet number, shear rate, thermal energy; a = 1, density and viscosity 0.1, k_n = 10^4.
TABLE_4_1 = (
    (0.01, 9e-5, 0.017),
    (0.046, 4.2e-4, 0.017),
    (0.22, 1.9e-3, 0.017),
    (1, 9e-3, 0.017),
    (4.6, 9e-3, 3.7e-3),
    (22, 9e-3, 7.9e-4),
    (100, 9e-3, 1.7e-4),
    (460, 9e-3, 3.7e-5),
    (2200, 9e-3, 7.9e-6),
    (1e4, 9e-3, 1.7e-6),
)
DENSITY, VISCOSITY, STIFFNESS = 0.1, 0.1, 1e4

RODS = 20000  # of the one-dimensional packing; volume fractions are then exact to 2e-4


def linear_mixture(alpha, ratio, dense_small, dense_large):
    """Returns the packing fraction of a mixture by the linear packing model of Yu & Standish (1991).

    alpha    share of the large spheres in the volume of the spheres
    ratio    small over large radius
    dense_small, dense_large    packing fractions of either size alone

    Either size gives a specific volume 1 / phi if it carries the packing; the larger one counts.
    """
    small, large = 1 / dense_small, 1 / dense_large
    filling = (1 - ratio) ** 3.3 + 2.8 * ratio * (1 - ratio) ** 2.7  # small spheres fill holes between large ones
    taking = (1 - ratio) ** 2 + 0.4 * ratio * (1 - ratio) ** 3.7  # large spheres replace small ones
    carried_by_large = large + (1 - alpha) * (small * (1 - filling) - large)
    carried_by_small = small + alpha * (large - (large - 1) * taking - small)
    return 1 / max(carried_by_large, carried_by_small)


def rod_lengths(radii, shares, count):
    """Returns `count` quantiles of the distribution of chords that a straight line cuts from spheres, longest first.

    `shares` are those of the volume. A line hits spheres in proportion to their number and cross-section. A chord of a
    sphere of diameter D is shorter than l with the probability (l / D)^2.
    """
    diameters, shares = 2 * np.asarray(radii, float), np.asarray(shares, float)
    weights = shares / diameters
    weights = weights / weights.sum()
    lengths = np.linspace(0, diameters.max(), 200001)
    shorter = sum(w * np.minimum(lengths / d, 1) ** 2 for w, d in zip(weights, diameters))
    return np.interp((np.arange(count) + 0.5) / count, shorter, lengths)[::-1]


def rods(radii, shares, gap, count=RODS):
    """Returns the packing fraction of spheres of these radii and volume shares by the rods of Farr & Groot (2009).

    Rods are placed by length, the longest first, into the largest gap. The free length between two neighbours is at
    least `gap` times the shorter one. gap = 0.7654 gives random close packing of equal spheres, 0.6435.
    """
    lengths = rod_lengths(radii, shares, count).tolist()
    gaps = [-gap * lengths[0]]
    for length in lengths[1:]:
        largest = -heapq.heappop(gaps)
        heapq.heappush(gaps, -gap * length)
        heapq.heappush(gaps, -max(gap * length, largest - (1 + gap) * length))
    total = math.fsum(lengths)
    return total / (total - math.fsum(gaps))


def gap_of(radii, shares, fraction, count=RODS):
    """Returns the `gap` for which rods() gives this packing fraction."""
    return brentq(lambda gap: rods(radii, shares, gap, count) - fraction, 0.2, 3, xtol=1e-4)
