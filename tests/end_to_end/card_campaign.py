#!/usr/bin/python3
"""card_campaign.py PROGRAMS

Tests campaigns whose engine has the processor as a card and runs several seeds at once. Its runs are ended at
random moments: by SIGTERM, which leaves checkpoints, by SIGKILL of an engine alone, and by SIGKILL of everything. In
the end the canonical export must be that of an undisturbed campaign.
"""
import os
import random
import signal
import subprocess
import sys
import tempfile
import time

from campaign_folder import SMALL_SCENE, CampaignFolder, children

POINTS = [[0, 0], [0.5, 0], [0.5, 0.02]]  # friction, k_B T
SEEDS = 8


def check(holds, *what):
    if not holds:
        raise SystemExit("card_campaign.py: " + " ".join(map(str, what)))


class Campaign(CampaignFolder):
    def __init__(self, programs, folder):
        keys = ["/contact/friction", "/fluid/thermal_energy"]
        document = {"name": "cards", "scene": SMALL_SCENE, "sweep": [{"set": keys, "values": POINTS}]}
        document |= {"target": {"observable": "pressure", "absolute_tolerance": 1e9}}
        document |= {"realisations": {"minimum": SEEDS, "maximum": SEEDS}}
        super().__init__(programs, folder, document, {"PECLET_DEVICE": "emulated"})

    def run(self):
        return self.start("run", self.file, "--quiet", "--workers=1", start_new_session=True)


def disturbed(campaign, generator):
    """Runs the campaign to its end through interruptions; returns their number."""
    for times in range(100):
        process = campaign.run()
        try:
            process.wait(timeout=generator.uniform(0.5, 1 + 0.2 * times))
            check(process.returncode == 0, "run ended with", process.returncode, campaign.log())
            return times
        except subprocess.TimeoutExpired:
            how = generator.choice(["SIGTERM", "engine", "everything"])
            if how == "engine":
                for engine in children(process.pid):
                    os.kill(engine, signal.SIGKILL)
                time.sleep(generator.uniform(0, 0.5))
            if how == "everything":
                os.killpg(process.pid, signal.SIGKILL)
            else:
                process.send_signal(signal.SIGTERM)
            process.wait(timeout=60)
            time.sleep(0.1)
    raise SystemExit("card_campaign.py: does not come to an end")


def main():
    with tempfile.TemporaryDirectory() as folder:
        calm, wild = (Campaign(sys.argv[1], os.path.join(folder, name)) for name in ("calm", "wild"))
        check(calm.run().wait() == 0, "undisturbed, it fails", calm.log())
        times = disturbed(wild, random.Random(2))
        check(times > 2, "was disturbed", times, "times only")
        check(calm.ended() == SEEDS * len(POINTS), calm.ended(), "results")
        check(calm.export() == wild.export(), "differs after interruptions")
        check(wild.say("doctor", wild.file).returncode == 0, "is not sound")
        print(f"{calm.ended()} results on an emulated card: the same bytes after {times} interruptions")


main()
