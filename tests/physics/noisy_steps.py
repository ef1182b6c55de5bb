#!/usr/bin/python3
"""noisy_steps.py ENGINE PECLET STEP [STEP ...] [--seeds 16] [--count 250] [--equilibration 1] [--strain 6]

Measures the effect of the size of an implicit step with noise. Prints at each STEP means over seeds, with
standard errors, of the viscosity (without its control variate), the pressure and the contacts per sphere.
ENGINE is a peclet-engine; phi = 0.5, radii 1 and 1.4, limits of the rate and kT as in Table 4.1. One core.
"""
import argparse
import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "results"))
from studies.estimates import estimate
from studies.scenes import TABLE_SCENE, during, merged
from studies.tables import number_text

QUANTITIES = {"relative_viscosity": 2, "pressure": 2, "contacts_per_particle": 4}


def result_of(engine, path, seed):
    done = subprocess.run([engine, "run", path, "--seed", str(seed)], capture_output=True, text=True)
    result = json.loads(done.stdout) if done.stdout else {}
    if result.get("ending", {}).get("cause") != "completed":
        sys.exit(f"{path}: seed {seed}: {done.stderr.strip()}")
    return result


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("engine")
    parser.add_argument("peclet", type=float)
    parser.add_argument("steps", type=float, nargs="+", metavar="STEP")
    parser.add_argument("--seeds", type=int, default=16)
    parser.add_argument("--count", type=int, default=250)
    parser.add_argument("--equilibration", type=float, default=1)
    parser.add_argument("--strain", type=float, default=6)
    arguments = parser.parse_args()
    scene = merged(TABLE_SCENE, {"particles": {"count": arguments.count}, "peclet": arguments.peclet, "duration": None})
    scene = merged(scene, during({"strain": arguments.equilibration}, {"strain": arguments.strain}))
    with tempfile.TemporaryDirectory() as folder:
        for step in arguments.steps:
            path = os.path.join(folder, f"step-{step}.json")
            with open(path, "w", encoding="utf-8") as file:
                json.dump(merged(scene, {"integrator": {"method": "implicit", "timestep": step}}), file)
            means = [result_of(arguments.engine, path, seed)["mean"] for seed in range(1, arguments.seeds + 1)]
            found = [number_text(estimate([m[q] for m in means]), digits) for q, digits in QUANTITIES.items()]
            print(f"| {step} | {' | '.join(found)} |", flush=True)


if __name__ == "__main__":
    main()
