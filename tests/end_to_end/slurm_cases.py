"""Disturbances of campaigns in Slurm: each case runs one to its end and returns what happened."""
import os
import random
import signal
import time

from campaign_folder import processes_with
from slurm_campaign import Campaign, template_of
from slurm_cluster import CPUS

# Takes the node from other jobs.
URGENT = (
    "sbatch",
    "--partition=urgent",
    f"--cpus-per-task={CPUS - 1}",
    "--job-name=urgent",
    "--output=/dev/null",
    "--wrap",
    "sleep 2",
)
DRAINED = "SELECT count(*) FROM attempt WHERE outcome = 'drained'"
# As Slurm does before a time limit.
WARNING = ("scancel", "--batch", "--signal=USR1", "--me")


class Drill:
    def __init__(self, binaries, folder, cluster):
        self.binaries, self.folder, self.cluster = binaries, folder, cluster
        self.chance = random.Random(1)

    def campaign(self, name, **settings):
        return Campaign(self.binaries, os.path.join(self.folder, name), **settings)

    def running(self, campaign, tasks=1):
        """Waits until `tasks` tasks are in the middle of a seed."""
        self.cluster.wait_until(lambda: len(self.cluster.tasks()) >= tasks, f"{tasks} running tasks")
        time.sleep(0.5)

    # The cases: each runs a campaign to its end and returns what happened.

    def arrays(self, campaign):
        campaign.environment["SQUEUE_PARTITION"] = "urgent"  # would hide all jobs
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
        assert owner.wait(300) == 0, campaign.log()
        returned = campaign.ask("SELECT count(*) FROM bundle_seed WHERE outcome IN ('returned', 'killed')")
        assert returned > 0, campaign.log()
        return f"{killed} tasks killed, 2 by scancel; {returned} seeds queued again"

    def preempted(self, campaign):
        owner = campaign.start(*campaign.follow())
        self.running(campaign, CPUS)
        self.cluster.say(*URGENT)
        self.cluster.wait_until(lambda: self.cluster.restarts() > 0, "a preemption")
        restarts = self.cluster.restarts()
        assert owner.wait(300) == 0, campaign.log()
        assert campaign.ask("SELECT count(*) FROM bundle_seed WHERE outcome != 'result'") == 0, campaign.log()
        return f"{restarts} tasks preempted and queued again by Slurm"

    def warned(self, campaign):
        owner = campaign.start(*campaign.follow())
        warnings = 0
        while self.cluster.restarts() == 0:  # a task may end just before its warning
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
        assert (
            campaign.blamed() == 0 and campaign.ask("SELECT count(*) FROM bundle_seed WHERE outcome != 'result'") == 0
        )
        return f"{restarts} tasks at a real time limit of a minute queued themselves again"

    def controller_restarted(self, campaign):
        owner = campaign.start(*campaign.follow())
        for number in (signal.SIGTERM, signal.SIGKILL):
            self.running(campaign)
            self.cluster.stop("slurmctld", number)
            time.sleep(1)
            self.cluster.restart_controller()
        # A killed controller may forget jobs that it had started, and reuse their numbers. It then drains the
        # node until an administrator resumes it.
        resumed = 0
        end = time.monotonic() + 240
        while owner.poll() is None and time.monotonic() < end:
            resumed += self.cluster.resume_nodes()
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
        self.cluster.restart_controller()
        campaign.do(*campaign.follow())
        return f"of {out} seeds {taken} taken in without a controller, the others left alone"

    def answer_lost(self, campaign):
        template = template_of(campaign, 'sbatch --parsable "$@" "$script" >> "$HOME_OF_DRILL/numbers"; exit 75')
        campaign.holds()
        campaign.do(*campaign.hand_over("--template", template))
        assert campaign.ask("SELECT count(*) FROM bundle WHERE job IS NULL") == 1, campaign.log()
        campaign.do(
            *campaign.hand_over("--template", template)
        )  # only the name is required: nothing is left to hand over
        assert campaign.ask("SELECT count(*) FROM bundle WHERE job IS NULL") == 0, campaign.log()
        with open(campaign.place("numbers")) as f:
            submitted = len(f.readlines())
        assert submitted == 1, f"submitted {submitted} times"
        campaign.lets_go()
        campaign.do(*campaign.follow())
        return "sbatch took the job and nobody heard of it: found by its name, submitted once"

    def submission_lost(self, campaign):
        template = template_of(
            campaign, 'if mkdir "$HOME_OF_DRILL/failed"; then exit 75; fi\nsbatch --parsable "$@" "$script"'
        )
        campaign.do(*campaign.follow("--template", template))
        assert campaign.log().count("whether the batch system has taken the job is unknown") == 1, campaign.log()
        return "nobody heard of the submission, and there is no job: asked for by name, submitted again"

    def refused(self, campaign):
        campaign.do(*campaign.hand_over("--option=--partition=nosuch"), code=1)
        assert "nvalid partition" in campaign.log(), campaign.log()
        self.cluster.stop("slurmctld")
        campaign.do(*campaign.hand_over(), code=1)
        assert "Unable to contact slurm controller" in campaign.log(), campaign.log()
        self.cluster.restart_controller()
        assert campaign.ask("SELECT count(*) FROM bundle_seed WHERE outcome IS NULL") == 0
        campaign.run_locally()
        return "sbatch refused, and without a controller: exit code 1, nothing out, all run by `peclet run`"

    def odd_folder(self, campaign):
        campaign.shared = os.path.join(campaign.folder, "a b %j 'c' \"d\" #e $HOME")
        campaign.holds()
        campaign.do(*campaign.hand_over())
        self.running(campaign)
        logs = os.path.join(campaign.shared, "bundles", campaign.ask("SELECT name FROM bundle"), "logs")
        # A task counts as running shortly before its log exists.
        self.cluster.wait_until(lambda: os.path.isdir(logs) and os.listdir(logs), "the log of a task")
        printed = sorted(os.listdir(logs))
        assert printed and printed[0].startswith("task-"), (logs, printed)
        campaign.lets_go()
        campaign.do(*campaign.follow())
        return f"a shared folder called {os.path.basename(campaign.shared)}"

    def forgotten(self, campaign):
        campaign.holds()
        campaign.do(*campaign.hand_over())
        self.running(campaign)
        self.cluster.stop("slurmctld")
        campaign.do("ingest", "drill.json", "--forget", campaign.ask("SELECT name FROM bundle"))
        assert campaign.ask("SELECT count(*) FROM bundle_seed WHERE outcome IS NULL") == 0
        campaign.holds_no_more()
        campaign.run_locally()
        campaign.lets_go()
        self.cluster.wait_until(campaign.spooled, "late results")
        self.cluster.restart_controller()
        self.cluster.wait_until(lambda: not self.cluster.tasks("RUNNING,PENDING,COMPLETING"), "the late tasks to leave")
        late = len(campaign.spooled())
        campaign.do("ingest", "drill.json")
        return f"forgotten while its tasks ran and nobody answered; {late} late results, none counted twice"

    def one_job(self, campaign):
        campaign.start_job()
        for interruption in (WARNING, URGENT):
            self.interrupt(interruption)
        return f"one job, the database on its node: warned, preempted; {self.end_job(campaign)}"

    def three_nodes(self, campaign):
        # Slurm gives --mem to the first step of a node, unless the script prevents that.
        campaign.start_job("--nodes=3", f"--ntasks-per-node={CPUS}", "--mem=800")
        self.wait_for_job()
        # Without the first node there is neither script nor database.
        node = self.cluster.say("squeue", "-h", "--me", "-o", "%B")
        self.cluster.wait_until(lambda: len(engines_on(node)) >= CPUS, f"engines on {node}")
        time.sleep(1.5)
        before = self.cluster.restarts()
        self.cluster.kill_node(node)
        self.cluster.wait_until(lambda: self.cluster.restarts() > before, "the job to be queued again", 120)
        self.cluster.start_node(node)
        self.wait_for_job()
        job = self.cluster.say("squeue", "-h", "--me", "--states=RUNNING", "-o", "%A")
        for interruption in (WARNING, URGENT, ("scontrol", "requeue", job)):
            self.interrupt(interruption)
        return f"one job of three nodes: the first died; warned, preempted, requeued; {self.end_job(campaign)}"

    def nodes_at_limit(self, campaign):
        campaign.start_job("--nodes=3", f"--ntasks-per-node={CPUS}", "--time=1", "--signal=B:USR1@30")
        self.cluster.wait_until(lambda: self.cluster.restarts() > 0, "the time limit", 120)
        return f"one job of three nodes at a real time limit of a minute; {self.end_job(campaign)}"

    def wait_for_job(self):
        running = ("squeue", "-h", "--me", "--states=RUNNING", "-o", "%j")
        self.cluster.wait_until(lambda: self.cluster.say(*running) == "friction", "the job", 120)

    def interrupt(self, words):
        """Does what makes Slurm queue the running job again."""
        self.wait_for_job()
        time.sleep(2)
        before = self.cluster.restarts()
        self.cluster.say(*words)
        self.cluster.wait_until(lambda: self.cluster.restarts() > before, "the job to be queued again", 120)

    def end_job(self, campaign):
        """Waits for the end of the job of start_job(), and takes in its backup."""
        self.cluster.wait_until(lambda: not self.cluster.say("squeue", "-h", "--me"), "the end of the job", 300)
        campaign.do("restore", campaign.place("drill.saved"), "drill.json")
        assert campaign.blamed() == 0, campaign.printed()
        return f"{campaign.ask(DRAINED)} seeds went on from checkpoints"

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
        campaign.do("run", "drill.json", "--workers", "2", code=75)  # its seeds belong to Slurm
        campaign.do("ingest", "drill.json", "--cancel")
        assert not self.cluster.tasks("RUNNING,PENDING"), self.cluster.say("squeue")
        finished = campaign.ended()
        campaign.run_locally()
        return f"jobs cancelled after {finished} seeds, the rest run by `peclet run`"

    def failing_engine(self, campaign):
        campaign.do(*campaign.follow(), code=3)
        blamed = campaign.blamed()
        assert blamed == 2 * (3 + 1), campaign.log()  # two points; seed 3 fails three times, seed 4 once
        return f"{blamed:.0f} attempts blamed on the engine, as without Slurm"

    def real_engine(self, campaign):
        owner = campaign.start(*campaign.follow("--seeds-per-task", "2"))
        self.running(campaign)
        element = self.cluster.tasks()
        for one in element[:2]:
            self.cluster.say("scontrol", "requeue", one)
        assert owner.wait(300) == 0, campaign.log()
        return f"peclet-engine, {min(2, len(element))} running tasks queued again"


def command_of(process):
    try:
        with open(f"/proc/{process}/cmdline", "rb") as f:
            return f.read().replace(b"\0", b" ")
    except OSError:
        return b""


def engines_on(node):
    return [process for process in processes_with("SLURMD_NODENAME", node) if b" serve" in command_of(process)]


def kill_one(what, folder):
    """Kills a process with `what` in its command, and the folder in its environment or command."""
    for process in processes_with("SLURM_SUBMIT_DIR", folder):
        if what in command_of(process).decode(errors="replace"):
            os.kill(process, signal.SIGKILL)
            return 1
    return 0
