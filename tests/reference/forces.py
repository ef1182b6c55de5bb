#!/usr/bin/python3
"""forces.py make MIXTURE SEED [--scene SCENE.json]   prints a case: a random configuration and its answer
forces.py check ENGINE [--seeds N] [--scene FILE]  compares the engine with the evaluator on random ones
forces.py packing ENGINE FINAL.xyz [--scene FILE]  compares on an engine's packing, of any size
forces.py confirm [CASE.json...]                   compares stored cases (those of forces/) with the evaluator

Compares forces, torques, stresses and advanced springs with the evaluator beside this file (README.md).
Differences are relative to the largest number of a term; more than 1e-10 is an error.
"""
import argparse
import json
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

from evaluator.configurations import MIXTURES, SCENE, packed_configuration, random_configuration, varied, with_only
from evaluator.evaluation import PAIR_TERMS, evaluate, largest_difference

TOLERANCE = 1e-10
CASES = Path(__file__).resolve().parent / "forces"


class Comparison:
    """The number of comparisons and the worst differences."""

    def __init__(self):
        self.count, self.failures, self.worst = 0, 0, {}
        self.terms, self.acting = set(), set()

    def add(self, name, expected, answer):
        self.count += 1
        differences = largest_difference(expected, answer)
        for block in ("force", "torque", "stress"):
            self.terms |= expected[block].keys()
            self.acting |= {term for term, value in expected[block].items() if np.any(value)}
        for term, difference in differences.items():
            self.worst[term] = max(self.worst.get(term, 0), difference)
        wrong = {term: d for term, d in differences.items() if not d <= TOLERANCE}
        if wrong:
            self.fail(name, ", ".join(f"{term} {d:.1e}" for term, d in sorted(wrong.items())))

    def fail(self, name, what):
        self.failures += 1
        print(f"{name}: {what}")

    def end(self):
        for term, difference in sorted(self.worst.items()):
            print(f"{term:32}{difference:9.1e}")
        for term in sorted(self.terms - self.acting):
            self.fail(term, "is zero everywhere: nothing was compared")
        print(f"{self.failures} of {self.count} configurations or terms fail; the tolerance is {TOLERANCE:g}")
        sys.exit(1 if self.failures or not self.count else 0)


def scene_of(arguments):
    return json.loads(arguments.scene.read_text()) if arguments.scene else SCENE


def make(arguments):
    configuration = random_configuration(arguments.mixture, scene_of(arguments), arguments.seed)
    case = {"configuration": configuration, "expected": evaluate(configuration)}
    print(json.dumps(case, separators=(",", ":")))


def answer_of(engine, configuration):
    with tempfile.NamedTemporaryFile("w", suffix=".json") as file:
        json.dump(configuration, file)
        file.flush()
        return subprocess.run([engine, "forces", file.name], capture_output=True, text=True)


def variants(scene, seed):
    """Yields scenes of all terms, with other numbers for each seed, and of each block's laws alone."""
    scene = varied(scene, np.random.default_rng(seed))
    yield "all terms", scene
    for block in PAIR_TERMS:
        if block in scene:
            yield f"{block} alone", with_only(scene, block)


def check(arguments):
    comparison = Comparison()
    for mixture in MIXTURES:
        for seed in range(1, arguments.seeds + 1):
            for text, scene in variants(scene_of(arguments), seed):
                name = f"{mixture}, seed {seed}, {text}"
                compare(comparison, name, arguments.engine, random_configuration(mixture, scene, seed))
    comparison.end()


def packing(arguments):
    comparison = Comparison()
    lines = arguments.final.read_text().splitlines()
    configuration = packed_configuration(lines, scene_of(arguments), seed=1)
    compare(comparison, arguments.final, arguments.engine, configuration)
    comparison.end()


def compare(comparison, name, engine, configuration):
    done = answer_of(engine, configuration)
    if done.returncode != 0:
        comparison.fail(name, f"exit code {done.returncode}: {done.stderr.strip()}")
        return
    comparison.add(name, evaluate(configuration), json.loads(done.stdout))


def confirm(arguments):
    comparison = Comparison()
    for path in arguments.cases or sorted(CASES.glob("*.json")):
        case = json.loads(path.read_text())
        comparison.add(path.name, evaluate(case["configuration"]), case["expected"])
    comparison.end()


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    verbs = parser.add_subparsers(required=True)
    blocks = "the blocks fluid, flow, contact, lubrication, repulsion, attraction; all that engines have unless given"
    verb = verbs.add_parser("make")
    verb.add_argument("mixture", choices=MIXTURES)
    verb.add_argument("seed", type=int)
    verb.add_argument("--scene", type=Path, help=blocks)
    verb.set_defaults(perform=make)
    verb = verbs.add_parser("check")
    verb.add_argument("engine")
    verb.add_argument("--seeds", type=int, default=3, help="of each mixture of sizes")
    verb.add_argument("--scene", type=Path, help=blocks)
    verb.set_defaults(perform=check)
    verb = verbs.add_parser("packing")
    verb.add_argument("engine")
    verb.add_argument("final", type=Path)
    verb.add_argument("--scene", type=Path, help=blocks)
    verb.set_defaults(perform=packing)
    verb = verbs.add_parser("confirm")
    verb.add_argument("cases", nargs="*", type=Path)
    verb.set_defaults(perform=confirm)
    arguments = parser.parse_args()
    arguments.perform(arguments)


main()
