#!/usr/bin/python3
"""strained_steps.py ENGINE FRICTION OUTER_DISTANCE [--seeds 16]

Measures the error of the viscosity by implicit steps with lubrication mari. Prints a row: the viscosity at an
eighth of the automatic step, and relative differences from it, seed by seed, in percent with errors, at half
the automatic step, at it and at twice it. ENGINE is a peclet-engine; 500 spheres of radii 1 and 1.4 at
phi = 0.5 in the units of Monti et al. (results/studies/monti.py), strains 2 to 6. One core.
"""
import argparse
import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "results"))
from studies.estimates import estimate, relative_difference
from studies.monti import PAIRS, contact, lubrication
from studies.scenes import during, merged
from studies.tables import number_text

STEPS = (0.5, 1, 2)


def result_of(engine, scene, seed, folder):
    path = os.path.join(folder, "scene.json")
    with open(path, "w", encoding="utf-8") as file:
        json.dump(scene, file)
    done = subprocess.run([engine, "run", path, "--seed", str(seed), "--threads", "1"], capture_output=True, text=True)
    result = json.loads(done.stdout) if done.stdout else {}
    if result.get("ending", {}).get("cause") != "completed":
        sys.exit(f"seed {seed}: {done.stderr.strip()}")
    return result


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("engine")
    parser.add_argument("friction", type=float)
    parser.add_argument("outer_distance", type=float)
    parser.add_argument("--seeds", type=int, default=16)
    arguments = parser.parse_args()
    scene = merged(
        PAIRS,
        {
            "particles": {"count": 500},
            "contact": contact(4e5, arguments.friction),
            "lubrication": lubrication(arguments.outer_distance),
            **during({"strain": 2}, {"strain": 4}),
        },
    )
    seeds = range(1, arguments.seeds + 1)
    with tempfile.TemporaryDirectory() as folder:

        def viscosities(step):
            scene["integrator"] = {"method": "implicit", "timestep": step}
            results = {seed: result_of(arguments.engine, scene, seed, folder) for seed in seeds}
            return {seed: result["mean"]["relative_viscosity"] for seed, result in results.items()}

        scene["integrator"] = {"method": "implicit"}
        automatic = result_of(arguments.engine, scene, 1, folder)["timestep"]
        reference = viscosities(automatic / 8)
        cells = [number_text(estimate([*reference.values()]), 2)]
        for factor in STEPS:
            change, error, _ = relative_difference(viscosities(factor * automatic), reference, True)
            cells.append(f"{100 * change:+.1f} ± {100 * error:.1f}")
    print(f"| {arguments.friction:g} | {arguments.outer_distance:g} | {arguments.seeds} | {' | '.join(cells)} |")


if __name__ == "__main__":
    main()
