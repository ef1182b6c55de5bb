#!/usr/bin/python3
"""lammps_drill.py BIN [--kills 6] [--seed 1] [--launcher COMMAND]

Runs a small ensemble of the dumbbells of results/lammps-ensemble undisturbed with one worker, then with two while
peclet, a worker or a LAMMPS process is killed with SIGKILL at random moments. The canonical exports must be the same
bytes, no kill may be blamed on the engine, and neither a LAMMPS process nor its folder may be left behind. With a
launcher (mpirun -np 2) ranks are struck too, and a SIGTERM to the adapter.
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

ROOT = os.path.abspath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "../.."))
STUDY = os.path.join(ROOT, "results/lammps-ensemble")
CAMPAIGN = {
    "name": "drill",
    "scene": {
        "variables": {"weissenberg": 1, "dumbbells": 60},
        "steps": {"equilibration": 400, "production": 1600, "chunk": 800},
        "observables": {"viscosity": {"column": "v_viscosity"}},
    },
    "target": {"observable": "viscosity", "relative_tolerance": 0.5},
    "engine": [
        os.path.join(ROOT, "adapters/lammps/lammps_engine.py"),
        os.path.join(STUDY, "dumbbells.in"),
        os.path.join(STUDY, "dumbbell.mol"),
    ],
}


def children(process):
    try:
        with open(f"/proc/{process}/task/{process}/children") as f:
            return [int(word) for word in f.read().split()]
    except (FileNotFoundError, ProcessLookupError):
        return []


def processes_in(folder):
    """LAMMPS runs in a folder of its own below this one."""
    found = []
    for process in filter(str.isdigit, os.listdir("/proc")):
        try:
            if os.readlink(f"/proc/{process}/cwd").startswith(folder):
                found.append(int(process))
        except OSError:
            pass  # gone, or not ours
    return found


class Drill:
    def __init__(self, peclet, folder, workers, seeds, launcher):
        self.peclet, self.folder, self.workers = peclet, folder, workers
        self.scratch = os.path.join(folder, "scratch")
        os.makedirs(self.scratch)
        with open(os.path.join(folder, "drill.json"), "w") as f:
            json.dump(
                {
                    **CAMPAIGN,
                    "realisations": {"minimum": seeds, "maximum": seeds},
                    "engine": CAMPAIGN["engine"] + (["--launcher", launcher] if launcher else []),
                },
                f,
            )

    def start(self):
        log = open(os.path.join(self.folder, "log"), "a")
        return subprocess.Popen(
            [self.peclet, "run", "drill.json", "--workers", str(self.workers), "--checkpoint", "0.01"],
            cwd=self.folder,
            env={**os.environ, "TMPDIR": self.scratch},
            stdout=log,
            stderr=log,
        )

    def export(self):
        return subprocess.run(
            [self.peclet, "export", "drill.json", "--json", "--canonical"],
            cwd=self.folder,
            capture_output=True,
            check=True,
        ).stdout

    def rows(self, query):
        with sqlite3.connect(f"file:{self.folder}/drill.peclet/campaign.db?mode=ro", uri=True) as database:
            return database.execute(query).fetchall()

    def ask(self, query):
        return self.rows(query)[0][0]

    def workers_at_work(self, process):
        """Those of its children that have a seed."""
        try:
            busy = {row[0] for row in self.rows("SELECT process FROM attempt WHERE outcome = 'running'")}
        except sqlite3.Error:
            return []  # no database yet
        return [child for child in children(process.pid) if child in busy]

    def left_behind(self):
        """After a while in which the orphans of a killed run may leave by themselves."""
        patience = time.monotonic() + 20
        while processes_in(self.scratch) and time.monotonic() < patience:
            time.sleep(0.05)
        return [*processes_in(self.scratch), *os.listdir(self.scratch)]


def candidates(drill, process, whom):
    """peclet while it has given out seeds, the workers that have them, or the LAMMPS processes of these."""
    workers = drill.workers_at_work(process)
    return {
        "peclet": [process.pid] if workers else [],
        "worker": workers,
        "term": workers,
        "lmp": [child for worker in workers for child in children(worker)],
        "rank": [rank for worker in workers for child in children(worker) for rank in children(child)],
    }[whom]


def strike(drill, process, whom, chance, longest_delay):
    """Kills one of them some time after there has been one. Returns whether it did; there is none when the campaign is
    through."""
    while not candidates(drill, process, whom):
        if process.poll() is not None:
            return False
        time.sleep(0.02)
    time.sleep(chance.uniform(0, longest_delay))
    victims = candidates(drill, process, whom)
    if process.poll() is not None or not victims:
        return False
    try:
        os.kill(chance.choice(victims), signal.SIGTERM if whom == "term" else signal.SIGKILL)
    except ProcessLookupError:
        return False
    return True


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("bin")
    parser.add_argument("--kills", type=int, default=6)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--launcher", default="")
    arguments = parser.parse_args()
    peclet = os.path.abspath(os.path.join(arguments.bin, "peclet"))
    chance = random.Random(arguments.seed)
    seeds = max(5, arguments.kills)  # so that the campaign outlasts them
    with tempfile.TemporaryDirectory() as folder:
        undisturbed = Drill(peclet, os.path.join(folder, "undisturbed"), 1, seeds, arguments.launcher)
        started = time.monotonic()
        code = undisturbed.start().wait()
        needed = time.monotonic() - started
        print(f"undisturbed, 1 worker: exit code {code} after {needed:.1f} s")
        if code != 0:
            print(open(os.path.join(undisturbed.folder, "log")).read())
            return 1

        drill = Drill(peclet, os.path.join(folder, "drill"), 2, seeds, arguments.launcher)
        whose = ["lmp", "worker", "peclet"] + (["rank", "term"] if arguments.launcher else [])
        kills = dict.fromkeys(whose, 0)
        process = drill.start()
        while sum(kills.values()) < arguments.kills:
            whom = whose[sum(kills.values()) % len(whose)]
            if strike(drill, process, whom, chance, needed / 4 / arguments.kills):
                kills[whom] += 1
                if whom == "peclet":
                    process.wait()
                    process = drill.start()
            elif process.poll() is not None:
                break  # through before it could be struck as often as asked
        code = process.wait()
        same = drill.export() == undisturbed.export()
        done, results, blamed = (
            drill.ask(query)
            for query in (
                "SELECT count(*) FROM realisation WHERE state = 'done'",
                "SELECT count(*) FROM result",
                "SELECT total(blamed) FROM attempt",
            )
        )
        cut = drill.ask("SELECT count(*) FROM attempt WHERE outcome IN ('killed', 'abandoned')")
        left = drill.left_behind() + undisturbed.left_behind()
        print(
            f"kills: {kills}; last run: exit code {code}; same bytes: {same}; realisations {done}, results "
            f"{results}; attempts "
            f"cut {cut}, blamed on the engine {blamed:.0f}; left behind: {left}"
        )
        enough = sum(kills.values()) >= arguments.kills
        return 0 if code == 0 and same and done == results and blamed == 0 and not left and enough and cut else 1


if __name__ == "__main__":
    sys.exit(main())
