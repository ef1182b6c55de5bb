#!/usr/bin/python3
"""peclet export frictionless.json | table.py, and the same with the other campaigns

Prints a line for each integrator: relative viscosity (with noise plus the pairs' Brownian stress, which has the mean
zero), what it is over that of the smallest implicit step, the pressure, pairs in contact, and processor time. Errors
are standard errors; those of the ratio are of the seeds that both have where one packing decides most of the scatter
(without noise), else of both means.
"""
import json
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from studies.estimates import estimate, quotient
from studies.tables import markdown_head, markdown_row, number_text

HEAD = (
    "integrator",
    "steps per unit of strain",
    "seeds",
    "η_r",
    "over the smallest implicit step",
    "pressure / ηγ̇",
    "contacts per particle",
    "s of processor per unit of strain",
)


def controlled(mean):
    # Brownian stress is listed in full; components are xx, yy, zz, xy, xz, yz.
    return mean["relative_viscosity"] + mean["brownian_pairwise"][3]


def ratio_text(viscosity, of_reference, noise):
    """Of viscosities by seed."""
    if viscosity == of_reference:
        return "1"
    if noise:
        return number_text(quotient(*(estimate([*values.values()]) for values in (viscosity, of_reference))), 3)
    common = sorted(viscosity.keys() & of_reference.keys())
    return number_text(estimate([viscosity[s] / of_reference[s] for s in common]), 3)


def name_of(settings, result):
    if settings["method"] == "explicit":
        name = "explicit"
    else:
        name = f"implicit, {settings['timestep']}"
    return f"{name} = {result['timestep']:.4g}" if settings.get("timestep") == "auto" else name


def cells_of(settings, results, seeds, of_reference, noise):
    viscosity = {seed: controlled(r["mean"]) for seed, r in results.items()}
    first = next(iter(results.values()))
    strain = sum(first["strain"].values())
    means = [r["mean"] for r in results.values()]
    cost = sorted(r["cost"]["cpu_seconds"] / strain for r in results.values())
    return [
        name_of(settings, first),
        f"{sum(first['steps'].values()) / strain:.4g}",
        f"{len(results)} of {seeds}",
        number_text(estimate([*viscosity.values()]), 3),
        ratio_text(viscosity, of_reference, noise),
        number_text(estimate([m["pressure"] for m in means]), 2),
        number_text(estimate([m["contacts_per_particle"] for m in means]), 4),
        f"{cost[len(cost) // 2]:.3g} ({cost[0]:.3g} .. {cost[-1]:.3g})",
    ]


def main():
    export = json.load(sys.stdin)
    points = []
    for point in export["points"]:
        results = {r["seed"]: r for r in point["realisations"] if r.get("mean")}
        points.append((point["settings"]["/integrator"], results, len(point["realisations"])))
    noise = "thermal_energy" in export["document"]["scene"]["fluid"]
    reference = next(results for settings, results, _ in points if settings["method"] == "implicit")
    of_reference = {seed: controlled(r["mean"]) for seed, r in reference.items()}
    print(markdown_head(HEAD))
    for point in points:
        print(markdown_row(cells_of(*point, of_reference, noise)))


main()
