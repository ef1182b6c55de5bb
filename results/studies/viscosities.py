"""Viscosities of a point of an export, split by term, as rows of a table."""
import collections
import math

from studies.estimates import estimate
from studies.tables import entries

FLAGS = ("timestep", "solver", "overlap")


def completed(point):
    """Means of the realisations that ended well."""
    return [r["mean"] for r in point["realisations"] if r.get("mean")]


def values_by_seed(realisations, name="relative_viscosity"):
    return {r["seed"]: r["mean"][name] for r in realisations if r.get("mean")}


def term(mean, *names):
    """Sum of terms of the shear stress over viscosity and rate; those that the scene lacks are 0."""
    return sum(mean["stress"][n][3] for n in names if n in mean["stress"])


def viscosity_row(point, *others):
    """Of a point of an export: `seeds` that ended well and were `lost`, whether the window is `transient`, and with its
    standard error (NAME_error) each of
    viscosity     relative, with 1 + 2.5 phi
    pairs         the same without 1 + 2.5 phi: what Li's thesis plots
    lubrication, contact, repulsion    its terms; lubrication with the random forces
    structural    the structural Brownian stress, which belongs to no sum
    and of `others`: numbers directly in the results' mean."""
    means = completed(point)
    quantities = {
        "viscosity": lambda m: m["relative_viscosity"],
        "pairs": lambda m: m["relative_viscosity_pair"],
        "lubrication": lambda m: term(m, "lubrication", "brownian_lubrication"),
        "contact": lambda m: term(m, "contact_normal", "contact_damping", "friction", "rolling"),
        "repulsion": lambda m: term(m, "repulsion"),
        "structural": lambda m: m["brownian_structural"][3],
        **{name: (lambda m, name=name: m[name]) for name in others},
    }
    row = {
        "seeds": len(means),
        "lost": len(point["realisations"]) - len(means),
        "transient": int(bool((point["look"] or {}).get("transient"))),
    }
    for name, of in quantities.items():
        row.update(entries(name, estimate([of(m) for m in means]) if means else (math.nan, math.inf)))
    return row


def flags(realisations):
    """How many completed realisations warn of what."""
    warnings = [{w["code"] for w in r.get("warnings") or []} for r in realisations if r.get("mean")]
    return collections.Counter(code for codes in warnings for code in codes & set(FLAGS))


def counts_text(counter):
    return " ".join(f"{name}:{count}" for name, count in sorted(counter.items()))
