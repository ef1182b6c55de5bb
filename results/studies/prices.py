"""What an estimate costs: processor seconds to a standard error."""
import math

import numpy as np

from studies.estimates import estimate
from studies.published import JAMMED_AT_REST, diverging

ERROR = 0.05  # the relative standard error that prices are of


def seconds_of_window(realisation, equilibration, production):
    """Of one realisation: the share of its processor time that its window has."""
    return realisation["cost"]["cpu_seconds"] * production / (equilibration + production)


def price(values, seconds, viscosity):
    """Processor seconds until the mean of such values has a standard error of ERROR times the viscosity, and the
    standard error of that number, of normal values: sqrt(2 / (n - 1)) of it."""
    _, error = estimate(values)
    needed = float(np.sum(seconds)) * (error / (ERROR * viscosity)) ** 2
    return needed, needed * math.sqrt(2 / (len(values) - 1))


def flow_over_rest(peclet, fraction, species):
    """The price of a mean in the flow over that at rest, as peclet plan guesses it: (6 pi / Pe)^2 phi a^3 / (300 v
    eta_r eta_p), eta_r = (1 - phi/0.587)^-1.5 = 1 + 2.5 phi + eta_p, a = 1, v the mean volume of a sphere."""
    inverse = sum(s["volume_share"] / (4 * math.pi / 3 * s["radius"] ** 3) for s in species)
    viscosity = diverging(fraction, JAMMED_AT_REST, 1.5)
    pairs = viscosity - 1 - 2.5 * fraction
    return (6 * math.pi / peclet) ** 2 * fraction * inverse / (300 * viscosity * pairs)
