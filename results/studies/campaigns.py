"""Campaigns, made, run and read by the program, and viscosities of their points, split by term, as rows of a table."""
import collections
import functools
import json
import math
import operator
import os
import sqlite3
import subprocess
import sys
import zlib

from peclet.campaign import Campaign
from peclet.program import ask

from studies.estimates import estimate
from studies.tables import entries

FLAGS = ("timestep", "solver", "overlap")


def inflated(result, dictionary):
    """The text of a stored result (schema/README.md, Tables and views)."""
    stream = zlib.decompressobj(zdict=dictionary.encode())
    return stream.decompress(result) + stream.flush()


def read_results(folder):
    """Returns, of the folder of a campaign, the settings and the whole results, with blocks, of every point with
    results."""
    database = sqlite3.connect(f"file:{os.path.join(folder, 'campaign.db')}?mode=ro", uri=True)
    stored = database.execute(
        "SELECT place, settings, result, dictionary FROM realisations JOIN points USING (place) "
        "WHERE realisations.state = 'done' ORDER BY place, seed"
    )
    points = {}
    for place, settings, result, dictionary in stored:
        points.setdefault(place, (json.loads(settings), []))[1].append(json.loads(inflated(result, dictionary)))
    database.close()
    return list(points.values())


class Point(dict):
    """A point of an export, by its keys, and what its realisations that ended well have."""

    @property
    def results(self):
        return [result for result in self["realisations"] if result.get("mean")]

    @property
    def means(self):
        return [result["mean"] for result in self.results]

    @property
    def seconds(self):
        """Processor time that its realisations took."""
        return sum(result["cost"]["cpu_seconds"] for result in self["realisations"])

    @property
    def lost(self):
        return len(self["realisations"]) - len(self.results)

    def by_seed(self, quantity="relative_viscosity"):
        return {result["seed"]: result["mean"][quantity] for result in self.results}

    def measured(self, quantity, *element):
        """The export's mean over the seeds and its standard error, of an element where the quantity is a list."""
        found = self["quantities"].get(quantity, {"mean": None, "standard_error": None})
        mean, error = (found[key] for key in ("mean", "standard_error"))
        if mean is not None:
            mean, error = (functools.reduce(operator.getitem, element, of) for of in (mean, error))
        return math.nan if mean is None else mean, math.inf if error is None else error


def carry_out(words, allowed=(0,)):
    """Runs a command, which says what is wrong on standard error, and ends the study where it fails."""
    code = subprocess.run(words, stdout=subprocess.DEVNULL).returncode
    if code not in allowed:
        sys.exit(f"{' '.join(words[:3])}: ended with {code}")


class Program:
    """The two programs of a folder, and a folder that keeps the campaigns: a study goes on where it was."""

    def __init__(self, binaries, folder):
        self.peclet = os.path.join(binaries, "peclet")
        self.engine = os.path.join(os.path.abspath(binaries), "peclet-engine")
        self.folder = folder
        self.commits = set()  # of the engines that the results are of
        self.processor_seconds = 0.0  # that they took
        self._seconds = {}  # of campaigns, by name
        self.long = False  # whether points that take hours are wanted
        self.times = 1  # as many seeds
        os.makedirs(folder, exist_ok=True)

    def _path(self, name):
        return os.path.join(self.folder, name)

    def write(self, name, scene, settings, seeds, observable="relative_viscosity"):
        """Writes the campaign's file, as run() has it, and returns its path."""
        pointers = sorted(settings[0])
        sweep = [{"set": pointers, "values": [[s[p] for p in pointers] for s in settings]}] if pointers else []
        how = {"observable": observable, "realisations": seeds * self.times, "engine": [self.engine, "serve"]}
        return Campaign(name, scene, sweep, **how).write(self._path(f"{name}.json"))

    def run(self, name, scene, settings, seeds, observable="relative_viscosity", options=()):
        """Runs `seeds` realisations, times `times`, with each of `settings` (objects of pointers and values) and
        returns the Points of the export. `observable` only has to be a number that the results have; `options` are for
        `peclet run`."""
        path = self.write(name, scene, settings, seeds, observable)
        # Points that lost seeds are among what studies are made of: code 3.
        carry_out([self.peclet, "run", path, "--quiet", *options], allowed=(0, 3))
        export = json.loads(ask(self.peclet, "export", path))
        for engine in export["engines"].values():
            self._note(engine)
        points = [Point(point) for point in export["points"]]
        # A campaign that runs again, with more points, has the realisations of before.
        seconds = sum(point.seconds for point in points)
        self.processor_seconds += seconds - self._seconds.get(name, 0.0)
        self._seconds[name] = seconds
        return points

    def rows(self, name, scene, pointers, cases, seeds, *others):
        """Runs a campaign of cases, which are values at `pointers` (by column), and returns a row of each: these
        columns, and viscosity_row() with `others`."""
        settings = [dict(zip(pointers.values(), case)) for case in cases]
        points = self.run(name, scene, settings, seeds)
        return [dict(zip(pointers, case)) | viscosity_row(point, *others) for case, point in zip(cases, points)]

    def _note(self, engine):
        self.commits.add(engine["git_commit"][:7] + ("+" if engine["git_dirty"] else ""))

    def run_alone(self, name, scene, threads, seed=0):
        """Runs a seed of a scene without a campaign and returns its whole result, with blocks; files NAME.… beside it
        have what the scene leaves."""
        path, output = self._path(f"{name}.scene.json"), self._path(f"{name}.json")
        if not os.path.exists(output):
            with open(path, "w") as f:
                json.dump(scene, f, indent=1)
            options = ["--threads", str(threads), "--seed", str(seed)]
            arguments = [*options, "--checkpoint", output + ".checkpoint", "--output", output]
            carry_out([self.engine, "run", path, "--quiet", *arguments])
        with open(output) as f:
            result = json.load(f)
        self._note(result["engine"])
        self.processor_seconds += result["cost"]["cpu_seconds"]
        return result

    def stored_results(self, name):
        """Returns the whole results, with blocks, of every point of a campaign that run() made, in the order of its
        settings; those that have means."""
        return [results for _, results in read_results(self._path(f"{name}.peclet"))]

    def final_configurations(self, name, point):
        """Returns the paths of those that a point of a campaign has left."""
        folder = self._path(f"{name}.peclet")
        return [os.path.join(folder, f["path"]) for r in point["realisations"] for f in r.get("files") or []]

    def asked(self, command, name, *options):
        """Returns what a command of `peclet` says, as JSON, of a campaign that write() or run() made."""
        return json.loads(ask(self.peclet, command, self._path(f"{name}.json"), "--json", *options))

    def derived(self, scene, observable="relative_viscosity"):
        """Returns what `peclet validate` says of one scene: its time step, groups and warnings, or why it is refused.
        `observable` only has to be a number that its results have."""
        path = self.write("scene", scene, [{}], 1, observable)
        done = subprocess.run([self.peclet, "validate", path, "--json"], capture_output=True, text=True)
        if done.returncode == 2:
            return {"refused": done.stderr.strip()}
        if done.returncode != 0:
            sys.exit(f"{path}: peclet validate ended with {done.returncode}: {done.stderr.strip()}")
        return json.loads(done.stdout)["points"][0]


def term(mean, *names):
    """Sum of terms of the shear stress over viscosity and rate; those that the scene lacks are 0."""
    return sum(mean["stress"][n][3] for n in names if n in mean["stress"])


TERMS = {
    "lubrication": ("lubrication", "brownian_lubrication"),
    "contact": ("contact_normal", "contact_damping", "friction", "rolling"),
    "repulsion": ("repulsion",),
}


def viscosity_row(point, *others):
    """Returns of a point of an export the `seeds` that ended well and were `lost`, whether the window is `transient`,
    and with its standard error (NAME_error) each of
    viscosity     relative, with 1 + 2.5 phi
    pairs         the same without 1 + 2.5 phi: what Li's thesis plots
    lubrication, contact, repulsion    its terms; lubrication with the random forces
    structural    the structural Brownian stress, which belongs to no sum
    and of `others`: quantities of the export."""
    numbers = {
        "viscosity": point.measured("relative_viscosity"),
        "pairs": point.measured("relative_viscosity_pair"),
        "structural": point.measured("brownian_structural", 3),
        **{name: point.measured(name) for name in others},
    }
    means = point.means
    for name, terms in TERMS.items():
        numbers[name] = estimate([term(mean, *terms) for mean in means]) if means else (math.nan, math.inf)
    row = {"seeds": len(means), "lost": point.lost, "transient": int(bool((point["stop_test"] or {}).get("transient")))}
    for name, pair in numbers.items():
        row |= entries(name, pair)
    return row


def flags(point):
    """How many completed realisations warn of what."""
    warnings = [{w["code"] for w in r.get("warnings") or []} for r in point.results]
    return collections.Counter(code for codes in warnings for code in codes & set(FLAGS))


def counts_text(counter):
    return " ".join(f"{name}:{count}" for name, count in sorted(counter.items()))
