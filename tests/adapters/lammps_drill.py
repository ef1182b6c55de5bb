#!/usr/bin/python3
"""lammps_drill.py BIN [--kills 6] [--seed 1] [--launcher COMMAND]

Runs a small ensemble of the dumbbells of results/lammps-ensemble undisturbed with one worker. Then runs it
with two workers while peclet, a worker or a LAMMPS process is killed with SIGKILL at random moments. The
canonical exports must agree byte for byte, no kill may be blamed on the engine, and no LAMMPS process or
folder may remain. With a launcher (mpirun -np 2) ranks are killed, too, and the adapter gets a SIGTERM.
"""
import argparse
import os
import random
import signal
import sqlite3
import sys
import tempfile
import time

ROOT = os.path.abspath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "../.."))
sys.path.insert(0, os.path.join(ROOT, "tests/end_to_end"))
from campaign_folder import BLAMED, ENDED, RESULTS, CampaignFolder, children, comes_true  # noqa: E402

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


def processes_in(folder):
    """Returns the LAMMPS processes that run in a folder below this one."""
    found = []
    for process in filter(str.isdigit, os.listdir("/proc")):
        try:
            if os.readlink(f"/proc/{process}/cwd").startswith(folder):
                found.append(int(process))
        except OSError:
            pass  # ended, or another user's
    return found


class Drill(CampaignFolder):
    def __init__(self, programs, folder, workers, seeds, launcher):
        engine = CAMPAIGN["engine"] + (["--launcher", launcher] if launcher else [])
        document = {**CAMPAIGN, "realisations": {"minimum": seeds, "maximum": seeds}, "engine": engine}
        self.workers, self.scratch = str(workers), os.path.join(folder, "scratch")
        os.makedirs(self.scratch)
        super().__init__(programs, folder, document, {"TMPDIR": self.scratch})

    def start(self):
        return super().start("run", "drill.json", "--workers", self.workers, "--checkpoint", "0.01")

    def workers_at_work(self, process):
        """Returns the workers that have a seed."""
        try:
            busy = {row[0] for row in self.query("SELECT process FROM attempt WHERE outcome = 'running'")}
        except sqlite3.Error:
            return []  # no database yet
        return [child for child in children(process.pid) if child in busy]

    def left_behind(self):
        """Returns what is left once the orphans of a killed run have had time to leave."""
        comes_true(lambda: not processes_in(self.scratch), nap=0.05)
        return [*processes_in(self.scratch), *os.listdir(self.scratch)]


def candidates(drill, process, whom):
    """Returns peclet while seeds are running, the workers that run them, or their LAMMPS processes."""
    workers = drill.workers_at_work(process)
    return {
        "peclet": [process.pid] if workers else [],
        "worker": workers,
        "term": workers,
        "lmp": [child for worker in workers for child in children(worker)],
        "rank": [rank for worker in workers for child in children(worker) for rank in children(child)],
    }[whom]


def strike(drill, process, whom, chance, longest_delay):
    """Kills a candidate some time after the first appears. Returns False if the campaign ends before."""
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
    chance = random.Random(arguments.seed)
    seeds = max(5, arguments.kills)  # so that the campaign outlasts the kills
    with tempfile.TemporaryDirectory() as folder:
        undisturbed = Drill(arguments.bin, os.path.join(folder, "undisturbed"), 1, seeds, arguments.launcher)
        started = time.monotonic()
        code = undisturbed.start().wait()
        needed = time.monotonic() - started
        print(f"undisturbed, 1 worker: exit code {code} after {needed:.1f} s")
        if code != 0:
            print(undisturbed.log())
            return 1

        drill = Drill(arguments.bin, os.path.join(folder, "drill"), 2, seeds, arguments.launcher)
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
                break  # the campaign ended before all kills
        code = process.wait()
        same = drill.export() == undisturbed.export()
        done, results, blamed = (drill.ask(query) for query in (ENDED, RESULTS, BLAMED))
        cut = drill.ask("SELECT count(*) FROM attempt WHERE outcome IN ('killed', 'abandoned')")
        for said in drill.query("SELECT outcome, message FROM attempt WHERE blamed"):
            print("blamed:", *said)
        left = drill.left_behind() + undisturbed.left_behind()
        print(
            f"kills: {kills}; last run: exit code {code}; same bytes: {same}; realisations {done}, results {results}; "
            f"attempts cut {cut}, blamed on the engine {blamed:.0f}; left behind: {left}"
        )
        enough = sum(kills.values()) >= arguments.kills
        return 0 if code == 0 and same and done == results and blamed == 0 and not left and enough and cut else 1


if __name__ == "__main__":
    sys.exit(main())
