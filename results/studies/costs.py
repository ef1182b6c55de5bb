"""Processor time: what was planned before anything had run, what it took, and what an estimate costs."""
import math
from pathlib import Path

import numpy as np

from studies.estimates import estimate
from studies.published import JAMMED_AT_REST, diverging

ERROR = 0.05  # the relative standard error that prices are of


class Hours:
    """Of campaigns of which `peclet plan` knew nothing."""

    def __init__(self, program, seeds):
        self._program, self._seeds = program, seeds
        self.planned, self.taken = 0.0, 0.0

    def plan(self, name, scene, settings, observable="relative_viscosity"):
        """Of a campaign of its own, which is never run. Kept, since planning takes some seconds."""
        kept = Path(self._program.folder) / f"{name}.planned"
        if not kept.exists():
            self._program.write(f"plan-{name}", scene, settings, self._seeds, observable)
            kept.write_text(str(self._program.asked("plan", f"plan-{name}")["cpu_hours_maximum"]))
        self.planned += float(kept.read_text())

    def add(self, points):
        """What the points of an export took."""
        self.taken += sum(r["cost"]["cpu_seconds"] for point in points for r in point["realisations"]) / 3600

    def numbers(self):
        """As write_numbers() takes them."""
        return {"planned": (self.planned, 0.0, 0), "taken": (self.taken, 0.0, 0)}


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
