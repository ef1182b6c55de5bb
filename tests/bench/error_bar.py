#!/usr/bin/python3
"""error_bar.py ENGINE --before ENGINE [--rounds N] [--seeds N] [--seeds-before N]

What an error bar costs: processor time per unit of strain and, with noise, the variance of the relative viscosity times the
processor time, of ENGINE at its defaults and of the engine of an earlier commit (build_before.sh) with its explicit steps, in the
same scenes and in turn. Variances are those of consecutive blocks of a production window of 40 Brownian times, averages of 1, 2, 4
... of its 32 blocks; with ENGINE of the viscosity plus the pairs' Brownian stress (mean zero), before of the viscosity alone.
"""
import argparse
import json
import math
import os
import statistics
import subprocess
import sys
import tempfile

SCENE = {
    "particles": {"count": 1000, "density": 0.1,
                  "species": [{"radius": 1.0, "volume_share": 0.5}, {"radius": 1.4, "volume_share": 0.5}]},
    "volume_fraction": 0.5,
    "fluid": {"viscosity": 0.1},
    "lubrication": {"form": "kim-karrila", "inner_gap": 1e-3, "outer_gap": 0.05},
}
# name, what drives it, friction, time of a run now and before (in the unit of the second column)
QUIET = {"flow": {"shear_rate": 0.01}}
COST_CASES = [
    ("no noise, St = 0.01", QUIET, 0, "strain", 2, 0.02),
    ("the same, friction 1", QUIET, 1, "strain", 2, 0.02),
    ("Pe = 1", {"peclet": 1, "limits": {"shear_rate": 0.009, "thermal_energy": 0.017}}, 0, "brownian_times", 4, 0.2),
    ("Pe = 0.1", {"peclet": 0.1, "limits": {"shear_rate": 0.009, "thermal_energy": 0.017}}, 0, "brownian_times", 4, 0.2),
]
NOISY = [case for case in COST_CASES if "peclet" in case[1]]
LEAST_BLOCKS = 30


def run(engine, scene, seed, folder):
    path = os.path.join(folder, "scene.json")
    with open(path, "w") as f:
        json.dump(scene, f)
    done = subprocess.run([engine, "run", path, "--seed", str(seed)], capture_output=True, text=True, env={**os.environ, "OMP_NUM_THREADS": "1"})
    if done.returncode != 0:
        sys.exit(f"{engine}: {done.stderr.strip()}")
    return json.loads(done.stdout)


def scene_of(drive, friction, equilibration, production, count=1000):
    contact = {"normal_stiffness": 1e4, **({"friction": friction} if friction else {})}
    return {**SCENE, **drive, "contact": contact, "particles": {**SCENE["particles"], "count": count},
            "duration": {"equilibration": equilibration, "production": production}}


def costs(engines, rounds, folder):
    print(f"Processor time per unit of strain, N = 1000; medians and extremes of {rounds} rounds in turn\n")
    print(f"{'case':24} {'now / s':>30} {'before / s':>30} {'before over now':>24}")
    for name, drive, friction, unit, now, before in COST_CASES:
        taken = {engine: [] for engine in engines}
        for seed in range(1, rounds + 1):
            for engine, time in zip(engines, (now, before)):
                result = run(engine, scene_of(drive, friction, {"time": 0}, {unit: time}), seed, folder)
                taken[engine].append(result["cost"]["cpu_seconds"] / sum(result["strain"].values()))
        ratios = [b / a for a, b in zip(*taken.values())]
        spread = [f"{statistics.median(v):.3g} ({min(v):.3g} .. {max(v):.3g})" for v in (*taken.values(), ratios)]
        print(f"{name:24} {spread[0]:>30} {spread[1]:>30} {spread[2]:>24}", flush=True)


def blocks_of(result, controlled):
    rows = result["blocks"]
    control = rows["control_variates"]["brownian_pairwise"] if controlled else [0] * len(rows["relative_viscosity"])
    return [eta + b for eta, b in zip(rows["relative_viscosity"], control)]


def variance_of_blocks(series, together):
    """Of averages of `together` consecutive blocks about the mean of all, its relative standard error, and their number."""
    averages = [statistics.mean(row[i:i + together]) for row in series for i in range(0, len(row), together)]
    return statistics.variance(averages), math.sqrt(2 / (len(averages) - 1)), len(averages)


def error_bars(engines, seeds, folder):
    print("\nVariance of the relative viscosity times processor time, N = 250; 10 Brownian times and then 40\n")
    for name, drive, friction, _, _, _ in NOISY:
        scene = scene_of(drive, friction, {"brownian_times": 10}, {"brownian_times": 40}, count=250)
        series, cost = [], []
        for engine, many, controlled in zip(engines, seeds, (True, False)):
            results = [run(engine, scene, seed, folder) for seed in range(1, many + 1)]
            series.append([blocks_of(r, controlled) for r in results])
            cost.append(statistics.median(r["cost"]["cpu_seconds"] for r in results) / 50)
            mean = [statistics.mean(row) for row in series[-1]]
            error = statistics.stdev(mean) / math.sqrt(many) if many > 1 else math.inf
            print(f"{name}, {'now' if controlled else 'before'}: {many} seeds, viscosity {statistics.mean(mean):.3f} +- {error:.3f}, {cost[-1]:.3g} s per Brownian time", flush=True)
        for together in (1, 2, 4, 8, 16, 32):
            (now, d_now, n_now), (before, d_before, n_before) = (variance_of_blocks(s, together) for s in series)
            if min(n_now, n_before) < LEAST_BLOCKS:
                continue
            ratio = before * cost[1] / (now * cost[0])
            print(f"  averages over {1.25 * together:5.2f} Brownian times: variance {now:.3g} ({n_now}) now, {before:.3g} ({n_before}) before; "
                  f"{before / now:.2f} times the variance, {ratio:.0f} +- {ratio * math.hypot(d_now, d_before):.0f} times the processor time to the same error", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("engine")
    parser.add_argument("--before", required=True)
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--seeds", type=int, default=32)
    parser.add_argument("--seeds-before", type=int, default=4)
    arguments = parser.parse_args()
    engines = (os.path.abspath(arguments.engine), os.path.abspath(arguments.before))
    with tempfile.TemporaryDirectory() as folder:
        costs(engines, arguments.rounds, folder)
        error_bars(engines, (arguments.seeds, arguments.seeds_before), folder)


main()
