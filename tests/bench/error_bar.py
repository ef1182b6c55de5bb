#!/usr/bin/python3
"""error_bar.py ENGINE --before ENGINE [--rounds N] [--seeds N] [--seeds-before N] [--count N] [--window TIMES]

The cost of an error bar: processor time per unit of strain and, with noise, the variance of the relative
viscosity times processor time. Compares ENGINE at its defaults with the engine of an earlier commit
(build_before.sh) at its explicit steps, in the same scenes and in turn. Costs are those of a whole run
from a packing; the earlier engine gets a shorter one. Variances are those of averages over 1, 2, 4 ... of
the 32 blocks of a window (by default 40 Brownian times, after a quarter of that). Longer averages gain
less from the control variate. Errors of variances take averages as independent.
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
    "particles": {
        "count": 1000,
        "density": 0.1,
        "species": [{"radius": 1.0, "volume_share": 0.5}, {"radius": 1.4, "volume_share": 0.5}],
    },
    "volume_fraction": 0.5,
    "fluid": {"viscosity": 0.1},
    "lubrication": {"form": "kim-karrila", "inner_gap": 1e-3, "outer_gap": 0.05},
}
# Name, driving, friction, duration of a run now and before (in the unit of the fourth column).
QUIET = {"flow": {"shear_rate": 0.01}}
COST_CASES = [
    ("no noise, St = 0.01", QUIET, 0, "strain", 2, 0.02),
    ("the same, friction 1", QUIET, 1, "strain", 2, 0.02),
    ("Pe = 1", {"peclet": 1, "limits": {"shear_rate": 0.009, "thermal_energy": 0.017}}, 0, "brownian_times", 4, 0.2),
    (
        "Pe = 0.1",
        {"peclet": 0.1, "limits": {"shear_rate": 0.009, "thermal_energy": 0.017}},
        0,
        "brownian_times",
        4,
        0.2,
    ),
]
NOISY = [case for case in COST_CASES if "peclet" in case[1]]
LEAST_BLOCKS = 30


def run(engine, scene, seed, folder):
    path = os.path.join(folder, "scene.json")
    with open(path, "w") as f:
        json.dump(scene, f)
    done = subprocess.run(
        [engine, "run", path, "--seed", str(seed)],
        capture_output=True,
        text=True,
        env={**os.environ, "OMP_NUM_THREADS": "1"},
    )
    if done.returncode != 0:
        sys.exit(f"{engine}: {done.stderr.strip()}")
    return json.loads(done.stdout)


def scene_of(drive, friction, equilibration, production, count=1000):
    contact = {"normal_stiffness": 1e4, **({"friction": friction} if friction else {})}
    return {
        **SCENE,
        **drive,
        "contact": contact,
        "particles": {**SCENE["particles"], "count": count},
        "duration": {"equilibration": equilibration, "production": production},
    }


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


def blocks_of(result):
    """Returns for each block the viscosity without and with the stress of the random forces. An earlier
    engine, whose viscosity leaves this stress out, reports it as a control variate."""
    rows = result["blocks"]
    if "control_variates" in rows:
        noise = rows["control_variates"]["brownian_pairwise"]
        return [(eta, eta + b) for eta, b in zip(rows["relative_viscosity"], noise)]
    noise = rows["shear_stress"]["brownian_lubrication"]
    return [(eta - b, eta) for eta, b in zip(rows["relative_viscosity"], noise)]


def variance_of_averages(series, together, which):
    """Returns the variance of averages over `together` consecutive blocks, and the number of averages."""
    averages = [
        statistics.mean(block[which] for block in row[i : i + together])
        for row in series
        for i in range(0, len(row), together)
    ]
    return statistics.variance(averages) if len(averages) > 1 else math.nan, len(averages)


def error_bars(engines, seeds, count, window, cases, folder):
    print(
        f"\nVariance of the relative viscosity times processor time, N = {count}; {window / 4:g} Brownian times and "
        f"then {window:g}\n"
    )
    plain, controlled = 0, 1
    for name, drive, friction, _, _, _ in cases:
        scene = scene_of(drive, friction, {"brownian_times": window / 4}, {"brownian_times": window}, count=count)
        series, cost = [], []
        for engine, many, which in zip(engines, seeds, (controlled, plain)):
            results = [run(engine, scene, seed, folder) for seed in range(1, many + 1)]
            series.append([blocks_of(r) for r in results])
            cost.append(statistics.median(r["cost"]["cpu_seconds"] for r in results) / (1.25 * window))
            mean = [statistics.mean(block[which] for block in row) for row in series[-1]]
            error = statistics.stdev(mean) / math.sqrt(many) if many > 1 else math.inf
            print(
                f"{name}, {'before' if which == plain else 'now'}: {many} seeds, viscosity "
                f"{statistics.mean(mean):.3f} +- {error:.3f}, "
                f"{cost[-1]:.3g} s per Brownian time",
                flush=True,
            )
        print(
            f"  {'averages over':>15} {'variance now':>20} {'now, plain':>20} {'before':>20} "
            f"{'processor time before over now, to the same error':>52}"
        )
        for together in (1, 2, 4, 8, 16, 32):
            (now, n), (same, _), (before, n_before) = (
                variance_of_averages(series[k], together, which)
                for k, which in ((0, controlled), (0, plain), (1, plain))
            )
            text = "too few before"
            if n_before >= LEAST_BLOCKS:
                ratio, error = before / now * cost[1] / cost[0], math.sqrt(2 / (n - 1) + 2 / (n_before - 1))
                text = f"{ratio:.0f} +- {ratio * error:.0f}"
            print(
                f"  {window * together / 32:>13.4g}tB {now:>14.3g} ({n:4}) {same:>13.3g} ({n:4}) {before:>13.3g} "
                f"({n_before:4}) {text:>52}",
                flush=True,
            )


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("engine")
    parser.add_argument("--before", required=True)
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--seeds", type=int, default=32)
    parser.add_argument("--seeds-before", type=int, default=4)
    parser.add_argument("--count", type=int, default=250)
    parser.add_argument("--window", type=float, default=40)
    parser.add_argument("--case", choices=[case[0] for case in NOISY], help="the variance of this one alone")
    arguments = parser.parse_args()
    engines = (os.path.abspath(arguments.engine), os.path.abspath(arguments.before))
    with tempfile.TemporaryDirectory() as folder:
        if not arguments.case:
            costs(engines, arguments.rounds, folder)
        cases = [case for case in NOISY if arguments.case in (None, case[0])]
        error_bars(engines, (arguments.seeds, arguments.seeds_before), arguments.count, arguments.window, cases, folder)


main()
