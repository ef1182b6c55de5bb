#!/usr/bin/python3
"""owner_time.py BIN [--maximum N ...] [--points N] [--seconds S] [--padding N]

Prints the processor time of `peclet run` per result, and its largest memory, with jobs that take no time
(BIN/fake_engine). BIN may be a folder of another build, to be called in turn.
"""
import argparse
import json
import os
import signal
import subprocess
import sys
import tempfile
import time

TESTS = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
sys.path.insert(0, os.path.join(TESTS, "end_to_end"))
from campaign_folder import CampaignFolder, largest_memory, processor_time  # noqa: E402

SCENE = os.path.join(TESTS, "runner", "small_scene.json")


def document(binaries, points, maximum):
    """Returns a campaign of the fake engine that ends at the maximum number of seeds."""
    with open(SCENE, encoding="utf-8") as scene:
        return {
            "name": "campaign",
            "engine": [os.path.abspath(os.path.join(binaries, "fake_engine"))],
            "scene": json.load(scene),
            "sweep": [{"set": "/flow/shear_rate", "values": [0.001 * (i + 1) for i in range(points)]}],
            "target": {"observable": "relative_viscosity", "relative_tolerance": 1e-7},
            "realisations": {"minimum": 8, "maximum": maximum},
        }


def measure(arguments, maximum):
    fake = {"STEPS": 1, "DEVIATION": 5, "AHEAD": 1, "PADDING": arguments.padding}
    environment = {f"PECLET_FAKE_{name}": str(value) for name, value in fake.items()}
    with tempfile.TemporaryDirectory() as folder:
        of = document(arguments.bin, arguments.points, maximum)
        campaign = CampaignFolder(arguments.bin, folder, of, environment)
        silent = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
        with campaign.start("run", campaign.file, "--workers", "2", **silent) as run:
            time.sleep(2)  # until workers are busy
            time_before, before = processor_time(run.pid), campaign.ended()
            time.sleep(arguments.seconds)
            count = campaign.ended() - before
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
