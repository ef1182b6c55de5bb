#!/usr/bin/python3
"""large_campaign.py BIN [--points 125] [--seeds 800] [--workers 64] [--milliseconds 100] [--block-numbers 475]
                       [--launch FOLDER]

Runs a campaign of 100 000 realisations with the fake engine, every point up to its maximum. Its results are
as large as those of peclet-engine (--block-numbers), its jobs sleep 100 ms, and it takes a job ahead. Prints
the owner's costs:

- processor time per realisation, of the owner and of the engines, and the owner's peak memory;
- the load of the workers: the time spent on jobs, by their own clocks, over workers times the time from the
  first job's begin to the last one's end. A job lasts from its start until its result is durable in the spool
  and announced, without the wait for the next job;
- commits per second and results per commit, by the transaction counter in the write-ahead log's index;
- the time of `peclet status` during the run (median and largest) and after it, and the size of the database.

With --launch workers are launched through the program `env`, and their far ends keep files in FOLDER, which is best on
another disk, or in memory. The time of both ends is counted with that of the engines.

On a quiet machine with two cores it takes about four minutes; --points 5 makes a short test. It fails if a
result is missing or the median of `status` reaches 0.3 s. With --claims it also fails if the load is below
97 %, the database larger than 300 MB or the owner larger than 200 MiB.
"""
import argparse
import json
import os
import statistics
import struct
import subprocess
import sys
import tempfile
import threading
import time

from campaign_folder import CampaignFolder, largest_memory, processor_time


class Owner(threading.Thread):
    """Watches the run's process: its processor time, its memory and its commits."""

    def __init__(self, process, campaign):
        super().__init__(daemon=True)
        self.process, self.index = process, campaign.path("campaign.db-shm")
        self.seconds = self.memory = self.commits = 0

    def run(self):
        while self.process.returncode is None:
            try:
                self.look()
            except (OSError, struct.error):  # before the file exists, or after its end
                pass
            time.sleep(0.2)

    def look(self):
        self.seconds = processor_time(self.process.pid)
        self.memory = max(self.memory, largest_memory(self.process.pid))
        # walformat.html of SQLite: the index begins with the version, a zero and the transaction counter.
        with open(self.index, "rb") as f:
            self.commits = max(self.commits, struct.unpack("<3I", f.read(12))[2])


class Statuses(threading.Thread):
    """Calls status again and again."""

    def __init__(self, campaign):
        super().__init__(daemon=True)
        self.campaign, self.asking, self.seconds = campaign, True, []

    def run(self):
        time.sleep(3)
        while self.asking:
            self.seconds.append(status_seconds(self.campaign))
            time.sleep(3)


def status_seconds(campaign):
    started = time.monotonic()
    campaign.say("status", "large.json", check=True)
    return time.monotonic() - started


def busy_share(path, workers):
    begins, ends = [], []
    with open(path) as f:
        for line in f:
            begin, end = map(int, line.split())
            begins.append(begin)
            ends.append(end)
    span = max(ends) - min(begins)
    return (sum(ends) - sum(begins)) / (workers * span), span * 1e-9


def campaign_of(arguments, engine):
    scene = json.load(open(os.path.join(os.path.dirname(os.path.abspath(__file__)), "../runner/small_scene.json")))
    return {
        "name": "large",
        "scene": scene,
        "sweep": [{"set": "/volume_fraction", "values": [round(0.2 + 0.001 * k, 3) for k in range(arguments.points)]}],
        "target": {"observable": "relative_viscosity", "relative_tolerance": 1e-6},
        "realisations": {"minimum": 10, "maximum": arguments.seeds},
        "engine": [engine],
    }


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("bin")
    parser.add_argument("--points", type=int, default=125)
    parser.add_argument("--seeds", type=int, default=800)
    parser.add_argument("--workers", type=int, default=64)
    parser.add_argument("--milliseconds", type=int, default=100, help="of a job")
    parser.add_argument(
        "--block-numbers",
        type=int,
        default=475,
        help="in a result; 475 make 2.0 kB stored, as those of peclet-engine with friction and noise",
    )
    parser.add_argument("--launch", metavar="FOLDER")
    parser.add_argument("--claims", action="store_true", help="fail unless every claim holds")
    arguments = parser.parse_args()
    engine = os.path.abspath(os.path.join(arguments.bin, "fake_engine"))
    with tempfile.TemporaryDirectory() as folder:
        times = os.path.join(folder, "times")
        fake = {"STEPS": 1, "STEP_MS": arguments.milliseconds, "PADDING": arguments.block_numbers, "TIMES": times}
        environment = {f"PECLET_FAKE_{name}": str(value) for name, value in (fake | {"AHEAD": 1}).items()}
        if arguments.launch:
            environment["TMPDIR"] = arguments.launch
        campaign = CampaignFolder(arguments.bin, folder, campaign_of(arguments, engine), environment)
        started = time.monotonic()
        words = f"run large.json --quiet --threads 1 --workers {arguments.workers}".split() + ["--launch=env"] * bool(
            arguments.launch
        )
        run = campaign.start(*words, stdout=subprocess.DEVNULL, stderr=None)
        owner, statuses = Owner(run, campaign), Statuses(campaign)
        owner.start()
        statuses.start()
        _, code, usage = os.wait4(run.pid, 0)
        run.returncode = os.waitstatus_to_exitcode(code)
        statuses.asking = False
        wall = time.monotonic() - started
        statuses.join()
        after = [status_seconds(campaign) for _ in range(7)]
        status = json.loads(campaign.say("status", "large.json", "--json", check=True).stdout)
        done = sum(point["seeds"]["done"] for point in status["points"])
        size = os.path.getsize(campaign.path("campaign.db"))
        busy, span = busy_share(times, arguments.workers)
    engines = usage.ru_utime + usage.ru_stime - owner.seconds
    during = statuses.seconds or after
    print(f"{done} realisations in {wall:.0f} s with {arguments.workers} workers, exit code {run.returncode}")
    print(f"workers busy: {100 * busy:.1f} % of {span:.0f} s; load of the machine: {os.getloadavg()[0]:.1f}")
    costs = 1e3 * owner.seconds / done, 1e3 * engines / done
    print("processor time per realisation: owner {:.3f} ms, engines {:.3f} ms".format(*costs))
    print(f"largest memory of the owner: {owner.memory:.0f} MiB")
    each = done / max(1, owner.commits)
    print(f"{owner.commits} commits: {owner.commits / span:.0f} a second, {each:.1f} results in each")
    for name, seconds in (("while it runs", during), ("afterwards", after)):
        middle, most = statistics.median(seconds), max(seconds)
        print(f"status {name}: {middle:.3f} s (median), {most:.3f} s (largest of {len(seconds)})")
    print(f"database: {size / 1e6:.0f} MB, {size / done / 1e3:.2f} kB per realisation")
    passed = done == arguments.points * arguments.seeds and statistics.median(during + after) < 0.3
    if arguments.claims:
        passed &= busy >= 0.97 and size < 300e6 and owner.memory < 200
    return 0 if passed else 1


if __name__ == "__main__":
    sys.exit(main())
