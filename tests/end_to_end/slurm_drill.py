#!/usr/bin/python3
"""slurm_drill.py BIN [--quick] [--only CASE] [--keep FOLDER]

Runs campaigns through a real Slurm (slurmctld, slurmd and munged of this machine's packages, started here).
Meanwhile tasks are killed, preempted and warned, the controller is restarted or away, submissions are
refused, unanswered or forgotten, and the owner is killed. After each case the canonical export must equal
that of `peclet run` without Slurm byte for byte, with no realisation lost or counted twice. Prints a table
and exits with 1 if anything differs. --quick runs some of the cases; --only one of them (time_limit, which
waits for a minute, runs only so); --keep leaves everything in that folder.
"""
import argparse
import contextlib
import os
import subprocess
import sys
import tempfile
import time

from drill.campaign import REAL
from slurm_campaign import CAMPAIGN
from slurm_cases import Drill
from slurm_cluster import CPUS, Cluster


FAULTS = {"PECLET_FAKE_FAULTS": "crash:3 exit:4x1 overlap:5 kill:2x2"}
QUICK = ("arrays", "killed_task", "controller_away", "answer_lost", "refused", "odd_folder", "one_job", "three_nodes")
CASES = QUICK + (
    "killed_engine",
    "preempted",
    "warned",
    "controller_restarted",
    "submission_lost",
    "owner_killed",
    "taken_back",
    "forgotten",
    "failing_engine",
    "real_engine",
)
NODES = ("three_nodes", "nodes_at_limit")  # in a cluster of three nodes
SLOW = ("time_limit", "nodes_at_limit")  # Slurm's shortest limit is a minute
LONG_SEEDS = {**CAMPAIGN, "target": {"relative_tolerance": 0.9}, "realisations": {"minimum": 4, "maximum": 4}}
LONG = {
    **REAL,
    "scene": {**REAL["scene"], "duration": {"equilibration": {"strain": 0.3}, "production": {"strain": 12}}},
    "realisations": {"minimum": 20, "maximum": 20},
}
LONGER = {"environment": {"PECLET_FAKE_STEP_MS": "75"}}  # same results
SETTINGS = {
    "preempted": LONGER,
    "warned": LONGER,
    "time_limit": {"document": LONG_SEEDS, "environment": {"PECLET_FAKE_STEP_MS": "1500"}},
    "failing_engine": {"environment": FAULTS},
    "real_engine": {"document": REAL},
    "three_nodes": {"document": LONG},
    "nodes_at_limit": {"document": LONG},
}


def try_case(drill, name, expected):
    campaign = drill.campaign(name, **SETTINGS.get(name, {}))
    started = time.monotonic()
    try:
        said = getattr(drill, name)(campaign)
        lost, double, again, same = campaign.lost(), campaign.double(), campaign.again(), campaign.export() == expected
    except (AssertionError, subprocess.SubprocessError) as error:
        print(f"{name}: {error}\n{drill.cluster.log()}{campaign.printed()}", file=sys.stderr)
        said, lost, double, again, same = "FAILED", "?", "?", "?", False
        drill.cluster.clear()
    finally:
        campaign.stop()
    print(
        f"{name:22}{lost:>5}{double:>7}{again:>10}  {'yes' if same else 'NO':5}{time.monotonic() - started:6.1f} s  "
        f"{said}",
        flush=True,
    )
    return same and lost == 0 and double == 0


def kind_of(name):
    """Returns the kind of campaign of a case: its name, or plain."""
    return name if SETTINGS.get(name, LONGER) is not LONGER else "plain"


def expected_exports(drill, names):
    exports = {}
    for name in names:
        kind = kind_of(name)
        if kind in exports:
            continue
        code = 3 if kind == "failing_engine" else 0
        exports[kind] = drill.campaign("local_" + kind, **SETTINGS.get(kind, {})).run_locally(code).export()
    return {name: exports[kind_of(name)] for name in names}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("bin")
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--only", choices=CASES + SLOW)
    parser.add_argument("--keep")
    arguments = parser.parse_args()
    names = (arguments.only,) if arguments.only else QUICK if arguments.quick else CASES
    good = []
    with contextlib.ExitStack() as stack:
        folder = arguments.keep or stack.enter_context(tempfile.TemporaryDirectory(prefix="slurm-drill-"))
        os.makedirs(folder, exist_ok=True)
        os.chmod(folder, 0o755)  # munged requires a reachable socket
        for nodes in (1, 3):
            some = [name for name in names if (name in NODES) == (nodes == 3)]
            if some:
                good += try_cases(os.path.abspath(arguments.bin), folder, nodes, some)
    print(f"\n{sum(good)} of {len(good)} cases: nothing lost, nothing double, the same bytes as without Slurm")
    return 0 if all(good) else 1


def try_cases(binaries, folder, nodes, names):
    with Cluster(os.path.join(folder, f"cluster-{nodes}"), nodes) as cluster:
        drill = Drill(binaries, folder, cluster)
        expected = expected_exports(drill, names)
        print(f"{cluster.say('slurmctld', '-V')}; nodes: {nodes}, of {CPUS} processors\n")
        print(f"{'case':22}{'lost':>5}{'double':>7}{'run again':>10}  {'same':5}{'time':>8}  what happened")
        return [try_case(drill, name, expected[name]) for name in names]


if __name__ == "__main__":
    sys.exit(main())
