"""A campaign that is run locally or through a batch system, and counted afterwards."""
import os
import subprocess

from campaign_folder import BLAMED, CampaignFolder
from slurm_cluster import CPUS

# Seeds of about a second with several checkpoints, and a few stop tests per point.
ENVIRONMENT = {"PECLET_FAKE_STEPS": "40", "PECLET_FAKE_STEP_MS": "25"}
CAMPAIGN = {
    "name": "drill",
    "scene": {"fluid": {"viscosity": 1}, "peclet": 1},
    "sweep": [{"set": "/peclet", "values": [1, 2]}],
    "target": {"observable": "relative_viscosity", "relative_tolerance": 0.055},
    "realisations": {"minimum": 8, "maximum": 40},
}


class Campaign(CampaignFolder):
    """A campaign in a folder of its own, run locally or through a batch system."""

    system = "slurm"

    def __init__(self, binaries, folder, document=None, environment=None):
        document = document or CAMPAIGN
        engine = "peclet-engine" if document["scene"].get("particles") else "fake_engine"
        document = {**document, "engine": [os.path.join(binaries, engine), "serve"]}
        super().__init__(binaries, folder, document, {**ENVIRONMENT, **(environment or {})})
        self.shared, self.hold = self.place("shared"), self.place("hold")
        self.processes = []

    def holds(self, seed=0):
        """Makes this and later seeds of the fake engine stop half-way in running tasks, until lets_go()."""
        with open(self.hold, "w"):
            pass
        self.environment.update(PECLET_FAKE_HOLD=self.hold, PECLET_FAKE_HOLD_SEED=str(seed))

    def holds_no_more(self):
        """Ends holds() for processes started later; held tasks stay held."""
        for name in ("PECLET_FAKE_HOLD", "PECLET_FAKE_HOLD_SEED"):
            del self.environment[name]

    def lets_go(self):
        os.remove(self.hold)

    def start(self, *words):
        self.processes.append(super().start(*words))
        return self.processes[-1]

    def stop(self):
        """Ends the processes left by a failed case."""
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
        return ("hand-over", self.system, "drill.json", "--shared", self.shared, "--checkpoint", "0.1", *words)

    def follow(self, *words):
        return self.hand_over("--follow", "--interval", "0.3", *words)

    def printed(self):
        """Returns the output of the job of start_job()."""
        path = self.place("friction.log")
        if not os.path.exists(path):
            return ""
        with open(path, errors="replace") as f:
            return "--- friction.log\n" + f.read()

    def start_job(self, *options):
        """Submits the script that `peclet template slurm-nodes` prints; its backup is drill.saved."""
        with open(self.place("nodes.sh"), "wb") as script:
            script.write(self.say("template", "slurm-nodes").stdout)
        subprocess.run(
            ["sbatch", "--job-name=friction", *options, "nodes.sh", "drill.json", "--checkpoint=0.1"],
            cwd=self.folder,
            check=True,
            capture_output=True,
            env={**os.environ, **self.environment, "PATH": self.programs + ":" + os.environ["PATH"]},
        )

    def spooled(self):
        spool = os.path.join(self.shared, "spool")
        return [name for name in os.listdir(spool) if name.endswith(".json")] if os.path.isdir(spool) else []

    def lost(self):
        """Returns the number of required seeds without a result, and of files, bundles and seeds left."""
        wanted = self.ask("SELECT sum(seeds) FROM estimates")
        closed = self.ask(
            "SELECT count(*) FROM realisation JOIN point USING (point_id) JOIN estimates USING (hash)"
            " WHERE seed < seeds AND state IN ('done', 'failed', 'quarantined')"
        )
        left = self.ask("SELECT count(*) FROM bundle_seed WHERE outcome IS NULL")
        spool = os.path.join(self.shared, "spool")
        files = [
            name
            for folder in (spool, os.path.join(spool, "files"))
            if os.path.isdir(folder)
            for name in os.listdir(folder)
            if name not in ("rejected", "files")
        ]
        return wanted - closed + left + len(files)

    def double(self):
        """Returns the number of results beyond the first of a seed, counted or with differing content."""
        return int(
            self.ask("SELECT count(*) - count(DISTINCT point_id || ' ' || seed) FROM result")
            + self.ask("SELECT total(suspect) FROM point")
            + self.ask("SELECT count(*) FROM event WHERE kind IN ('suspect', 'rejected', 'mixed-engine')")
        )

    def again(self):
        """Returns the number of seeds that were completed a second time, which costs time only."""
        return self.ask(
            "SELECT coalesce(sum(n - 1), 0) FROM (SELECT count(*) AS n FROM attempt WHERE outcome = 'result'"
            " GROUP BY point_id, seed)"
        )

    def blamed(self):
        return self.ask(BLAMED)


def template_of(campaign, submission):
    """Returns a template with another submit.sh."""
    template = campaign.place("template")
    os.makedirs(template)
    with open(os.path.join(template, "submit.sh"), "w") as f:
        f.write(f"script=$2\nshift 2\nHOME_OF_DRILL='{campaign.folder}'\n{submission}\n")
    return template
