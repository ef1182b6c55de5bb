"""What the drivers of studies share: campaigns made, run and read by the program, and estimates with errors."""
import json
import math
import os
import subprocess
import sys


def merged(base, patch):
    """`base` with `patch` in it, objects key by key; None removes a key."""
    result = dict(base)
    for key, value in patch.items():
        if value is None:
            result.pop(key, None)
        elif isinstance(value, dict) and isinstance(result.get(key), dict):
            result[key] = merged(result[key], value)
        else:
            result[key] = value
    return result


class Program:
    """The two programs of a folder, and a folder that keeps the campaigns: a study goes on where it was."""

    def __init__(self, binaries, folder):
        self.peclet = os.path.join(binaries, "peclet")
        self.engine = os.path.join(os.path.abspath(binaries), "peclet-engine")
        self.folder = folder
        os.makedirs(folder, exist_ok=True)

    def run(self, name, scene, settings, seeds):
        """Runs `seeds` realisations with each of `settings` (objects of pointers and values) and returns the points of the export."""
        pointers = sorted(settings[0])
        campaign = {
            "name": name, "scene": scene,
            "sweep": [{"set": pointers, "values": [[s[p] for p in pointers] for s in settings]}],
            "target": {"observable": "relative_viscosity", "relative_tolerance": 1e-9},
            "realisations": {"minimum": seeds, "maximum": seeds},
            "engine": [self.engine, "serve"],
        }
        path = os.path.join(self.folder, name + ".json")
        with open(path, "w") as f:
            json.dump(campaign, f, indent=1)
        # Points that are not within the tolerance after all seeds, or lost some, are what the study is about: codes 3 and 4.
        done = subprocess.run([self.peclet, "run", path, "--quiet"], stdout=subprocess.DEVNULL)
        if done.returncode not in (0, 3, 4):
            sys.exit(f"{path}: peclet run ended with {done.returncode}")
        return json.loads(subprocess.run([self.peclet, "export", path], check=True, capture_output=True).stdout)["points"]

    def derived(self, scene):
        """What `peclet validate` says of one scene: its time step, groups and warnings."""
        path = os.path.join(self.folder, "scene.json")
        with open(path, "w") as f:
            json.dump({"name": "scene", "scene": scene, "sweep": [],
                       "target": {"observable": "relative_viscosity", "relative_tolerance": 0.1},
                       "realisations": {"minimum": 2, "maximum": 2}, "engine": [self.engine, "serve"]}, f)
        done = subprocess.run([self.peclet, "validate", path, "--json"], capture_output=True, text=True)
        if done.returncode != 0:
            return {"refused": done.stderr.strip()}
        return json.loads(done.stdout)["points"][0]


def estimate(values):
    """Mean and standard error; no error from a single value."""
    mean = sum(values) / len(values)
    if len(values) < 2:
        return mean, math.inf
    return mean, math.sqrt(sum((v - mean) ** 2 for v in values) / (len(values) - 1) / len(values))


def controlled_viscosity(mean):
    """Relative viscosity plus the pairs' Brownian stress, whose mean is zero."""
    control = mean["control_variates"]["brownian_pairwise"]
    return mean["relative_viscosity"] + (control or 0)
