#!/usr/bin/python3
"""launched_campaign.py PROGRAMS [KILLS]

Tests campaigns whose workers are launched (peclet run --launch). Their far ends have folders of their own; only
the frames connect them with the owner. Checkpoints, trajectories and results come home in pieces. The canonical export
must be that of one local worker: undisturbed, with a launcher that prints a greeting, with an engine that fails in
several ways, and with KILLS (12) random SIGKILL and SIGTERM of engines, far ends, launchers, near ends and the owner.
Orphans must end by themselves.
"""
import os
import random
import signal
import subprocess
import sys
import tempfile
import time

from campaign_folder import SMALL_SCENE, CampaignFolder, comes_true, processes_with
from drill.campaign import FAKE

SCENE = SMALL_SCENE | {
    "contact": {"normal_stiffness": 5e4},
    "duration": {"equilibration": {"strain": 0.3}, "production": {"strain": 20}},
    "observables": ["stress", "trajectory"],
    "trajectory": {"interval": {"strain": 0.02}},
    "files": {"final_configuration": True},
}
SEEDS = 6
# The fake engine counts its tries in the folder of failures, which stays on this machine.
FAULTS = "crash:1 exit:2 garble:3 refuse:4 overlap:5 mute:6 truncate:7"
GREETING = """sh -c 'echo "Welcome to node7. PCF"; exec "$0" "$@"'"""
PARTS = {  # words of the command lines of what is killed
    "engine": ("peclet-engine", "serve"),
    "far end": ("peclet", "worker"),
    "near end": ("peclet", "worker", "--through"),
    "launcher": ("/bin/sh", "-c"),
}


def check(holds, *what):
    if not holds:
        raise SystemExit("launched_campaign.py: " + " ".join(map(str, what)))


def words_of(process):
    try:
        with open(f"/proc/{process}/cmdline", "rb") as f:
            return f.read().decode(errors="replace").split("\0")[:-1]
    except OSError:
        return []


def is_part(words, part):
    program, *others = PARTS[part]
    if not words or os.path.basename(words[0]) != os.path.basename(program) or others != words[1 : len(others) + 1]:
        return False
    return part != "far end" or len(words) == 2


class Campaign(CampaignFolder):
    def __init__(self, programs, folder, seeds=SEEDS):
        document = {"name": "far", "scene": SCENE, "sweep": [{"set": "/contact/friction", "values": [0, 0.5]}]}
        document |= {"target": {"observable": "pressure", "absolute_tolerance": 1e9}}
        document |= {"realisations": {"minimum": seeds, "maximum": seeds}}
        self.far = os.path.join(folder, "far folders")
        super().__init__(programs, folder, document, {"TMPDIR": self.far})
        os.makedirs(self.far)

    def run(self, *words):
        return self.start("run", self.file, "--quiet", "--checkpoint=0.1", *words, start_new_session=True)

    def processes(self):
        """Returns the processes of the workers of any owner of this campaign."""
        return processes_with("PECLET_CAMPAIGN", self.data)

    def leaves_nothing(self):
        check(comes_true(lambda: not self.processes(), 70), "left processes:", *map(words_of, self.processes()))

    def completed(self, process, what):
        check(process.wait(timeout=300) == 0, what, "ended with", process.returncode, self.log())
        self.leaves_nothing()
        for name in os.listdir(self.far):  # those of killed far ends, which a later one removes
            os.utime(os.path.join(self.far, name), (1, 1))
        self.say("worker", stdin=subprocess.DEVNULL)
        check(not os.listdir(self.far), what, "left", os.listdir(self.far))
        check(self.say("doctor", self.file).returncode == 0, what, "is not sound")


def disturbed(campaign, kills, generator):
    """Runs the campaign to its end through kills; returns the number of each kind."""
    done = dict.fromkeys([*PARTS, "owner", "stop"], 0)
    process = campaign.run("--launch=env", "--workers=2")
    while sum(done.values()) < kills:
        time.sleep(generator.uniform(0.1, 0.8))
        if process.poll() is not None:
            check(process.returncode == 0, "the disturbed run ended with", process.returncode, campaign.log())
            break
        kind = generator.choice(list(done))
        if kind == "stop":
            process.send_signal(signal.SIGTERM)
            check(process.wait(timeout=70) in (0, 75), "a stop ended with", process.returncode, campaign.log())
        elif kind == "owner":
            os.kill(process.pid, signal.SIGKILL)
            process.wait()
        else:
            found = [p for p in campaign.processes() if is_part(words_of(p), kind)]
            if not found:
                continue
            try:
                os.kill(generator.choice(found), generator.choice([signal.SIGKILL, signal.SIGTERM]))
            except ProcessLookupError:
                continue
        done[kind] += 1
        if process.poll() is not None:
            process = campaign.run("--launch=env", "--workers=2")
    return process, done


def blame_of_engine(folder, how):
    """Runs a campaign of the fake engine, whose faults are its own; returns the export and what is blamed."""
    document = FAKE | {"engine": [os.path.join(os.path.abspath(sys.argv[1]), "fake_engine")]}
    campaign = CampaignFolder(
        sys.argv[1], os.path.join(folder, "faults" + how), document, {"PECLET_FAKE_FAULTS": FAULTS}
    )
    process = campaign.start("run", campaign.file, "--quiet", "--workers=2", how)
    check(
        process.wait(timeout=100) == 3, "with faults of the engine, it ended with", process.returncode, campaign.log()
    )
    blamed = campaign.query("SELECT seed, outcome, count(*) FROM attempt WHERE blamed GROUP BY seed, outcome")
    check(len(blamed) >= 4, "too few faults:", blamed)
    return campaign.export(), blamed


def main():
    kills = int(sys.argv[2]) if len(sys.argv) > 2 else 12
    with tempfile.TemporaryDirectory() as folder:
        calm, far, greeted, wild = (
            Campaign(sys.argv[1], os.path.join(folder, name)) for name in ("calm", "far", "greeted", "wild")
        )
        calm.completed(calm.run("--workers=1"), "the local run")
        expected = calm.export()
        for campaign, launcher in ((far, "env"), (greeted, GREETING)):
            campaign.completed(campaign.run(f"--launch={launcher}", "--workers=2"), f"launched by {launcher}, it")
            check(campaign.export() == expected, "launched by", launcher, "it gives other results")
        near, far = (blame_of_engine(folder, how) for how in ("--threads=1", "--launch=env"))
        check(near == far, "faults of the engine are blamed otherwise when it is launched:", near[1], far[1])
        process, done = disturbed(wild, kills, random.Random(42))
        wild.completed(process, f"after {done}, it")
        check(wild.export() == expected, "after", done, "it gives other results")
        blamed = wild.ask("SELECT total(blamed) FROM attempt")
        check(blamed == 0, blamed, "kills were blamed on seeds", wild.query("SELECT * FROM attempt WHERE blamed"))
        # A host that does not work is said once.
        lost = Campaign(sys.argv[1], os.path.join(folder, "lost"))
        process = lost.run("--launch=exit 255; #", "--workers=3")
        check(process.wait(timeout=60) == 1, "without a host, it ended with", process.returncode, lost.log())
        said = lost.log()
        check(said.count("the launcher ended: exit status 255; what") == 1, "a lost host is not said once:", said)
        print(f"{calm.ended()} results of launched workers: the same bytes, also after", done)


if __name__ == "__main__":
    main()
