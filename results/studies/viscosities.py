"""Viscosities of a point of an export, split by term, as rows of a table."""
import collections
import math

from studies.estimates import estimate
from studies.tables import entries

FLAGS = ("timestep", "solver", "overlap")


def term(mean, *names):
    """Sum of terms of the shear stress over viscosity and rate; those that the scene lacks are 0."""
    return sum(mean["stress"][n][3] for n in names if n in mean["stress"])


TERMS = {
    "lubrication": ("lubrication", "brownian_lubrication"),
    "contact": ("contact_normal", "contact_damping", "friction", "rolling"),
    "repulsion": ("repulsion",),
}


def viscosity_row(point, *others):
    """Of a point of an export: `seeds` that ended well and were `lost`, whether the window is `transient`, and with its
    standard error (NAME_error) each of
    viscosity     relative, with 1 + 2.5 phi
    pairs         the same without 1 + 2.5 phi: what Li's thesis plots
    lubrication, contact, repulsion    its terms; lubrication with the random forces
    structural    the structural Brownian stress, which belongs to no sum
    and of `others`: quantities of the export."""
    numbers = {
        "viscosity": point.measured("relative_viscosity"),
        "pairs": point.measured("relative_viscosity_pair"),
        "structural": point.measured("brownian_structural", 3),
        **{name: point.measured(name) for name in others},
    }
    means = point.means
    for name, terms in TERMS.items():
        numbers[name] = estimate([term(mean, *terms) for mean in means]) if means else (math.nan, math.inf)
    row = {"seeds": len(means), "lost": point.lost, "transient": int(bool((point["look"] or {}).get("transient")))}
    return row | {key: value for name, pair in numbers.items() for key, value in entries(name, pair).items()}


def flags(point):
    """How many completed realisations warn of what."""
    warnings = [{w["code"] for w in r.get("warnings") or []} for r in point.results]
    return collections.Counter(code for codes in warnings for code in codes & set(FLAGS))


def counts_text(counter):
    return " ".join(f"{name}:{count}" for name, count in sorted(counter.items()))
