#!/usr/bin/python3
"""rough_spheres.py ENGINE [--rounds 5] [--counts 1000 65536] [--threads 1 2]

Measures the cost of a unit of strain in the rough suspension FR of Monti, Rathee, Shen & Rosti (2021),
Table 1 (phi = 0.5, mu = 1, lubrication `mari` to 0.05 a), for several numbers of spheres and threads.
Prints wall-clock and processor time of a run over a longer strain less that of a shorter one, which
removes packing and start. Prints also the largest memory of the longer run, packing included.
"""
import argparse
import json
import os
import statistics
import sys
import tempfile
import threading
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "results"))
from studies.monti import PAIRS, contact
from studies.scenes import during, merged
from studies.tables import markdown_head, markdown_row

STRAINS = 1, 1.5  # the shorter strain lets the packing form its contacts
SPHERES_OF_A_ROUND = 65536  # smaller systems run longer, up to MOST_STRAINS more
MOST_STRAINS = 10
HEAD = (
    "N",
    "threads",
    "s on the wall a strain",
    "processor s a strain",
    "µs of processor a sphere and strain",
    "steps a strain",
    "ns a sphere and step",
    "MB",
)


class Memory(threading.Thread):
    """Polls the peak memory of a process until it ends. Its usage includes this program's at fork."""

    def __init__(self, pid):
        super().__init__()
        self.path, self.most = Path(f"/proc/{pid}/status"), 0
        self.start()

    def run(self):
        while True:
            lines = [line for line in self.path.read_text().splitlines() if line.startswith("VmHWM:")]
            if not lines:  # the process has ended
                return
            self.most = 1024 * int(lines[0].split()[1])
            time.sleep(0.02)


def run(engine, folder, count, threads, strain):
    """Returns wall-clock seconds, processor seconds, steps and peak memory [bytes] of one run."""
    patch = {"particles": {"count": count}, "contact": contact(4e5, 1), **during({"strain": 0}, {"strain": strain})}
    scene, output = (os.path.join(folder, name) for name in ("scene.json", "result.json"))
    Path(scene).write_text(json.dumps(merged(PAIRS, patch)))
    arguments = [engine, "run", scene, "--quiet", "--threads", str(threads), "--output", output]
    begin = time.monotonic()
    pid = os.posix_spawn(engine, arguments, os.environ)
    memory = Memory(pid)
    os.waitid(os.P_PID, pid, os.WEXITED | os.WNOWAIT)
    wall = time.monotonic() - begin
    memory.join()
    _, status, usage = os.wait4(pid, 0)
    if status:
        sys.exit(f"{engine}: ended with status {status}")
    steps = json.loads(Path(output).read_text())["steps"]
    return wall, usage.ru_utime + usage.ru_stime, sum(steps.values()), memory.most


def per_strain(engine, folder, count, threads):
    short = STRAINS[0]
    longer = short + min(MOST_STRAINS, (STRAINS[1] - short) * SPHERES_OF_A_ROUND / count)
    first, second = (run(engine, folder, count, threads, strain) for strain in (short, longer))
    return [(b - a) / (longer - short) for a, b in zip(first[:3], second[:3])] + [second[3]]


def spread(values, factor=1.0):
    middle, low, high = (factor * f(values) for f in (statistics.median, min, max))
    return f"{middle:.3g} ({low:.3g} .. {high:.3g})"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("engine")
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--counts", type=int, nargs="+", default=[1000, 65536])
    parser.add_argument("--threads", type=int, nargs="+", default=[1, 2])
    arguments = parser.parse_args()
    engine = os.path.abspath(arguments.engine)
    cases = [(count, threads) for count in arguments.counts for threads in arguments.threads]
    found = {case: [] for case in cases}
    with tempfile.TemporaryDirectory() as folder:
        for done in range(arguments.rounds):
            for count, threads in cases if done % 2 == 0 else reversed(cases):
                found[count, threads].append(per_strain(engine, folder, count, threads))
                print(f"round {done + 1}: N = {count}, {threads} threads", file=sys.stderr, flush=True)
    print(markdown_head(HEAD))
    for (count, threads), rounds in found.items():
        wall, processor, steps, memory = zip(*rounds)
        each = [p / s / count for p, s in zip(processor, steps)]
        cells = [count, threads, spread(wall), spread(processor), spread(processor, 1e6 / count)]
        cells += [f"{statistics.median(steps):.0f}", spread(each, 1e9), f"{max(memory) / 1e6:.0f}"]
        print(markdown_row(cells))
    for count in arguments.counts:
        base = [r[0] for r in found[count, arguments.threads[0]]]
        for threads in arguments.threads[1:]:
            ratios = [b / r[0] for b, r in zip(base, found[count, threads])]
            print(f"\nN = {count}: {threads} threads are {spread(ratios)} times as fast as {arguments.threads[0]}")


main()
