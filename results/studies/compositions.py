"""Mixtures of colloids of radii 1 and 1.4 and grains of radii 5 and 7, and the volume fractions as one is added to the
other."""
import functools
import math

import numpy as np

from studies.estimates import difference, in_errors
from studies.published import gap_of, linear_mixture, rods
from studies.scenes import REFERENCE_SCENE, merged
from studies.verdicts import Statement

COLLOIDS, GRAINS = (1.0, 1.4), (5.0, 7.0)


def equal_volumes(radii):
    return [{"radius": radius, "volume_share": 0.5} for radius in radii]


# Scene without noise, in the units of Table 5.1 of Li's thesis.
MIXTURE_SCENE = merged(
    REFERENCE_SCENE,
    {
        "particles": {
            "species": None,
            "density": 0.004,  # Stokes number 0.09 of the largest grains
            "mixture": {"colloids": equal_volumes(COLLOIDS), "grains": equal_volumes(GRAINS), "alpha": 0},
        },
        "contact": {"normal_stiffness": 1e5},  # forces of grains on colloids grow with the square of their radii
        "guard": {"largest_overlap": 0.5},
    },
)
STIFFNESS, DENSITY = MIXTURE_SCENE["contact"]["normal_stiffness"], MIXTURE_SCENE["particles"]["density"]
THERMAL_ENERGY = 0.085
NOISE = {"flow": None, "peclet": 1, "limits": {"shear_rate": 0.045, "thermal_energy": THERMAL_ENERGY}}
# Grains alone are colloids in other units. These settings give them the same inertia and the same noise.
ALIKE = {"/particles/density": DENSITY / 25}
ALIKE_NOISE = {"/limits/thermal_energy": 125 * THERMAL_ENERGY}


def setting_of(alpha, count, fraction, stiffness, peclet=math.inf, besides=None):
    """Returns the settings of a composition; `peclet` is that of the colloids, infinite without noise."""
    return {
        "/particles/mixture/alpha": alpha,
        "/particles/count": count,
        "/volume_fraction": fraction,
        "/contact/normal_stiffness": stiffness,
        **({"/peclet": peclet} if math.isfinite(peclet) else {}),
        **(besides or {}),
    }


def composition_row(setting):
    """Returns the entries of a composition in a row of a table."""
    alpha, count = setting["/particles/mixture/alpha"], setting["/particles/count"]
    return {
        "alpha": alpha,
        "fraction": setting["/volume_fraction"],
        "count": count,
        "grains": round(grains_among(alpha, count)),
        "stiffness": setting["/contact/normal_stiffness"],
    }


def radii_and_shares(alpha):
    """Returns the four radii and their shares of the particles' volume; `alpha` is the share of the grains."""
    return (*COLLOIDS, *GRAINS), ((1 - alpha) / 2,) * 2 + (alpha / 2,) * 2


def grains_among(alpha, count):
    """Returns the mean number of grains among `count` spheres."""
    radii, shares = radii_and_shares(alpha)
    numbers = np.array(shares) / np.power(radii, 3)
    return count * float(numbers[len(COLLOIDS) :].sum() / numbers.sum())


def colloids_added(alpha, base):
    """Returns the volume fraction after colloids were added to grains at the volume fraction `base`, until the share of
    the grains is `alpha`."""
    return base / (base + (1 - base) * alpha)


def grains_added(alpha, base):
    """Returns the volume fraction after grains were added to colloids at the volume fraction `base`."""
    return colloids_added(1 - alpha, base)


def mean_peclet(alpha, number):
    """Returns the Peclet number of the mean radius (1 - alpha) a_c + alpha a_g; `number` is that of the colloids."""
    return number * (1 - alpha + alpha * GRAINS[0] / COLLOIDS[0]) ** 3


def windows(alpha, peclet):
    """Returns the settings of the strains before and in the window, by the Peclet number of the colloids.

    Less strain is needed if diffusion is faster than the flow, except for grains.
    """
    slow = math.sqrt(125 * peclet) if alpha == 1 else max(math.sqrt(peclet), 0.5 if alpha else 0)
    before = round(min(1, slow), 2)
    return {"/duration/equilibration/strain": before, "/duration/production/strain": 1.5 * before}


def alike(text, source, one, other):
    """Returns the statement that a number of one group alone is that of the other alone, in standard errors.

    They are one suspension in two units, in which steps are the same bit by bit (tests/physics/units_test), so that
    only their random numbers differ.
    """
    return Statement(f"{text}, in standard errors", source, *in_errors(one, other), -3, 3)


@functools.cache
def packing_models(alone):
    """Returns two models of the jamming volume fraction over alpha, by name; in each, either group alone jams at
    `alone`."""
    gap = gap_of(*radii_and_shares(0), alone, 4000)
    return {
        "linear mixture": lambda alpha: linear_mixture(alpha, COLLOIDS[0] / GRAINS[0], alone, alone),
        "rods": lambda alpha: rods(*radii_and_shares(alpha), gap, 4000),
    }


def from_nearer_model(jammed, alpha, alone):
    """Returns the difference of a volume fraction of jamming, a pair, from that of the nearer model."""
    distances = (difference(jammed, (model(alpha), 0)) for model in packing_models(alone).values())
    return min(distances, key=lambda distance: abs(distance[0]))


def draw_models(panel, alone, colour, titled):
    """Draws the curves of the two models, with their names in the legend if `titled`."""
    for dash, (name, model) in zip((1, 2), packing_models(alone).items()):
        panel.curve(model, name if titled else None, colour, span=(0, 1), samples=81, dash=dash)
