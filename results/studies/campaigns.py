"""Makes, runs and reads campaigns, and turns viscosities of their points, split by term, into rows of a table."""
import collections
import functools
import json
import math
import operator
import os
import shutil
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
    """Returns the text of a stored result (schema/README.md, Tables and views)."""
    stream = zlib.decompressobj(zdict=dictionary.encode())
    return stream.decompress(result) + stream.flush()


def read_results(folder):
    """Returns a list of (settings, whole results with blocks) of the points with results, from a campaign's folder."""
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
    """A point of an export, a dictionary, with properties of its realisations that have means."""

    @property
    def results(self):
        """Results with means."""
        return [result for result in self["realisations"] if result.get("mean")]

    @property
    def means(self):
        return [result["mean"] for result in self.results]

    @property
    def seconds(self):
        """Processor time of all realisations [s]."""
        return sum(result["cost"]["cpu_seconds"] for result in self["realisations"])

    @property
    def lost(self):
        """Number of realisations without means."""
        return len(self["realisations"]) - len(self.results)

    def by_seed(self, quantity="relative_viscosity"):
        return {result["seed"]: result["mean"][quantity] for result in self.results}

    def measured(self, quantity, *element):
        """Returns the mean over seeds and its standard error, as exported; `element` are the indices in a list.

        Without a mean: NaN and infinity.
        """
        found = self["quantities"].get(quantity, {"mean": None, "standard_error": None})
        mean, error = (found[key] for key in ("mean", "standard_error"))
        if mean is not None:
            mean, error = (functools.reduce(operator.getitem, element, of) for of in (mean, error))
        return math.nan if mean is None else mean, math.inf if error is None else error


def carry_out(words, allowed=(0,)):
    """Runs a command; exits if its code is not allowed. The command reports errors on standard error."""
    code = subprocess.run(words, stdout=subprocess.DEVNULL).returncode
    if code not in allowed:
        sys.exit(f"{' '.join(words[:3])}: ended with {code}")


class Program:
    """The two programs in folder `binaries`, and the folder of a study's campaigns, which a second call continues."""

    def __init__(self, binaries, folder):
        self.peclet = os.path.join(binaries, "peclet")
        self.engine = os.path.join(os.path.abspath(binaries), "peclet-engine")
        self.folder = folder
        self.commits = set()  # of the engines of the results
        self.processor_seconds = 0.0  # of all results
        self._seconds = {}  # processor time of campaigns, by name
        self.long = False  # True: include points that take hours
        self.times = 1  # factor of the number of seeds
        os.makedirs(folder, exist_ok=True)

    def _path(self, name):
        return os.path.join(self.folder, name)

    def write(self, name, scene, settings, seeds, observable="relative_viscosity"):
        """Writes the file of a campaign, arguments as for run(), and returns its path."""
        pointers = sorted(settings[0])
        sweep = [{"set": pointers, "values": [[s[p] for p in pointers] for s in settings]}] if pointers else []
        how = {"observable": observable, "realisations": seeds * self.times, "engine": [self.engine, "serve"]}
        return Campaign(name, scene, sweep, **how).write(self._path(f"{name}.json"))

    def run(self, name, scene, settings, seeds, observable="relative_viscosity", options=()):
        """Runs `seeds` * self.times realisations of each of `settings` and returns the Points of the export.

        `settings` are dictionaries of values by JSON pointer. `observable` may be any number of the results. `options`
        are further options of `peclet run`.
        """
        return self._carry_out(name, self.write(name, scene, settings, seeds, observable), options)

    def run_file(self, path):
        """Runs a copy of a campaign file in the folder and returns the Points of the export."""
        return self._carry_out(path.stem, shutil.copy(path, self.folder))

    def _carry_out(self, name, path, options=()):
        # Exit code 3: some points lost seeds. Studies accept those that the engine ended, and no others.
        carry_out([self.peclet, "run", path, "--quiet", *options], allowed=(0, 3))
        for point in json.loads(ask(self.peclet, "status", path, "--json"))["points"]:
            if point["seeds"]["quarantined"]:
                sys.exit(f"{path}: {point['label']}: seeds were given up: {point['loss_reasons']}")
        export = json.loads(ask(self.peclet, "export", path))
        for engine in export["engines"].values():
            self._note(engine)
        points = [Point(point) for point in export["points"]]
        # A campaign that runs again with more points still has its earlier realisations.
        seconds = sum(point.seconds for point in points)
        self.processor_seconds += seconds - self._seconds.get(name, 0.0)
        self._seconds[name] = seconds
        return points

    def rows(self, name, scene, pointers, cases, seeds, *others):
        """Runs a campaign and returns a row for each case: its values by column, and viscosity_row() with `others`.

        `pointers` are JSON pointers by column; a case is a sequence of their values.
        """
        settings = [dict(zip(pointers.values(), case)) for case in cases]
        points = self.run(name, scene, settings, seeds)
        return [dict(zip(pointers, case)) | viscosity_row(point, *others) for case, point in zip(cases, points)]

    def _note(self, engine):
        self.commits.add(engine["git_commit"][:7] + ("+" if engine["git_dirty"] else ""))

    def run_alone(self, name, scene, threads, seed=0):
        """Runs one seed of a scene without a campaign; returns its result with blocks. The scene's files are NAME.…"""
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
        """Returns the whole results with blocks of a campaign of run(): a list for each point with results."""
        return [results for _, results in read_results(self._path(f"{name}.peclet"))]

    def final_configurations(self, name, point):
        """Returns the paths of the files that the realisations of a point have left."""
        folder = self._path(f"{name}.peclet")
        return [os.path.join(folder, f["path"]) for r in point["realisations"] for f in r.get("files") or []]

    def asked(self, command, name, *options):
        """Returns the JSON output of `peclet COMMAND` for a campaign of write() or run()."""
        return json.loads(ask(self.peclet, command, self._path(f"{name}.json"), "--json", *options))

    def derived(self, scene, observable="relative_viscosity", settings=None):
        """Returns the answer of `peclet validate` for one scene: time step, groups and warnings; or {refused}.

        `observable` may be any number of the results. `settings` are values by JSON pointer, as for run().
        """
        path = self.write("scene", scene, [settings or {}], 1, observable)
        done = subprocess.run([self.peclet, "validate", path, "--json"], capture_output=True, text=True)
        if done.returncode == 2:
            return {"refused": done.stderr.strip()}
        if done.returncode != 0:
            sys.exit(f"{path}: peclet validate ended with {done.returncode}: {done.stderr.strip()}")
        return json.loads(done.stdout)["points"][0]

    def part_of_step(self, part, *scene):
        """Returns the integrator block of implicit steps of this part of the automatic one of derived(*scene)."""
        return {"method": "implicit", "timestep": part * self.derived(*scene)["timestep"]}


def term(mean, *names):
    """Returns the sum of the named terms of the shear stress over viscosity * rate; terms that are absent are 0."""
    return sum(mean["stress"][n][3] for n in names if n in mean["stress"])


TERMS = {
    "lubrication": ("lubrication", "brownian_lubrication"),
    "contact": ("contact_normal", "contact_damping", "friction", "rolling"),
    "repulsion": ("repulsion",),
}


def viscosity_row(point, *others):
    """Returns a row with the viscosities of a point of an export, and their standard errors NAME_error:

    viscosity     relative viscosity
    pairs         relative viscosity without 1 + 2.5 phi, as plotted in Li's thesis
    lubrication, contact, repulsion    terms of pairs; lubrication includes the random forces
    structural    structural Brownian stress, not part of a sum
    others        names of further quantities

    It also has `seeds` with means, `lost` ones, and `transient` (1: the window begins too early).
    """
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
    """Returns the number of realisations with each of the warnings FLAGS."""
    warnings = [{w["code"] for w in r.get("warnings") or []} for r in point.results]
    return collections.Counter(code for codes in warnings for code in codes & set(FLAGS))


def counts_text(counter):
    return " ".join(f"{name}:{count}" for name, count in sorted(counter.items()))
