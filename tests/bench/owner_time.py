#!/usr/bin/python3
"""owner_time.py BIN [--maximum N ...] [--points N] [--seconds S] [--padding N]

What `peclet run` itself costs a result, with engines that only pretend (BIN/fake_engine): processor time of the owner,
and its largest memory. BIN may be a folder of another build, to be called in turn.
"""
import argparse
import json
import os
import signal
import sqlite3
import subprocess
import tempfile
import time

SCENE = os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), "runner", "small_scene.json")


def processor_time(process):
    with open(f"/proc/{process}/stat", encoding="ascii") as stat:
        fields = stat.read().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def largest_memory(process):
    with open(f"/proc/{process}/status", encoding="ascii") as status:
        return next(int(line.split()[1]) / 1024 for line in status if line.startswith("VmHWM"))


def results(folder):
    database = sqlite3.connect(f"file:{folder}/campaign.peclet/campaign.db?mode=ro", uri=True)
    with database:
        return database.execute("SELECT count(*) FROM realisation WHERE state = 'done'").fetchone()[0]


def campaign(arguments, maximum):
    with open(SCENE, encoding="utf-8") as scene:
        return {
            "name": "campaign",
            "engine": [os.path.abspath(os.path.join(arguments.bin, "fake_engine"))],
            "scene": json.load(scene),
            "sweep": [{"set": "/flow/shear_rate", "values": [0.001 * (i + 1) for i in range(arguments.points)]}],
            "target": {"observable": "relative_viscosity", "relative_tolerance": 1e-7},
            "realisations": {"minimum": 8, "maximum": maximum},
        }


def measure(arguments, maximum):
    fake = {"STEPS": 1, "DEVIATION": 5, "AHEAD": 1, "PADDING": arguments.padding}
    environment = dict(os.environ, **{f"PECLET_FAKE_{name}": str(value) for name, value in fake.items()})
    with tempfile.TemporaryDirectory() as folder:
        file = os.path.join(folder, "campaign.json")
        with open(file, "w", encoding="utf-8") as written:
            json.dump(campaign(arguments, maximum), written)
        command = [os.path.join(arguments.bin, "peclet"), "run", file, "--workers", "2"]
        with subprocess.Popen(command, env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as run:
            time.sleep(2)  # until workers are busy
            time_before, before = processor_time(run.pid), results(folder)
            time.sleep(arguments.seconds)
            count = results(folder) - before
            each = 1000 * (processor_time(run.pid) - time_before) / max(1, count)
            memory = largest_memory(run.pid)
            run.send_signal(signal.SIGTERM)
    print(f"maximum {maximum}: {count} results, {each:.2f} ms each, {memory:.0f} MiB", flush=True)


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("bin")
    parser.add_argument("--maximum", type=int, nargs="+", default=[10_000, 1_000_000])
    parser.add_argument("--points", type=int, default=1)
    parser.add_argument("--seconds", type=float, default=5)
    parser.add_argument("--padding", type=int, default=0, help="numbers in a result that nobody asks for")
    arguments = parser.parse_args()
    for maximum in arguments.maximum:
        measure(arguments, maximum)


if __name__ == "__main__":
    main()
