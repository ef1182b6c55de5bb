#!/usr/bin/python3
"""kill_drill.py BIN [--kills 20] [--seed 1]

Runs a small real campaign undisturbed with one worker, then the same with two workers while scheduler, workers or both
are killed with SIGKILL at random moments, until it is through. The canonical exports must be the same bytes, and no
realisation may have been counted twice.
"""
import argparse
import json
import os
import random
import signal
import sqlite3
import subprocess
import sys
import tempfile
import time

CAMPAIGN = {
    "name": "drill",
    "scene": {
        "particles": {"count": 60, "density": 0.1,
                      "species": [{"radius": 1.0, "volume_share": 0.5}, {"radius": 1.4, "volume_share": 0.5}]},
        "volume_fraction": 0.4,
        "peclet": 10,
        "limits": {"shear_rate": 0.045, "thermal_energy": 0.01},
        "fluid": {"viscosity": 0.1},
        "contact": {"normal_stiffness": 1e4, "friction": 0.5},
        "lubrication": {"form": "kim-karrila", "inner_gap": 0.01, "outer_gap": 0.05},
        "duration": {"equilibration": {"strain": 0.3}, "production": {"strain": 2.7}},
    },
    "sweep": [{"set": "/peclet", "values": [10, 1000]}],
    "target": {"observable": "relative_viscosity", "relative_tolerance": 0.15},
    "realisations": {"minimum": 8, "maximum": 20},
    "engine": ["peclet-engine", "serve"],
}


def children(process):
    try:
        with open(f"/proc/{process}/task/{process}/children") as f:
            return [int(word) for word in f.read().split()]
    except FileNotFoundError:
        return []


class Drill:
    def __init__(self, peclet, folder, workers):
        self.peclet, self.folder, self.workers = peclet, folder, workers
        os.makedirs(folder)
        with open(os.path.join(folder, "drill.json"), "w") as f:
            json.dump(CAMPAIGN, f)

    def start(self):
        log = open(os.path.join(self.folder, "log"), "a")
        return subprocess.Popen([self.peclet, "run", "drill.json", "--workers", str(self.workers), "--checkpoint", "0.2"],
                                cwd=self.folder, stdout=log, stderr=log)

    def export(self):
        return subprocess.run([self.peclet, "export", "drill.json", "--json", "--canonical"], cwd=self.folder,
                              capture_output=True, check=True).stdout

    def count(self, query):
        with sqlite3.connect(f"file:{self.folder}/drill.peclet/campaign.db?mode=ro", uri=True) as database:
            return database.execute(query).fetchone()[0]


def strike(process, whom):
    """Kills the scheduler, one worker, or the scheduler and all workers. Returns the number of processes that were hit."""
    workers = children(process.pid)
    victims = {"scheduler": [], "workers": workers[:1], "both": workers}[whom]
    hits = 0
    if whom != "workers":
        process.kill()
        hits += 1
    for worker in victims:
        try:
            os.kill(worker, signal.SIGKILL)
            hits += 1
        except ProcessLookupError:
            pass
    return hits


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("bin")
    parser.add_argument("--kills", type=int, default=20)
    parser.add_argument("--seed", type=int, default=1)
    arguments = parser.parse_args()
    peclet = os.path.abspath(os.path.join(arguments.bin, "peclet"))
    chance = random.Random(arguments.seed)
    with tempfile.TemporaryDirectory() as folder:
        undisturbed = Drill(peclet, os.path.join(folder, "undisturbed"), 1)
        started = time.monotonic()
        code = undisturbed.start().wait()
        needed = (time.monotonic() - started) / 2  # with two workers
        print(f"undisturbed, 1 worker: exit code {code} after {2 * needed:.1f} s")
        assert code == 0

        drill = Drill(peclet, os.path.join(folder, "drill"), 2)
        kills = dict.fromkeys(("scheduler", "workers", "both"), 0)
        while sum(kills.values()) < arguments.kills:
            process = drill.start()
            time.sleep(chance.uniform(0.1, 0.1 + needed / arguments.kills))
            if process.poll() is not None:
                print(f"the campaign was through after {sum(kills.values())} kills")
                break
            whom = chance.choice(list(kills))
            if strike(process, whom) > 0:
                kills[whom] += 1  # a strike at workers that are not there yet does not count
            if whom == "workers":  # the scheduler must carry on with a new one, and is then stopped the hard way
                time.sleep(chance.uniform(0, 0.2))
                process.kill()
                kills["scheduler"] += 1
            process.wait()
        code = drill.start().wait()
        same = drill.export() == undisturbed.export()
        counted = drill.count("SELECT count(*) FROM realisation WHERE state = 'done'")
        stored = drill.count("SELECT count(*) FROM result")
        # A result that its scheduler did not live to commit is taken from the spool by the next one.
        from_spool = counted - drill.count("SELECT count(*) FROM attempt WHERE outcome = 'result'")
        blamed = drill.count("SELECT total(blamed) FROM attempt")
        print(f"kills: {kills}; last run: exit code {code}; same bytes: {same}; realisations {counted}, results {stored}, "
              f"of these {from_spool} from the spool, attempts blamed on the engine {blamed:.0f}")
        enough = sum(kills.values()) >= arguments.kills
        return 0 if code == 0 and same and counted == stored and from_spool >= 0 and blamed == 0 and enough else 1


if __name__ == "__main__":
    sys.exit(main())
