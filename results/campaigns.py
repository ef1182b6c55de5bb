"""What the drivers of studies share: campaigns made, run and read by the program, and estimates with errors."""
import argparse
import collections
import csv
import json
import math
import os
import random
import sqlite3
import subprocess
import sys
import tempfile
import zlib


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


# The published system without noise and friction, at a Stokes number of 0.045.
REFERENCE_SCENE = {
    "particles": {
        "count": 1000,
        "density": 0.1,
        "species": [{"radius": 1.0, "volume_share": 0.5}, {"radius": 1.4, "volume_share": 0.5}],
    },
    "volume_fraction": 0.5,
    "fluid": {"viscosity": 0.1},
    "flow": {"shear_rate": 0.045},
    "contact": {"normal_stiffness": 1e4},
    "lubrication": {"form": "kim-karrila", "inner_gap": 1e-3, "outer_gap": 0.05},
    "duration": {"equilibration": {"strain": 1}, "production": {"strain": 2}},
}


# Table 4.1 of Li's thesis, with N = 250 and windows that end with a strain or, at small Peclet numbers, with Brownian times. Ten of these
# are no equilibration: the viscosity at Pe = 0.1 and phi = 0.5 still rises after 50 (results/control-variates); a^2 / D_0 is 19.
TABLE_SCENE = merged(
    REFERENCE_SCENE,
    {
        "particles": {"count": 250},
        "flow": None,
        "peclet": 1,
        "limits": {"shear_rate": 0.009, "thermal_energy": 0.017},
        "duration": {
            "equilibration": {"strain": 1, "brownian_times": 100},
            "production": {"strain": 2, "brownian_times": 40},
        },
    },
)


def at_peclet(number):
    """A patch: noise and flow at this Peclet number, as in the published table but five times as fast where kT allows it."""
    return {"flow": None, "peclet": number, "limits": {"shear_rate": 0.045, "thermal_energy": 0.017}}


def inflated(result, dictionary):
    """The text of a stored result (schema/README.md, Tables and views)."""
    stream = zlib.decompressobj(zdict=dictionary.encode())
    return stream.decompress(result) + stream.flush()


class Program:
    """The two programs of a folder, and a folder that keeps the campaigns: a study goes on where it was."""

    def __init__(self, binaries, folder):
        self.peclet = os.path.join(binaries, "peclet")
        self.engine = os.path.join(os.path.abspath(binaries), "peclet-engine")
        self.folder = folder
        self.commits = set()  # of the engines that the results are of
        self.processor_seconds = 0.0  # that they took
        self.long = False  # whether points that take hours are wanted
        self.times = 1  # as many seeds
        os.makedirs(folder, exist_ok=True)

    def run(self, name, scene, settings, seeds, observable="relative_viscosity", options=()):
        """Runs `seeds` realisations, times `times`, with each of `settings` (objects of pointers and values) and returns the points of the export.
        `observable` only has to be a number that the results have; `options` are for `peclet run`."""
        pointers = sorted(settings[0])
        seeds *= self.times
        campaign = {
            "name": name,
            "scene": scene,
            "sweep": [{"set": pointers, "values": [[s[p] for p in pointers] for s in settings]}],
            "target": {"observable": observable, "relative_tolerance": 1e-9},
            "realisations": {"minimum": seeds, "maximum": seeds},
            "engine": [self.engine, "serve"],
        }
        path = os.path.join(self.folder, name + ".json")
        with open(path, "w") as f:
            json.dump(campaign, f, indent=1)
        # Points that are not within the tolerance after all seeds, or lost some, are what studies are made of: code 3.
        done = subprocess.run([self.peclet, "run", path, "--quiet", *options], stdout=subprocess.DEVNULL)
        if done.returncode not in (0, 3):
            sys.exit(f"{path}: peclet run ended with {done.returncode}")
        export = json.loads(subprocess.run([self.peclet, "export", path], check=True, capture_output=True).stdout)
        self.commits |= {
            engine["git_commit"][:7] + ("+" if engine["git_dirty"] else "") for engine in export["engines"].values()
        }
        self.processor_seconds += sum(
            r["cost"]["cpu_seconds"] for point in export["points"] for r in point["realisations"]
        )
        return export["points"]

    def stored_results(self, name):
        """Of a campaign that run() made: the whole results, with blocks, of every point in the order of its settings; those that have means."""
        database = sqlite3.connect(f"file:{os.path.join(self.folder, name)}.peclet/campaign.db?mode=ro", uri=True)
        points = {}
        for place, result, dictionary in database.execute(
            "SELECT place, result, dictionary FROM realisations WHERE state = 'done' ORDER BY place, seed"
        ):
            points.setdefault(place, []).append(json.loads(inflated(result, dictionary)))
        database.close()
        return [points[place] for place in sorted(points)]

    def derived(self, scene):
        """What `peclet validate` says of one scene: its time step, groups and warnings."""
        path = os.path.join(self.folder, "scene.json")
        with open(path, "w") as f:
            json.dump(
                {
                    "name": "scene",
                    "scene": scene,
                    "sweep": [],
                    "target": {"observable": "relative_viscosity", "relative_tolerance": 0.1},
                    "realisations": {"minimum": 2, "maximum": 2},
                    "engine": [self.engine, "serve"],
                },
                f,
            )
        done = subprocess.run([self.peclet, "validate", path, "--json"], capture_output=True, text=True)
        if done.returncode == 2:
            return {"refused": done.stderr.strip()}
        if done.returncode != 0:
            sys.exit(f"{path}: peclet validate ended with {done.returncode}: {done.stderr.strip()}")
        return json.loads(done.stdout)["points"][0]


def estimate(values):
    """Mean and standard error; no error from a single value."""
    mean = sum(values) / len(values)
    if len(values) < 2:
        return mean, math.inf
    return mean, math.sqrt(sum((v - mean) ** 2 for v in values) / (len(values) - 1) / len(values))


def student_quantile(degrees, probability):
    """The t that Student's variate stays below with `probability` > 1/2, by integrating its density and halving."""
    if degrees < 1:
        return math.inf
    norm = math.exp(math.lgamma((degrees + 1) / 2) - math.lgamma(degrees / 2)) / math.sqrt(degrees * math.pi)

    def between_0_and(t):  # Simpson's rule in the angle: t = sqrt(degrees) tan a
        top, steps = math.atan(t / math.sqrt(degrees)), 200
        weights = [1, *[4, 2] * (steps // 2 - 1), 4, 1]
        return (
            sum(w * math.cos(top * k / steps) ** (degrees - 1) for k, w in enumerate(weights))
            * top
            / steps
            / 3
            * norm
            * math.sqrt(degrees)
        )

    low, high = 0.0, 1e4
    for _ in range(100):
        middle = (low + high) / 2
        low, high = (middle, high) if between_0_and(middle) < probability - 0.5 else (low, middle)
    return low


def relative_difference(values, reference, paired):
    """Of two objects of values by seed: the difference of their means over that of the reference, its standard error and degrees of
    freedom; of the seeds of both where one packing decides most of the scatter, else of all."""
    common = sorted(values.keys() & reference.keys())
    if paired and common:
        total = estimate([reference[s] for s in common])[0]
        mean, error = estimate([values[s] - reference[s] for s in common])
        return mean / total, error / abs(total), len(common) - 1
    (a, da), (b, db) = estimate(list(values.values())), estimate(list(reference.values()))
    return a / b - 1, abs(a / b) * math.hypot(da / a, db / b), min(len(values), len(reference)) - 1


def controlled_viscosity(mean):
    """Relative viscosity plus the pairs' Brownian stress, whose mean is zero."""
    control = mean["control_variates"]["brownian_pairwise"]
    return mean["relative_viscosity"] + (control or 0)


def pair_viscosity(mean):
    """The same of the pairs alone, without the solvent's 1 and the stresslet's 2.5 phi: what Li's thesis plots."""
    return controlled_viscosity(mean) - mean["relative_viscosity"] + mean["relative_viscosity_pair"]


def values_by_seed(realisations):
    return {r["seed"]: controlled_viscosity(r["mean"]) for r in realisations if r.get("mean")}


def completed(point):
    """Means of the realisations that ended well."""
    return [r["mean"] for r in point["realisations"] if r.get("mean")]


def term(mean, *names):
    """Sum of terms of the shear stress over viscosity and rate; those that the scene lacks are 0."""
    return sum(mean["stress"][n][3] for n in names if n in mean["stress"])


def viscosity_row(point, *others):
    """Of a point of an export: `seeds` that ended well and were `lost`, whether the window is `transient`, and with its standard error
    (NAME_error) each of
    viscosity     relative, with 1 + 2.5 phi and the control variate
    pairs         the same without 1 + 2.5 phi
    lubrication, contact, repulsion    its terms, without the control variate
    structural    the structural Brownian stress, which belongs to no sum
    and of `others`: numbers directly in the results' mean."""
    means = completed(point)
    quantities = {
        "viscosity": controlled_viscosity,
        "pairs": pair_viscosity,
        "lubrication": lambda m: term(m, "lubrication"),
        "contact": lambda m: term(m, "contact_normal", "contact_damping", "friction", "rolling"),
        "repulsion": lambda m: term(m, "repulsion"),
        "structural": lambda m: m["brownian_structural"][3],
        **{name: (lambda m, name=name: m[name]) for name in others},
    }
    row = {
        "seeds": len(means),
        "lost": len(point["realisations"]) - len(means),
        "transient": int(bool((point["look"] or {}).get("transient"))),
    }
    for name, of in quantities.items():
        row[name], row[f"{name}_error"] = estimate([of(m) for m in means]) if means else (math.nan, math.inf)
    return row


def number(row, name):
    """A number of a row and its standard error."""
    return row[name], row[f"{name}_error"]


def columns_of(*names):
    """Column names of numbers with their errors."""
    return [c for n in names for c in (n, f"{n}_error")]


def quotient(a, b):
    """Of two independent numbers, each with its standard error: their quotient and its standard error."""
    value = a[0] / b[0]
    return value, math.hypot(a[1], value * b[1]) / abs(b[0])


def log_minimum(abscissae, values):
    """log10 of where a curve of positive numbers is lowest: the vertex of the parabola through the logarithms of the lowest point and its
    neighbours; the lowest point itself where it has only one."""
    lowest = min(range(len(values)), key=lambda k: values[k])
    x = [math.log10(a) for a in abscissae]
    if lowest in (0, len(values) - 1):
        return x[lowest]
    (x1, x2, x3), (y1, y2, y3) = x[lowest - 1 : lowest + 2], [
        math.log(max(v, 1e-9)) for v in values[lowest - 1 : lowest + 2]
    ]
    left, right = (y2 - y1) / (x2 - x1), (y3 - y2) / (x3 - x2)
    return (x1 + x2) / 2 - left * (x3 - x1) / 2 / (right - left)


def propagated(numbers, function, draws=400):
    """function([value, ...]) of independent numbers (value, standard error), and its standard error by drawing the numbers again."""
    random_numbers = random.Random(1)
    drawn = [function([random_numbers.gauss(v, e) for v, e in numbers]) for _ in range(draws)]
    middle = sum(drawn) / draws
    return function([v for v, _ in numbers]), math.sqrt(sum((d - middle) ** 2 for d in drawn) / (draws - 1))


FLAGS = ("timestep", "solver", "overlap")


def flags(realisations):
    """How many completed realisations warn of what."""
    return collections.Counter(
        code
        for r in realisations
        if r.get("mean")
        for code in {w["code"] for w in r.get("warnings") or []} & set(FLAGS)
    )


def counts_text(counter):
    return " ".join(f"{name}:{count}" for name, count in sorted(counter.items()))


def drive(description, panels, remake):
    """Reads the command line that every driver of a study has, and calls remake(arguments, folder)."""
    parser = argparse.ArgumentParser(description=description)
    parser.add_argument("binaries")
    parser.add_argument("folder", nargs="?", help="of the campaigns; a temporary one unless given")
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--panel", choices=panels, help="this one alone, into the folder")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as temporary:
        remake(arguments, arguments.folder or temporary)


def write_table(path, columns, rows, digits):
    with open(path, "w", newline="") as f:
        writer = csv.DictWriter(f, columns)
        writer.writeheader()
        for row in rows:
            writer.writerow(
                {k: f"{row[k]:.{digits}g}" if isinstance(row.get(k), float) else row.get(k) for k in columns}
            )
