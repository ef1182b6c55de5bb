#!/usr/bin/python3
"""viscosities.py ENGINE [DEVICE [SEEDS [SPHERES [SCENE...]]]]

Prints the relative viscosity of scenes by the steps of the processor and by those of DEVICE (emulated, or cuda), each
the mean over SEEDS (32) with its standard error, and the difference in combined standard errors. ENGINE is peclet-
engine. With SPHERES (200), 128 seeds took some forty minutes of two cores beside other work. The exit code is 1 if a
difference is above three errors.
"""
import concurrent.futures
import json
import os
import statistics
import subprocess
import sys
import tempfile

BASE = {
    "particles": {
        "density": 0.1,
        "species": [{"radius": 1.0, "volume_share": 0.5}, {"radius": 1.4, "volume_share": 0.5}],
    },
    "volume_fraction": 0.5,
    "fluid": {"viscosity": 0.1},
    "contact": {"normal_stiffness": 1e4},
    "lubrication": {"form": "kim-karrila", "inner_gap": 1e-3, "outer_gap": 0.05},
    "duration": {"equilibration": {"strain": 1}, "production": {"strain": 1}},
}
LIMITS = {"shear_rate": 0.009, "thermal_energy": 0.017}
SCENES = {
    "no-noise": {"flow": {"shear_rate": 0.009}},
    "friction-1": {"flow": {"shear_rate": 0.009}, "contact": {"normal_stiffness": 1e4, "friction": 1}},
    "Pe-1": {"peclet": 1, "limits": LIMITS},
    "Pe-100": {"peclet": 100, "limits": LIMITS},
}


def viscosities(engine, device, scene, seeds, folder):
    """Returns the relative viscosity of each seed; the work of one call is that of as many cores as it uses."""

    def run(first, last):
        output = os.path.join(folder, f"{device}.{first}.json")
        command = [
            engine,
            "run",
            scene,
            f"--seeds={first}..{last}",
            f"--device={device}",
            f"--output={output}",
            "--quiet",
        ]
        subprocess.run(command, check=True)
        values = []
        for seed in range(first, last + 1):
            with open(f"{output[:-5]}.{seed}.json", encoding="utf-8") as file:
                values.append(json.load(file)["mean"]["relative_viscosity"])
        return values

    if device != "none":  # a card takes all seeds at once, its emulation all cores
        return run(0, seeds - 1)
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as threads:
        return sum(threads.map(lambda seed: run(seed, seed), range(seeds)), [])


def main():
    engine, device = sys.argv[1], (sys.argv[2:] or ["emulated"])[0]
    seeds, spheres = (int(text) for text in (sys.argv[3:5] + ["32", "200"][len(sys.argv[3:5]) :]))
    worst = 0
    print(f"{'scene':<12} {'processor':>18} {device:>18}  difference/error", flush=True)
    for name in sys.argv[5:] or SCENES:
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "scene.json")
            with open(path, "w", encoding="utf-8") as file:
                json.dump(BASE | SCENES[name] | {"particles": BASE["particles"] | {"count": spheres}}, file)
            line, squares, means = f"{name:<12}", 0, []
            for steps in ("none", device):
                values = viscosities(engine, steps, path, seeds, folder)
                means.append(statistics.fmean(values))
                error = statistics.stdev(values) / seeds**0.5
                squares += error**2
                line += f" {means[-1]:>10.3f} ± {error:<5.3f}"
            apart = (means[1] - means[0]) / squares**0.5
            worst = max(worst, abs(apart))
            print(f"{line}  {apart:+.2f}", flush=True)
    return worst > 3


if __name__ == "__main__":
    sys.exit(main())
