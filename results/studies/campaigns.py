"""Campaigns, made, run and read by the program."""
import functools
import json
import math
import operator
import os
import sqlite3
import subprocess
import sys
import zlib


def inflated(result, dictionary):
    """The text of a stored result (schema/README.md, Tables and views)."""
    stream = zlib.decompressobj(zdict=dictionary.encode())
    return stream.decompress(result) + stream.flush()


def read_results(folder):
    """Of the folder of a campaign: for every point with results, its settings and its whole results, with blocks, by
    seed."""
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

    def write(self, name, scene, settings, seeds, observable="relative_viscosity"):
        """The path of the campaign's file, as run() has it."""
        pointers = sorted(settings[0])
        seeds *= self.times
        campaign = {
            "name": name,
            "scene": scene,
            "sweep": [{"set": pointers, "values": [[s[p] for p in pointers] for s in settings]}],
            "show": [observable],
            "realisations": seeds,
            "engine": [self.engine, "serve"],
        }
        path = os.path.join(self.folder, name + ".json")
        with open(path, "w") as f:
            json.dump(campaign, f, indent=1)
        return path

    def run(self, name, scene, settings, seeds, observable="relative_viscosity", options=()):
        """Runs `seeds` realisations, times `times`, with each of `settings` (objects of pointers and values) and
        returns the Points of the export. `observable` only has to be a number that the results have; `options` are for
        `peclet run`."""
        path = self.write(name, scene, settings, seeds, observable)
        # Points that lost seeds are among what studies are made of: code 3.
        done = subprocess.run([self.peclet, "run", path, "--quiet", *options], stdout=subprocess.DEVNULL)
        if done.returncode not in (0, 3):
            sys.exit(f"{path}: peclet run ended with {done.returncode}")
        exported = subprocess.run([self.peclet, "export", path], check=True, capture_output=True).stdout
        export = json.loads(exported)
        for engine in export["engines"].values():
            self.commits.add(engine["git_commit"][:7] + ("+" if engine["git_dirty"] else ""))
        realisations = [r for point in export["points"] for r in point["realisations"]]
        seconds = sum(r["cost"]["cpu_seconds"] for r in realisations)
        # A campaign that runs again, with more points, has the realisations of before.
        self.processor_seconds += seconds - self._seconds.get(name, 0.0)
        self._seconds[name] = seconds
        return [Point(point) for point in export["points"]]

    def run_alone(self, name, scene, threads, seed=0):
        """Runs a seed of a scene without a campaign and returns its whole result, with blocks; files NAME.… beside it
        have what the scene leaves."""
        path, output = (os.path.join(self.folder, f"{name}.{kind}") for kind in ("scene.json", "json"))
        if not os.path.exists(output):
            with open(path, "w") as f:
                json.dump(scene, f, indent=1)
            options = ["--threads", str(threads), "--seed", str(seed)]
            arguments = [*options, "--checkpoint", output + ".checkpoint", "--output", output]
            done = subprocess.run([self.engine, "run", path, "--quiet", *arguments])
            if done.returncode != 0:
                sys.exit(f"{path}: peclet-engine run ended with {done.returncode}")
        with open(output) as f:
            result = json.load(f)
        self.commits.add(result["engine"]["git_commit"][:7] + ("+" if result["engine"]["git_dirty"] else ""))
        self.processor_seconds += result["cost"]["cpu_seconds"]
        return result

    def stored_results(self, name):
        """Of a campaign that run() made: the whole results, with blocks, of every point in the order of its settings;
        those that have means."""
        return [results for _, results in read_results(os.path.join(self.folder, name + ".peclet"))]

    def asked(self, command, name, *options):
        """What a command of `peclet` says, as JSON, of a campaign that write() or run() made. One that needs Python
        finds this one."""
        path = os.path.join(self.folder, name + ".json")
        here = {**os.environ, "PATH": f"{os.path.dirname(sys.executable)}:{os.environ['PATH']}"}
        words = [self.peclet, command, path, "--json", *options]
        return json.loads(subprocess.run(words, check=True, stdout=subprocess.PIPE, env=here).stdout)

    def derived(self, scene, observable="relative_viscosity"):
        """What `peclet validate` says of one scene: its time step, groups and warnings. `observable` only has to be a
        number that its results have."""
        path = os.path.join(self.folder, "scene.json")
        campaign = {
            "name": "scene",
            "scene": scene,
            "sweep": [],
            "show": [observable],
            "realisations": 1,
            "engine": [self.engine, "serve"],
        }
        with open(path, "w") as f:
            json.dump(campaign, f)
        done = subprocess.run([self.peclet, "validate", path, "--json"], capture_output=True, text=True)
        if done.returncode == 2:
            return {"refused": done.stderr.strip()}
        if done.returncode != 0:
            sys.exit(f"{path}: peclet validate ended with {done.returncode}: {done.stderr.strip()}")
        return json.loads(done.stdout)["points"][0]
