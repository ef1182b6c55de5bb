#!/usr/bin/python3
"""large_campaign.py BIN [--points 20] [--seeds 800] [--workers 4]

Runs a campaign with the fake engine of the tests, every point up to its maximum, and prints what the owner costs: processor time
per realisation (that of the fake engines included, so an upper bound), largest memory, the time of `peclet status` while it runs
and afterwards, and the size of the database. Takes a minute or two.
"""
import argparse
import json
import os
import subprocess
import sys
import tempfile
import time


def status_seconds(peclet, folder):
    started = time.monotonic()
    subprocess.run([peclet, "status", "large.json"], cwd=folder, capture_output=True, check=True)
    return time.monotonic() - started


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("bin")
    parser.add_argument("--points", type=int, default=20)
    parser.add_argument("--seeds", type=int, default=800)
    parser.add_argument("--workers", type=int, default=4)
    arguments = parser.parse_args()
    peclet, engine = (os.path.abspath(os.path.join(arguments.bin, name)) for name in ("peclet", "fake_engine"))
    scene = json.load(open(os.path.join(os.path.dirname(os.path.abspath(__file__)), "../runner/small_scene.json")))
    campaign = {
        "name": "large", "scene": scene,
        "sweep": [{"set": "/volume_fraction", "values": [0.2 + 0.01 * k for k in range(arguments.points)]}],
        "target": {"observable": "relative_viscosity", "relative_tolerance": 1e-6},
        "realisations": {"minimum": 10, "maximum": arguments.seeds},
        "engine": [engine],
    }
    with tempfile.TemporaryDirectory() as folder:
        with open(os.path.join(folder, "large.json"), "w") as f:
            json.dump(campaign, f)
        started = time.monotonic()
        run = subprocess.Popen([peclet, "run", "large.json", "--quiet", "--workers", str(arguments.workers)], cwd=folder,
                               stdout=subprocess.DEVNULL)
        time.sleep(15)
        during = [status_seconds(peclet, folder) for _ in range(5)]
        _, code, usage = os.wait4(run.pid, 0)
        wall = time.monotonic() - started
        after = [status_seconds(peclet, folder) for _ in range(5)]
        status = json.loads(subprocess.run([peclet, "status", "large.json", "--json"], cwd=folder, capture_output=True,
                                           check=True).stdout)
        done = sum(point["seeds"]["done"] for point in status["points"])
        size = os.path.getsize(os.path.join(folder, "large.peclet", "campaign.db"))
    per_realisation = 1e3 * (usage.ru_utime + usage.ru_stime) / done
    print(f"{done} realisations in {wall:.0f} s with {arguments.workers} workers, exit code {os.waitstatus_to_exitcode(code)}")
    print(f"processor time per realisation, fake engines included: {per_realisation:.2f} ms")
    print(f"largest memory of any of its processes: {usage.ru_maxrss / 1024:.0f} MiB")
    print(f"status: {max(during):.3f} s while it runs, {max(after):.3f} s afterwards (largest of five)")
    print(f"database: {size / 2**20:.0f} MiB")
    return 0 if done == arguments.points * arguments.seeds and per_realisation < 5 and max(during + after) < 0.3 else 1


if __name__ == "__main__":
    sys.exit(main())
