#!/usr/bin/python3
"""slurm_drill.py BIN [--quick] [--only CASE] [--keep FOLDER]

Runs campaigns through a real Slurm (slurmctld, slurmd and munged of this machine's packages, started here) while tasks are
killed, preempted and warned, the controller is restarted or away, submissions lose their answers and the owner is killed.
After each case the canonical export must be, byte for byte, that of the same campaign run by `peclet run` without Slurm;
no realisation may be lost or counted twice. Prints a table and leaves with 1 when anything differs. --quick: some of the
cases; --only: one of them (time_limit, which waits for a minute, is run only so); --keep: leave everything in that folder.
"""
import argparse
import contextlib
import json
import os
import random
import shutil
import signal
import sqlite3
import subprocess
import sys
import tempfile
import time

from drill.campaign import REAL
from slurm_cluster import CPUS, Cluster

# Seeds of about a second, saved several times on their way; a few looks a point.
ENVIRONMENT = {"PECLET_FAKE_STEPS": "40", "PECLET_FAKE_STEP_MS": "25"}
CAMPAIGN = {
    "name": "drill",
    "scene": {"fluid": {"viscosity": 1}, "peclet": 1},
    "sweep": [{"set": "/peclet", "values": [1, 2]}],
    "target": {"observable": "relative_viscosity", "relative_tolerance": 0.055},
    "realisations": {"minimum": 8, "maximum": 40},
}


class Campaign:
    """A campaign in a folder of its own, run locally or through Slurm."""

    def __init__(self, binaries, folder, document=None, environment=None):
        self.peclet = os.path.join(binaries, "peclet")
        self.folder = folder
        os.makedirs(folder)
        document = dict(document or CAMPAIGN)
        engine = "peclet-engine" if document.get("scene") == REAL["scene"] else "fake_engine"
        document["engine"] = [os.path.join(binaries, engine), "serve"]
        with open(os.path.join(folder, "drill.json"), "w") as f:
            json.dump(document, f)
        self.environment = {**os.environ, **ENVIRONMENT, **(environment or {})}
        self.shared = os.path.join(folder, "shared")
        self.hold = os.path.join(folder, "hold")
        self.processes = []

    def holds(self, seed=0):
        """This and later seeds of the fake engine stand still half-way from now on, and their tasks run, until lets_go()."""
        with open(self.hold, "w"):
            pass
        self.environment.update(PECLET_FAKE_HOLD=self.hold, PECLET_FAKE_HOLD_SEED=str(seed))

    def lets_go(self):
        os.remove(self.hold)

    def start(self, *words):
        log = open(os.path.join(self.folder, "log"), "a")
        self.processes.append(subprocess.Popen([self.peclet, *words], cwd=self.folder, env=self.environment, stdout=log,
                                               stderr=log))
        return self.processes[-1]

    def stop(self):
        """Ends what a failed case has left."""
        for process in self.processes:
            process.kill()
            process.wait()

    def do(self, *words, code=0):
        process = self.start(*words)
        answer = process.wait(300)
        assert code is None or answer == code, f"{words}: exit code {answer}, not {code}\n{self.log()}"
        return answer

    def run_locally(self, code=0):
        self.do("run", "drill.json", "--workers", str(CPUS), "--checkpoint", "0.1", code=code)
        return self

    def hand_over(self, *words):
        return ("hand-over", "slurm", "drill.json", "--shared", self.shared, "--checkpoint", "0.1", *words)

    def follow(self, *words):
        return self.hand_over("--follow", "--interval", "0.3", *words)

    def log(self):
        with open(os.path.join(self.folder, "log")) as f:
            return f.read()

    def export(self):
        return subprocess.run([self.peclet, "export", "drill.json", "--canonical"], cwd=self.folder, capture_output=True,
                              check=True).stdout

    def ask(self, query):
        with contextlib.closing(sqlite3.connect(f"file:{self.folder}/drill.peclet/campaign.db?mode=ro", uri=True)) as db:
            return db.execute(query).fetchone()[0]

    def spooled(self):
        spool = os.path.join(self.shared, "spool")
        return [name for name in os.listdir(spool) if name.endswith(".json")] if os.path.isdir(spool) else []

    def ended(self):
        try:
            return self.ask("SELECT count(*) FROM realisation WHERE state = 'done'")
        except sqlite3.Error:
            return 0

    def lost(self):
        """Seeds of the looks that have no result; and files, bundles and seeds that were left lying."""
        wanted = self.ask("SELECT sum(seeds) FROM estimates")
        closed = self.ask("SELECT count(*) FROM realisation JOIN point USING (point_id) JOIN estimates USING (hash)"
                          " WHERE seed < seeds AND state IN ('done', 'failed', 'quarantined')")
        left = self.ask("SELECT count(*) FROM bundle_seed WHERE outcome IS NULL")
        spool = os.path.join(self.shared, "spool")
        files = [name for name in os.listdir(spool) if name != "rejected"] if os.path.isdir(spool) else []
        return wanted - closed + left + len(files)

    def double(self):
        """Results that a seed has beyond its first, counted or offered with another content."""
        return int(self.ask("SELECT count(*) - count(DISTINCT point_id || ' ' || seed) FROM result")
                + self.ask("SELECT total(suspect) FROM point")
                + self.ask("SELECT count(*) FROM event WHERE kind IN ('suspect', 'rejected', 'mixed-engine')"))

    def again(self):
        """Seeds that were run to their end a second time, which costs time and changes nothing."""
        return self.ask("SELECT coalesce(sum(n - 1), 0) FROM (SELECT count(*) AS n FROM attempt WHERE outcome = 'result'"
                        " GROUP BY point_id, seed)")

    def blamed(self):
        return self.ask("SELECT total(blamed) FROM attempt")


class Drill:
    def __init__(self, binaries, folder, cluster):
        self.binaries, self.folder, self.cluster = binaries, folder, cluster
        self.chance = random.Random(1)

    def campaign(self, name, **settings):
        return Campaign(self.binaries, os.path.join(self.folder, name), **settings)

    def running(self, campaign, tasks=1):
        """Waits until so many tasks are in the middle of a seed."""
        self.cluster.wait_until(lambda: len(self.cluster.tasks()) >= tasks, f"{tasks} running tasks")
        time.sleep(0.5)

    # Each case runs a campaign to its end and says what happened.

    def arrays(self, campaign):
        campaign.do(*campaign.follow("--seeds-per-task", "2", "--largest-array", "4"))
        arrays = campaign.ask("SELECT count(*) FROM bundle")
        largest = campaign.ask("SELECT max(tasks) FROM bundle")
        assert largest == 4 and arrays > 2, (arrays, largest)
        return f"{arrays} arrays of up to {largest} tasks, 2 seeds a task"

    def killed_engine(self, campaign):
        owner = campaign.start(*campaign.follow())
        killed = 0
        for _ in range(4):
            self.running(campaign)
            killed += kill_one("fake_engine", campaign.folder)
        assert owner.wait(300) == 0
        seen = campaign.ask("SELECT count(*) FROM attempt WHERE outcome = 'killed'")
        assert seen > 0, campaign.log()
        return f"{killed} engines of running tasks killed, {seen} reported"

    def killed_task(self, campaign):
        campaign.holds(1)
        owner = campaign.start(*campaign.follow("--seeds-per-task", "2"))
        killed = 0
        for _ in range(3):
            self.running(campaign)
            killed += kill_one("peclet task", campaign.folder)
        self.running(campaign)
        element = self.cluster.tasks()[0]
        self.cluster.say("scancel", element)
        self.running(campaign)
        self.cluster.say("scancel", "--signal=KILL", "--full", self.cluster.tasks()[0])
        campaign.lets_go()
        assert owner.wait(300) == 0
        returned = campaign.ask("SELECT count(*) FROM bundle_seed WHERE outcome IN ('returned', 'killed')")
        assert returned > 0, campaign.log()
        return f"{killed} tasks killed, 2 by scancel; {returned} seeds queued again"

    def preempted(self, campaign):
        owner = campaign.start(*campaign.follow())
        self.running(campaign, CPUS)
        self.cluster.say("sbatch", "--partition=urgent", f"--cpus-per-task={CPUS - 1}", "--job-name=urgent", "--output=/dev/null",
                         "--wrap", "sleep 2")
        self.cluster.wait_until(lambda: self.cluster.restarts() > 0, "a preemption")
        restarts = self.cluster.restarts()
        assert owner.wait(300) == 0, campaign.log()
        assert campaign.ask("SELECT count(*) FROM bundle_seed WHERE outcome != 'result'") == 0, campaign.log()
        return f"{restarts} tasks preempted and queued again by Slurm"

    def warned(self, campaign):
        owner = campaign.start(*campaign.follow())
        warnings = 0
        while self.cluster.restarts() == 0:  # a task may end just before its warning comes
            assert owner.poll() is None, campaign.log()
            self.running(campaign)
            for element in self.cluster.tasks()[:2]:
                self.cluster.say("scancel", "--batch", "--signal=USR1", element)
                warnings += 1
            time.sleep(2)
        restarts = self.cluster.restarts()
        assert owner.wait(300) == 0, campaign.log()
        assert campaign.ask("SELECT count(*) FROM bundle_seed WHERE outcome != 'result'") == 0, campaign.log()
        return f"{warnings} tasks warned as at the time limit, {restarts} queued themselves again"

    def time_limit(self, campaign):
        owner = campaign.start(*campaign.follow("--option=--time=1", "--option=--signal=B:USR1@30"))
        self.cluster.wait_until(lambda: self.cluster.restarts() > 0, "a task at its time limit", 120)
        restarts = self.cluster.restarts()
        assert owner.wait(300) == 0, campaign.log()
        assert campaign.blamed() == 0 and campaign.ask("SELECT count(*) FROM bundle_seed WHERE outcome != 'result'") == 0
        return f"{restarts} tasks at a real time limit of a minute queued themselves again"

    def controller_restarted(self, campaign):
        owner = campaign.start(*campaign.follow())
        for number in (signal.SIGTERM, signal.SIGKILL):
            self.running(campaign)
            self.cluster.stop("slurmctld", number)
            time.sleep(1)
            self.cluster.start_controller()
            self.cluster.wait_for_controller()
        # Killed, it may have forgotten jobs that it had started, and give their numbers out again; it then takes the node
        # out of use until an administrator says that all is well.
        resumed = 0
        end = time.monotonic() + 240
        while owner.poll() is None and time.monotonic() < end:
            resumed += self.cluster.resume_node()
            time.sleep(1)
        assert owner.wait(60) == 0, campaign.log()
        return f"slurmctld stopped and killed under running tasks, and started again; node resumed {resumed} times"

    def controller_away(self, campaign):
        campaign.holds()
        campaign.do(*campaign.hand_over())
        self.running(campaign, 2)
        out = campaign.ask("SELECT count(*) FROM bundle_seed WHERE outcome IS NULL")
        self.cluster.stop("slurmctld")
        campaign.lets_go()
        self.cluster.wait_until(campaign.spooled, "tasks that end meanwhile")
        campaign.do("ingest", "drill.json")
        assert "unknown" in campaign.log(), campaign.log()
        assert campaign.ask("SELECT count(*) FROM bundle_seed WHERE outcome NOT IN ('result')") == 0
        taken = campaign.ended()
        assert taken > 0, campaign.log()
        self.cluster.start_controller()
        self.cluster.wait_for_controller()
        campaign.do(*campaign.follow())
        return f"of {out} seeds {taken} taken in without a controller, the others left alone"

    def answer_lost(self, campaign):
        template = template_of(campaign, 'sbatch --parsable "$@" "$script" >> "$HOME_OF_DRILL/numbers"; exit 1')
        campaign.holds()
        campaign.do(*campaign.hand_over("--template", template))
        assert campaign.ask("SELECT count(*) FROM bundle WHERE job IS NULL") == 1, campaign.log()
        campaign.do(*campaign.hand_over("--template", template))  # nothing is left to hand over: only the name is asked for
        assert campaign.ask("SELECT count(*) FROM bundle WHERE job IS NULL") == 0, campaign.log()
        with open(os.path.join(campaign.folder, "numbers")) as f:
            submitted = len(f.readlines())
        assert submitted == 1, f"submitted {submitted} times"
        campaign.lets_go()
        campaign.do(*campaign.follow())
        return "sbatch took the job and failed: found by its name, submitted once"

    def submission_failed(self, campaign):
        template = template_of(campaign, 'if mkdir "$HOME_OF_DRILL/failed"; then exit 1; fi\nsbatch --parsable "$@" "$script"')
        campaign.do(*campaign.follow("--template", template))
        assert campaign.log().count("the submission failed") == 1, campaign.log()
        return "sbatch failed without a job: asked for by name, submitted again"

    def owner_killed(self, campaign):
        kills = 0
        for _ in range(6):
            owner = campaign.start(*campaign.follow("--seeds-per-task", "2"))
            time.sleep(self.chance.uniform(0.1, 1.5))
            if owner.poll() is None:
                owner.kill()
                kills += 1
            owner.wait()
        campaign.do(*campaign.follow("--seeds-per-task", "2"))
        return f"owner killed {kills} times at any moment"

    def taken_back(self, campaign):
        campaign.do(*campaign.hand_over("--seeds-per-task", "3"))
        self.running(campaign)
        campaign.do("run", "drill.json", "--workers", "2", code=75)  # the seeds are not its own to run
        campaign.do("ingest", "drill.json", "--cancel")
        assert not self.cluster.tasks("RUNNING,PENDING"), self.cluster.say("squeue")
        finished = campaign.ended()
        campaign.run_locally()
        return f"jobs cancelled after {finished} seeds, the rest run by `peclet run`"

    def failing_engine(self, campaign):
        campaign.do(*campaign.follow(), code=3)
        blamed = campaign.blamed()
        assert blamed == 2 * (3 + 1), campaign.log()  # two points; seed 3 is given up the third time, seed 4 fails once
        return f"{blamed:.0f} attempts blamed on the engine, as without Slurm"

    def real_engine(self, campaign):
        owner = campaign.start(*campaign.follow("--seeds-per-task", "2"))
        self.running(campaign)
        element = self.cluster.tasks()
        for one in element[:2]:
            self.cluster.say("scontrol", "requeue", one)
        assert owner.wait(300) == 0, campaign.log()
        return f"peclet-engine, {min(2, len(element))} running tasks queued again"


def kill_one(what, folder):
    """Kills one process of a campaign with SIGKILL: its command has `what`, its environment or command the folder."""
    for process in os.listdir("/proc"):
        try:
            with open(f"/proc/{process}/cmdline", "rb") as f:
                command = f.read().replace(b"\0", b" ").decode(errors="replace")
            with open(f"/proc/{process}/environ", "rb") as f:
                environment = f.read().decode(errors="replace")
        except (OSError, ValueError):
            continue
        if what in command and f"SLURM_SUBMIT_DIR={folder}\0" in environment:
            os.kill(int(process), signal.SIGKILL)
            return 1
    return 0


def template_of(campaign, submission):
    """The Slurm template with another way to submit."""
    source = os.path.join(os.path.dirname(__file__), "..", "..", "templates", "slurm")
    template = os.path.join(campaign.folder, "template")
    shutil.copytree(source, template)
    with open(os.path.join(template, "submit.sh"), "w") as f:
        f.write(f"script=$2\nshift 2\nHOME_OF_DRILL='{campaign.folder}'\n{submission}\n")
    return template


FAULTS = {"PECLET_FAKE_FAULTS": "crash:3 exit:4x1 overlap:5 kill:2x2"}
QUICK = ("arrays", "killed_task", "controller_away", "answer_lost")
CASES = QUICK + ("killed_engine", "preempted", "warned", "controller_restarted", "submission_failed", "owner_killed",
                 "taken_back", "failing_engine", "real_engine")
SLOW = ("time_limit",)  # Slurm's shortest limit is a minute
LONG_SEEDS = {**CAMPAIGN, "target": {"relative_tolerance": 0.9}, "realisations": {"minimum": 4, "maximum": 4}}
LONGER = {"environment": {"PECLET_FAKE_STEP_MS": "75"}}  # the same results
SETTINGS = {"preempted": LONGER,
            "warned": LONGER,
            "time_limit": {"document": LONG_SEEDS, "environment": {"PECLET_FAKE_STEP_MS": "1500"}},
            "failing_engine": {"environment": FAULTS},
            "real_engine": {"document": REAL}}


def try_case(drill, name, expected):
    campaign = drill.campaign(name, **SETTINGS.get(name, {}))
    started = time.monotonic()
    try:
        said = getattr(drill, name)(campaign)
        lost, double, again, same = campaign.lost(), campaign.double(), campaign.again(), campaign.export() == expected
    except (AssertionError, subprocess.SubprocessError) as error:
        print(f"{name}: {error}\n{drill.cluster.log()}", file=sys.stderr)
        said, lost, double, again, same = "FAILED", "?", "?", "?", False
        drill.cluster.clear()
    finally:
        campaign.stop()
    print(f"{name:22}{lost:>5}{double:>7}{again:>10}  {'yes' if same else 'NO':5}{time.monotonic() - started:6.1f} s  {said}", flush=True)
    return same and lost == 0 and double == 0


def kind_of(name):
    """What a case runs: a campaign of its own, or the plain one."""
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
    with contextlib.ExitStack() as stack:
        folder = arguments.keep or stack.enter_context(tempfile.TemporaryDirectory(prefix="slurm-drill-"))
        os.makedirs(folder, exist_ok=True)
        os.chmod(folder, 0o755)  # munged wants its socket to be reachable
        cluster = stack.enter_context(Cluster(os.path.join(folder, "cluster")))
        drill = Drill(os.path.abspath(arguments.bin), folder, cluster)
        expected = expected_exports(drill, names)
        print(f"{cluster.say('slurmctld', '-V')}; one node, {CPUS} processors\n")
        print(f"{'case':22}{'lost':>5}{'double':>7}{'run again':>10}  {'same':5}{'time':>8}  what happened")
        good = [try_case(drill, name, expected[name]) for name in names]
    print(f"\n{sum(good)} of {len(good)} cases: nothing lost, nothing double, the same bytes as without Slurm")
    return 0 if all(good) else 1


if __name__ == "__main__":
    sys.exit(main())
