#!/usr/bin/python3
"""ratios.py BEFORE NOW [SCENE ...] [--rounds 5] [--instruction-sets avx2 avx512] [--large] [--panels]

Compares the processor time per unit of strain of two engines at their default steps, on one thread, with
identical scene files. BEFORE is the engine of an earlier commit (build_before.sh). In every round both run
one seed and take turns to begin; ratios are taken within a round. Times are those of whole runs, packing
included. Solver iterations are those of the production window, steps those of the whole run. A round with
an incomplete realisation is reported and left out.

--instruction-sets  by default avx2 and avx512, if this machine and both engines have them
--large             also N = 16384 and 65536, which take minutes a round
--panels            only the panels of results/speed-accuracy, some seconds each, with the seconds to a
                    standard error of 2 %: for NOW from table.csv there, for BEFORE these over the ratio
"""
import argparse
import csv
import json
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile

RESULTS = pathlib.Path(__file__).resolve().parents[2] / "results"
SPEED_ACCURACY = RESULTS / "speed-accuracy"
sys.path.insert(0, str(RESULTS))
from studies.scenes import REFERENCE_SCENE, during, merged
from studies.speed_accuracy import PANELS, ROUGH, SIZES

VECTOR_SETS = ("avx2", "avx512")


def lasting(equilibration, production):
    return during({"strain": equilibration}, {"strain": production})


def of_spheres(count):
    return {"particles": {"count": count}}


def at_peclet(number):
    limits = {"shear_rate": 0.009, "thermal_energy": 0.017}
    return {"flow": None, "peclet": number, "limits": limits}


# Patches of the published scene, by name. Two engines with two instruction sets take ten seconds a round.
SCENES = {
    "quiet": [lasting(0.5, 1)],
    "friction-0.45": [ROUGH, {"volume_fraction": 0.45}, lasting(0.5, 1)],
    "friction-0.5": [ROUGH, lasting(0.5, 1)],
    "peclet-1": [at_peclet(1), lasting(0.05, 0.1)],
    "peclet-100": [at_peclet(100), lasting(0.2, 1)],
    "four-sizes": [SIZES, lasting(0.2, 0.5)],
}
LARGE_SCENES = {
    "quiet-16384": [of_spheres(16384), lasting(0.1, 0.2)],
    "quiet-65536": [of_spheres(65536), lasting(0.05, 0.1)],
}


SECONDS_OF_A_PANEL = 2


def read_panels():
    """Returns for each panel patches for some seconds of run time, and its seconds to 2 %."""
    scenes, seconds = {}, {}
    with open(SPEED_ACCURACY / "table.csv", encoding="utf-8", newline="") as file:
        for row in csv.DictReader(file):
            if (row["method"], float(row["step"]), row["tolerance"]) == ("implicit", 1, "default"):
                name = row["panel"]
                strain = float(f"{SECONDS_OF_A_PANEL / float(row['seconds_per_strain']):.1g}")
                scenes[name] = [PANELS[name].patch, {"duration": None}, lasting(strain / 4, strain)]
                seconds[name] = float(row["seconds_to_2_percent"])
    return scenes, seconds


def scene_of(patches):
    scene = REFERENCE_SCENE
    for patch in patches:
        scene = merged(scene, patch)
    return scene


def answer_of(engine, scene, seed, instruction_set):
    environment = {**os.environ, "OMP_NUM_THREADS": "1", "PECLET_INSTRUCTION_SET": instruction_set}
    command = [engine, "run", scene, "--seed", str(seed), "--threads", "1"]
    return subprocess.run(command, capture_output=True, text=True, env=environment)


def has_set(engine, instruction_set, folder):
    path = os.path.join(folder, "probe.json")
    with open(path, "w", encoding="utf-8") as file:
        json.dump(merged(REFERENCE_SCENE, {**of_spheres(20), **lasting(0, 0.01)}), file)
    done = answer_of(engine, path, 0, instruction_set)
    if done.returncode != 0 and "PECLET_INSTRUCTION_SET" not in done.stderr:
        sys.exit(f"{engine}: {done.stderr.strip()}")
    return done.returncode == 0


class Run:
    def __init__(self, engine, scene, seed, instruction_set):
        done = answer_of(engine, scene, seed, instruction_set)
        try:
            result = json.loads(done.stdout)
        except json.JSONDecodeError:
            sys.exit(f"{engine}: {scene}: exit status {done.returncode}: {done.stderr.strip()}")
        self.ending = result["ending"]["cause"]
        if self.ending != "completed":
            return
        strain = sum(result["strain"].values())
        self.seconds = result["cost"]["cpu_seconds"] / strain
        self.iterations = result["gate"]["solver"]["iterations_per_step"]
        self.steps = sum(result["steps"].values()) / strain


def spread(values, digits="3g"):
    return f"{statistics.median(values):.{digits}} ({min(values):.{digits}} .. {max(values):.{digits}})"


def compare(engines, name, patches, seconds, instruction_set, rounds, folder):
    path = os.path.join(folder, "scene.json")
    with open(path, "w", encoding="utf-8") as file:
        json.dump(scene_of(patches), file)
    complete, broken = [], []
    for seed in range(1, rounds + 1):
        turn = engines if seed % 2 else engines[::-1]
        runs = {engine: Run(engine, path, seed, instruction_set) for engine in turn}
        ends = [runs[engine].ending for engine in engines]
        if ends == ["completed", "completed"]:
            complete.append([runs[engine] for engine in engines])
        else:
            broken.append(f"{name}, seed {seed}: before {ends[0]}, now {ends[1]}")
    if complete:
        before, now = zip(*complete)
        ratios = [b.seconds / a.seconds for a, b in complete]
        columns = [
            spread([run.seconds for run in before]),
            spread([run.seconds for run in now]),
            spread(ratios, "3f"),
            *(
                " -> ".join(f"{statistics.median(getattr(run, number) for run in runs):.1f}" for runs in (before, now))
                for number in ("iterations", "steps")
            ),
        ]
        if seconds:
            columns.append(f"{seconds / statistics.median(ratios):.3g} -> {seconds:.3g}")
        print(f"{name:20} {instruction_set:8} " + " ".join(f"{column:>26}" for column in columns), flush=True)
    for line in broken:
        print(line, flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("before")
    parser.add_argument("now")
    parser.add_argument("scenes", nargs="*", metavar="SCENE", help=f"of {', '.join([*SCENES, *LARGE_SCENES])}")
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--instruction-sets", nargs="+", metavar="SET")
    parser.add_argument("--large", action="store_true")
    parser.add_argument("--panels", action="store_true")
    arguments = parser.parse_intermixed_args()
    scenes, seconds = read_panels() if arguments.panels else ({**SCENES, **LARGE_SCENES}, {})
    unknown = [name for name in arguments.scenes if name not in scenes]
    if unknown:
        parser.error(f"SCENE: {', '.join(unknown)}: must be of {', '.join(scenes)}")
    if arguments.rounds < 1:
        parser.error(f"--rounds: {arguments.rounds}: must be at least 1")
    engines = [os.path.abspath(arguments.before), os.path.abspath(arguments.now)]
    if engines[0] == engines[1]:
        parser.error("NOW: must be another file than BEFORE")
    names = arguments.scenes or [name for name in scenes if arguments.large or name not in LARGE_SCENES]
    with tempfile.TemporaryDirectory() as folder:
        sets = arguments.instruction_sets or VECTOR_SETS
        had = [name for name in sets if all(has_set(engine, name, folder) for engine in engines)]
        if arguments.instruction_sets and had != list(sets):
            lacking = ", ".join(name for name in sets if name not in had)
            parser.error(f"--instruction-sets: {lacking}: must be what this machine and both engines have")
        heads = (
            "before / s per strain",
            "now / s per strain",
            "now over before",
            "iterations / step",
            "steps / strain",
            *(["s to 2 %"] if seconds else ()),
        )
        print(f"medians (extremes) of {arguments.rounds} rounds")
        print(f"{'scene':20} {'set':8} " + " ".join(f"{head:>26}" for head in heads))
        for name in names:
            for instruction_set in had or ["baseline"]:
                compare(engines, name, scenes[name], seconds.get(name), instruction_set, arguments.rounds, folder)


if __name__ == "__main__":
    main()
