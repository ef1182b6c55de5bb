#!/usr/bin/python3
"""script_cost.py BIN [--repeats N] [--count N] [--strain X ...]

Prints what a script of measurements adds to the time of a realisation: one with docs/measure/clusters.py at the usual
interval, 64 frames, over one without, in turns. Uses the first python3 in PATH with NumPy and SciPy.
"""
import argparse
import json
import os
import shutil
import statistics
import subprocess
import tempfile
import time

EXAMPLES = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "docs", "measure")
SCENE = {
    "particles": {
        "density": 0.01,
        "species": [{"radius": 1, "volume_share": 0.5}, {"radius": 1.4, "volume_share": 0.5}],
    },
    "volume_fraction": 0.5,
    "fluid": {"viscosity": 0.1},
    "flow": {"shear_rate": 0.1},
    "contact": {"normal_stiffness": 1e4, "friction": 0.5},
    "lubrication": {"form": "kim-karrila", "inner_gap": 0.001, "outer_gap": 0.05},
}


def seconds(engine, folder, scene):
    """Returns the time of a realisation, and what its result gives as its processor time."""
    path = os.path.join(folder, "scene.json")
    with open(path, "w") as file:
        json.dump(scene, file)
    begun = time.perf_counter()
    result = subprocess.run([engine, "run", path, "--quiet"], check=True, capture_output=True).stdout
    return time.perf_counter() - begun, json.loads(result)["cost"]["cpu_seconds"]


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("bin")
    parser.add_argument("--repeats", type=int, default=5)
    parser.add_argument("--count", type=int, default=1000, help="spheres")
    parser.add_argument("--strain", type=float, nargs="+", default=[2, 20], help="of the window")
    arguments = parser.parse_args()
    engine = os.path.join(arguments.bin, "peclet-engine")
    for strain in arguments.strain:
        compare(engine, arguments, strain)


def compare(engine, arguments, strain):
    scene = {
        **SCENE,
        "particles": {**SCENE["particles"], "count": arguments.count},
        "duration": {"equilibration": {"strain": 1}, "production": {"strain": strain}},
    }
    measuring = scene | {"observables": ["measure"], "measure": {"script": "clusters.py"}}
    pairs = []
    with tempfile.TemporaryDirectory() as folder:
        shutil.copy(os.path.join(EXAMPLES, "clusters.py"), folder)
        for _ in range(arguments.repeats):
            pairs.append((seconds(engine, folder, scene), seconds(engine, folder, measuring)))
    for column, name in enumerate(("time", "processor time")):
        without = statistics.median(plain[column] for plain, _ in pairs)
        ratios = [measured[column] / plain[column] for plain, measured in pairs]
        print(
            f"window of strain {strain:g}: {name} {without:.3g} s without the script, with it "
            f"{statistics.median(ratios):.3f} of that ({min(ratios):.3f} to {max(ratios):.3f})",
            flush=True,
        )


if __name__ == "__main__":
    main()
