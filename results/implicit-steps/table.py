#!/usr/bin/python3
"""peclet export frictionless.json | table.py, and the same with the other campaigns

Prints a line for each integrator: relative viscosity (with noise plus the pairs' Brownian stress, which has the mean zero), what it is
over that of the smallest implicit step, the pressure, pairs in contact, and processor time. Errors are standard errors; those
of the ratio are of the seeds that both have where one packing decides most of the scatter (without noise), else of both means.
"""
import json
import math
import sys


def estimate(values):
    mean = sum(values) / len(values)
    return mean, math.sqrt(sum((v - mean) ** 2 for v in values) / max(1, len(values) - 1) / len(values))


def controlled(mean):
    # Brownian stress is listed in full; components are xx, yy, zz, xy, xz, yz.
    return mean["relative_viscosity"] + mean["brownian_pairwise"][3]


def main():
    export = json.load(sys.stdin)
    points = []
    for point in export["points"]:
        results = {r["seed"]: r for r in point["realisations"] if r.get("mean")}
        points.append((point["settings"]["/integrator"], results, len(point["realisations"])))
    noise = "thermal_energy" in export["document"]["scene"]["fluid"]
    reference = next(results for settings, results, _ in points if settings["method"] == "implicit")
    print(
        "| integrator | steps per unit of strain | seeds | η_r | over the smallest implicit step | pressure / ηγ̇ | contacts per particle | s of processor per unit of strain |"
    )
    print("|---|---|---|---|---|---|---|---|")
    for settings, results, seeds in points:
        viscosity = {seed: controlled(r["mean"]) for seed, r in results.items()}
        of_reference = {seed: controlled(r["mean"]) for seed, r in reference.items()}
        common = sorted(viscosity.keys() & of_reference.keys())
        if results is reference:
            ratio = "1"
        elif noise:
            (a, da), (b, db) = estimate(list(viscosity.values())), estimate(list(of_reference.values()))
            ratio = f"{a / b:.3f} ± {a / b * math.hypot(da / a, db / b):.3f}"
        else:
            mean, error = estimate([viscosity[s] / of_reference[s] for s in common])
            ratio = f"{mean:.3f} ± {error:.3f}"
        any_result = next(iter(results.values()))
        strain = sum(any_result["strain"].values())
        steps = sum(any_result["steps"].values()) / strain
        (eta, d_eta), (p, dp) = estimate(list(viscosity.values())), estimate(
            [r["mean"]["pressure"] for r in results.values()]
        )
        contacts, d_contacts = estimate([r["mean"]["contacts_per_particle"] for r in results.values()])
        cost = sorted(r["cost"]["cpu_seconds"] / strain for r in results.values())
        name = "explicit" if settings["method"] == "explicit" else f"implicit, {settings['timestep']}"
        if settings.get("timestep") == "auto":
            name += f" = {any_result['timestep']:.4g}"
        print(
            f"| {name} | {steps:.4g} | {len(results)} of {seeds} | {eta:.3f} ± {d_eta:.3f} | {ratio} | {p:.2f} ± {dp:.2f} | "
            f"{contacts:.4f} ± {d_contacts:.4f} | {cost[len(cost) // 2]:.3g} ({cost[0]:.3g} .. {cost[-1]:.3g}) |"
        )


main()
