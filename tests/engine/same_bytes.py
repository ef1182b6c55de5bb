#!/usr/bin/python3
"""same_bytes.py BEFORE AFTER [--jobs N]

Tests whether two builds of peclet-engine agree to the last bit. Runs short scenes of every combination of
terms with explicit and implicit steps, and some others (a fluid at rest, waves, other flows, other pair
laws, four sizes, two threads, a larger system, every observable), with every instruction set of this
processor. Prints every field of the results that differs: in how many runs, by which largest relative
difference, and in which run first. Fields about the build and the machine are left out.

The exit code is 1 if trajectories differ (`final_state_sha256` and `ending`) or a scene does not test what
it should. Other fields are means and numbers of a trajectory; rounding differences there may be intended.
"""
import argparse
import concurrent.futures
import itertools
import json
import os
import subprocess
import sys
import tempfile

TRAJECTORY = ("/final_state_sha256", "/ending")
OF_THE_MACHINE = ("/cost", "/engine")
SETS = ("baseline", "avx2", "avx512")

SCENE = {
    "particles": {
        "count": 60,
        "density": 0.1,
        "species": [{"radius": 1, "volume_share": 0.5}, {"radius": 1.4, "volume_share": 0.5}],
    },
    "volume_fraction": 0.55,
    "fluid": {"viscosity": 0.1},
    "flow": {"shear_rate": 1},
    "guard": {"largest_overlap": 0.9, "largest_displacement": 0.9},
    "duration": {"equilibration": {"time": 0.1}, "production": {"time": 0.4}},
}
METHODS = {"explicit": {"method": "explicit", "timestep": 0.002}, "implicit": {"method": "implicit"}}
LUBRICATION = {"lubrication": {"form": "kim-karrila", "inner_gap": 0.03, "outer_gap": 0.1}}
REPULSION = {"repulsion": {"form": "exponential", "strength": 0.2, "relative_length": 0.02, "cutoff_lengths": 5}}
SCREENED = {"repulsion": {"form": "screened", "force": 5, "debye_length": 0.03, "reference_radius": 1}}
ATTRACTION = {"attraction": {"hamaker": 0.05, "regularisation": 0.01, "cutoff": 0.1}}
WAVES = {"flow": {"waves": [{"periods": 1, "sine": 0.5}, {"periods": 2, "cosine": 0.2}], "faxen": False}}
FLOWS = {
    "oscillation": {"oscillation": {"amplitude": 0.1, "frequency": 20}},
    "cross shear": {"shear_rate": 1, "cross_shear": {"amplitude": 0.1, "frequency": 20}},
    "segments": {
        "segments": [
            {"shear_rate": 1, "time": 0.2},
            {"shear_rate": -1, "final_rate": 0, "time": 0.2},
            {"shear_rate": 1},
        ]
    },
    "extension": {"extension_rate": 1},
    "stress": {"stress": 1},
}
NOISE = {"fluid": {"thermal_energy": 0.02}}
ROUGH = {"normal_stiffness": 1e3, "friction": 0.5}
CONTACTS = {
    "": {},
    "contact": {"normal_stiffness": 1e3},
    "friction": ROUGH,
    "kinetic friction": ROUGH | {"kinetic_friction": 0.3},
    "rolling": ROUGH | {"rolling_stiffness": 500, "rolling_friction": 0.2},
}
CONTACTS |= {f"{name} damping": keys | {"normal_damping": 1} for name, keys in CONTACTS.items() if keys}
FRICTION = {"contact": ROUGH}
EVERY_OBSERVABLE = {
    "observables": ["stress", "mean_squared_displacement", "pair_distribution", "contact_network", "profiles"]
}
FOUR_SIZES = {"particles": {"species": [{"radius": a, "volume_share": 0.25} for a in (1, 1.4, 2, 3)]}}
AT_REST = {"flow": {"shear_rate": 0}, "observables": ["stress", "mean_squared_displacement", "stress_correlation"]}
LARGE = {
    "particles": {"count": 5000},
    "volume_fraction": 0.4,
    "duration": {"equilibration": {"time": 0}, "production": {"time": 0.08}},
    "integrator": {"timestep": 0.0025},
}


def merged(*parts):
    """Returns the JSON merge of `parts`, without removals."""
    result = {}
    for part in parts:
        for key, value in part.items():
            both = isinstance(value, dict) and isinstance(result.get(key), dict)
            result[key] = merged(result[key], value) if both else value
    return result


def scenes():
    """Yields (name, scene, threads)."""
    for method, integrator in METHODS.items():
        base = merged(SCENE, {"integrator": integrator})
        for (touch, contact), lubrication, noise, repulsion in itertools.product(
            CONTACTS.items(), (False, True), (False, True), (False, True)
        ):
            parts = [{"contact": contact}] if contact else []
            words = [method, touch] + ["lubrication"] * lubrication + ["noise"] * noise + ["repulsion"] * repulsion
            parts += [LUBRICATION] * lubrication + [NOISE] * noise + [REPULSION] * repulsion
            yield " ".join(filter(None, words)), merged(base, *parts), 1
        rough = merged(base, LUBRICATION, FRICTION)
        yield f"{method}, every observable", merged(rough, NOISE, EVERY_OBSERVABLE, {"particles": {"count": 70}}), 1
        yield f"{method}, four sizes", merged(rough, REPULSION, FOUR_SIZES), 1
        yield f"{method}, attraction", merged(rough, ATTRACTION), 1
        yield f"{method}, attraction and repulsion, noise", merged(rough, ATTRACTION, SCREENED, NOISE), 1
        yield f"{method}, screened repulsion", merged(rough, SCREENED), 1
        yield f"{method}, waves", merged(rough, WAVES), 1
        yield f"{method}, waves alone, noise", merged(
            rough, WAVES, NOISE, {"flow": {"shear_rate": 0, "faxen": True}}
        ), 1
        for (flow, keys), noise in itertools.product(FLOWS.items(), (False, True)):
            given = merged(rough, *[NOISE] * noise) | {"flow": keys}
            yield f"{method}, {flow}" + ", noise" * noise, given, 1
        yield f"{method}, at rest", merged(base, LUBRICATION, NOISE, AT_REST), 1
        yield f"{method}, two threads", merged(rough, {"particles": {"count": 200}}), 2
        yield f"{method}, several blocks", merged(base, LUBRICATION, LARGE), 1


def has_set(engine, name):
    environment = os.environ | {"PECLET_INSTRUCTION_SET": name}
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "scene.json")
        with open(path, "w") as file:
            json.dump(merged(SCENE, {"integrator": METHODS["explicit"]}), file)
        return subprocess.run([engine, "run", path, "--quiet"], env=environment, capture_output=True).returncode == 0


def leaves(value, pointer=""):
    items = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else None
    if items is None:
        yield pointer, value
        return
    for key, part in items:
        if f"{pointer}/{key}" not in OF_THE_MACHINE:
            yield from leaves(part, f"{pointer}/{key}")


def result_of(engine, path, threads, instruction_set):
    environment = os.environ | {"PECLET_INSTRUCTION_SET": instruction_set}
    done = subprocess.run(
        [engine, "run", path, "--quiet", "--seed", "7", "--threads", str(threads)],
        env=environment,
        capture_output=True,
        text=True,
    )
    if done.returncode != 0:
        raise SystemExit(f"same_bytes.py: {engine} run {path}: exit {done.returncode}\n{done.stderr}")
    return json.loads(done.stdout)


def field_of(pointer):
    """Returns the field without the indices of its lists, which would give a line each."""
    return "/".join("*" if part.isdigit() else part for part in pointer.split("/"))


def relative(a, b):
    numbers = isinstance(a, (int, float)) and isinstance(b, (int, float))
    return abs(a - b) / max(abs(a), abs(b)) if numbers else None


class Differences:
    def __init__(self):
        self.fields = {}

    def add(self, run, before, after):
        before, after = dict(leaves(before)), dict(leaves(after))
        for pointer in before.keys() | after.keys():
            a, b = before.get(pointer, "absent"), after.get(pointer, "absent")
            if a != b:
                field = self.fields.setdefault(field_of(pointer), {"runs": {}, "largest": None})
                field["runs"][run] = None
                size = relative(a, b)
                if size is not None:
                    field["largest"] = max(size, field["largest"] or 0)

    def trajectories(self):
        return any(field.startswith(TRAJECTORY) for field in self.fields)

    def table(self):
        width = max(map(len, self.fields), default=0)
        rows = [f"{'field':{width}}  runs  largest  first"]
        for field, found in sorted(self.fields.items()):
            size = "-" if found["largest"] is None else f"{found['largest']:.1e}"
            rows.append(f"{field:{width}}  {len(found['runs']):4}  {size:>7}  {next(iter(found['runs']))}")
        return "\n".join(rows)


def faults_of(results):
    """Returns scenes that test nothing: without any contact, or with the end of another scene."""
    faults, ends = [], {}
    for (name, instruction_set), (scene, result) in results.items():
        state = result["final_state_sha256"]
        if state is None:
            faults.append(f"{name}, {instruction_set}: ended with {result['ending']['cause']}")
            continue
        if "contact" in scene and not result["mean"]["contacts_per_particle"] > 0:
            faults.append(f"{name}, {instruction_set}: no contact was made")
        other = ends.setdefault((instruction_set, state), name)
        if other != name:
            faults.append(f"{name}, {instruction_set}: the same end as {other}")
    return faults


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("before")
    parser.add_argument("after")
    parser.add_argument("--jobs", type=int, default=1)
    options = parser.parse_args()
    engines = [os.path.abspath(options.before), os.path.abspath(options.after)]
    sets = [name for name in SETS if all(has_set(engine, name) for engine in engines)]
    results, differences = {}, Differences()
    with tempfile.TemporaryDirectory() as folder, concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        pending = {}
        for number, (name, scene, threads) in enumerate(scenes()):
            path = os.path.join(folder, f"{number}.json")
            with open(path, "w") as file:
                json.dump(scene, file)
            for instruction_set in sets:
                pending[name, instruction_set] = scene, [
                    pool.submit(result_of, engine, path, threads, instruction_set) for engine in engines
                ]
        for run, (scene, both) in pending.items():
            before, after = (future.result() for future in both)
            differences.add(", ".join(run), before, after)
            results[run] = scene, after
    print(f"{len(results)} runs of {engines[1]}, each beside {engines[0]}; instruction sets: {', '.join(sets)}")
    print(differences.table() if differences.fields else "every field is the same")
    faults = faults_of(results)
    print("\n".join(faults), end="\n" if faults else "")
    print("trajectories differ" if differences.trajectories() else "every trajectory is the same")
    return 1 if differences.trajectories() or faults or not sets else 0


if __name__ == "__main__":
    sys.exit(main())
