#!/usr/bin/python3
"""owner_time.py BIN [--maximum N ...] [--points N] [--seconds S] [--padding N] [--workers N] [--job-ms MS]
              [--launch [--far FOLDER]]

Prints the processor time of `peclet run` per result, and its largest memory, with jobs of BIN/fake_engine that take MS
milliseconds (0). With --launch workers are launched through the program `env`, and the processor time of their near
ends and far ends is printed, too. BIN may be a folder of another build, to be called in turn.
"""
import argparse
import contextlib
import json
import os
import signal
import subprocess
import sys
import tempfile
import time

TESTS = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
sys.path.insert(0, os.path.join(TESTS, "end_to_end"))
from campaign_folder import CampaignFolder, comes_true, largest_memory, processes_with, processor_time  # noqa: E402

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
    fake = {"STEPS": 1, "STEP_MS": arguments.job_ms, "DEVIATION": 5, "AHEAD": 1, "PADDING": arguments.padding}
    environment = {f"PECLET_FAKE_{name}": str(value) for name, value in fake.items()}
    if arguments.far:
        environment["TMPDIR"] = arguments.far
    with tempfile.TemporaryDirectory() as folder:
        of = document(arguments.bin, arguments.points, maximum)
        campaign = CampaignFolder(arguments.bin, folder, of, environment)
        silent = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
        words = ["run", campaign.file, f"--workers={arguments.workers}", *["--launch=env"] * arguments.launch]
        with campaign.start(*words, **silent) as run:
            comes_true(lambda: campaign.ended() > 2 * arguments.workers)  # all are busy
            begun, count = times(run.pid, campaign), -campaign.ended()
            time.sleep(arguments.seconds)
            ended, count = times(run.pid, campaign), count + campaign.ended()
            memory = largest_memory(run.pid)
            run.send_signal(signal.SIGTERM)
    wall, owner, ends = (after - before for before, after in zip(begun, ended))
    busy = count * arguments.job_ms / 1000 / (wall * arguments.workers)
    print(f"maximum {maximum}: {count} results, {1000 * owner / max(1, count):.2f} ms each, {memory:.0f} MiB", end="")
    print(f", workers busy {100 * busy:.1f} %" if arguments.job_ms > 0 else "", end="")
    print(f", ends {1000 * ends / max(1, count):.2f} ms each" if arguments.launch else "", flush=True)


def times(owner, campaign):
    """Returns the time, the owner's processor time, and that of `peclet worker` [s]."""
    ends = 0
    for process in processes_with("PECLET_CAMPAIGN", campaign.data):
        with contextlib.suppress(OSError):
            with open(f"/proc/{process}/cmdline", "rb") as f:
                if b"peclet\0worker\0" in f.read():
                    ends += processor_time(process)
    return time.monotonic(), processor_time(owner), ends


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("bin")
    parser.add_argument("--maximum", type=int, nargs="+", default=[10_000, 1_000_000])
    parser.add_argument("--points", type=int, default=1)
    parser.add_argument("--seconds", type=float, default=5)
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--job-ms", type=float, default=0)
    parser.add_argument("--launch", action="store_true")
    parser.add_argument("--far", help="folder for the files of far ends, which are on this machine, too")
    parser.add_argument("--padding", type=int, default=0, help="numbers in a result that nobody asks for")
    arguments = parser.parse_args()
    for maximum in arguments.maximum:
        measure(arguments, maximum)


if __name__ == "__main__":
    main()
