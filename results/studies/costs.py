"""Processor time of campaigns: planned before they ran, used, and needed for an estimate."""
import math
from pathlib import Path

import numpy as np

from studies.estimates import estimate
from studies.published import JAMMED_AT_REST, diverging

ERROR = 0.05  # relative standard error of prices


class Hours:
    """Planned and used processor time [h] of campaigns that `peclet plan` has no earlier data for."""

    def __init__(self, program):
        self._program = program
        self.planned, self.taken = 0.0, 0.0

    def plan(self, name, scene, settings, seeds, observable="relative_viscosity"):
        """Adds the planned time of a campaign, which is not run. Stored in a file, because planning takes seconds."""
        kept = Path(self._program.folder) / f"{name}.planned"
        if not kept.exists():
            self._program.write(f"plan-{name}", scene, settings, seeds, observable)
            kept.write_text(str(self._program.asked("plan", f"plan-{name}")["cpu_hours_maximum"]))
        self.planned += float(kept.read_text())

    def add(self, points):
        """Adds the used time of the points of an export."""
        self.taken += sum(r["cost"]["cpu_seconds"] for point in points for r in point["realisations"]) / 3600

    def numbers(self):
        """Returns both times as write_numbers() needs them."""
        return {"planned": (self.planned, 0.0, 0), "taken": (self.taken, 0.0, 0)}


def seconds_of_window(realisation, equilibration, production):
    """Returns the processor time of a realisation's window [s], in proportion to the two durations."""
    return realisation["cost"]["cpu_seconds"] * production / (equilibration + production)


def price(values, seconds, viscosity):
    """Returns the processor time [s] until the mean of such values has a standard error of ERROR * viscosity.

    The pair includes its standard error, sqrt(2 / (n - 1)) of it for normal values.
    """
    _, error = estimate(values)
    needed = float(np.sum(seconds)) * (error / (ERROR * viscosity)) ** 2
    return needed, needed * math.sqrt(2 / (len(values) - 1))


def flow_over_rest(peclet, fraction, species):
    """Returns the estimate of `peclet plan` for the price of a mean in the flow over that at rest:

        (6 pi / Pe)^2 phi a^3 / (300 v eta_r eta_p),    eta_r = (1 - phi/0.587)^-1.5 = 1 + 2.5 phi + eta_p

    with a = 1 and v the mean volume of a sphere.
    """
    inverse = sum(s["volume_share"] / (4 * math.pi / 3 * s["radius"] ** 3) for s in species)
    viscosity = diverging(fraction, JAMMED_AT_REST, 1.5)
    pairs = viscosity - 1 - 2.5 * fraction
    return (6 * math.pi / peclet) ** 2 * fraction * inverse / (300 * viscosity * pairs)
