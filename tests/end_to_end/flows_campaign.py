#!/usr/bin/python3
"""flows_campaign.py PROGRAMS

Tests campaigns of time-dependent, extensional and stress-driven flows that are killed and resumed. A campaign
has a point for each flow. Its runs are ended again and again by SIGTERM, which leaves checkpoints, and by
SIGKILL of everything. In the end it must have the results of an undisturbed campaign, except for costs. A
point that may jam must report the fraction of seeds that flow, and aim at the rate of all.
"""
import json
import os
import random
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "results"))
from campaign_folder import CampaignFolder
from studies.campaigns import read_results

SCENE = {
    "particles": {
        "count": 100,
        "density": 0.001,
        "species": [{"radius": 1, "number_share": 1}, {"radius": 1.4, "number_share": 1}],
    },
    "volume_fraction": 0.4,
    "guard": {"largest_overlap": 0.1},  # so that no seed is lost
    "fluid": {"viscosity": 1},
    "contact": {"normal_stiffness": 2e4, "friction": 0.5},
    "lubrication": {"form": "kim-karrila", "inner_gap": 0.001, "outer_gap": 0.05},
}


def lasting(**limit):
    ((name, amount),) = limit.items()
    return {"equilibration": {name: amount / 4}, "production": {name: amount}}


CYCLES = {"equilibration": {"cycles": 1}, "production": {"cycles": 4}}
RAMP = [{"shear_rate": 0, "final_rate": 1, "time": 1}, {"shear_rate": 0}]
# Flow, k_B T, observables and durations.
POINTS = [
    ({"shear_rate": 1, "cross_shear": {"amplitude": 0.05, "frequency": 10}}, 0, ["stress", "oscillation"], CYCLES),
    ({"oscillation": {"amplitude": 0.3, "frequency": 1}}, 0.1, ["stress", "oscillation"], CYCLES),
    ({"extension_rate": 0.5}, 0, ["stress", "transient"], lasting(strain=2)),
    ({"uniaxial_rate": -0.5}, 0, ["stress", "transient"], lasting(strain=2)),
    ({"segments": [{"shear_rate": 1, "strain": 1}, {"shear_rate": -1}]}, 0, ["stress", "transient"], lasting(strain=4)),
    ({"segments": RAMP}, 0.1, ["stress", "transient"], lasting(time=2)),
    ({"stress": 5}, 0, ["stress", "contact_network"], lasting(stress_times=40)),
    ({"stress": 5}, 0.5, ["stress", "contact_network"], lasting(stress_times=5)),
]


class Campaign(CampaignFolder):
    """A campaign with eight seeds of each point."""

    def __init__(self, programs, folder, name, scene, observable, keys, values):
        document = {"name": name, "scene": scene, "sweep": [{"set": keys, "values": values}]}
        document |= {"target": {"observable": observable, "absolute_tolerance": 1e9}}
        document |= {"realisations": {"minimum": 8, "maximum": 8}}
        super().__init__(programs, folder, document)

    def run(self):
        return self.start("run", self.file, "--quiet", start_new_session=True)


def check(holds, *what):
    if not holds:
        raise SystemExit("flows_campaign.py: " + " ".join(map(str, what)))


def results_of(campaign):
    """Returns results by point and seed, without the fields that may change in a repetition."""
    found = {}
    for settings, results in read_results(campaign.data):
        for result in results:
            for member in ("cost", "engine"):
                result.pop(member, None)
            found[json.dumps(settings), result["seed"]] = result
    return found


def disturbed(campaign, generator):
    """Runs the campaign to its end through interruptions; returns their number."""
    for times in range(200):
        process = campaign.run()
        try:
            process.wait(timeout=generator.uniform(0.3, 0.3 + 0.05 * times))
            check(process.returncode == 0, "run ended with", process.returncode)
            return times
        except subprocess.TimeoutExpired:
            if generator.random() < 0.5:
                process.send_signal(signal.SIGTERM)
                process.wait(timeout=60)
            else:
                os.killpg(process.pid, signal.SIGKILL)
                process.wait()
                time.sleep(0.1)
    raise SystemExit("flows_campaign.py: does not come to an end")


def every_flow(programs, folder):
    keys = ["/flow", "/fluid/thermal_energy", "/observables", "/duration"]
    points = [list(point) for point in POINTS]
    calm, wild = (Campaign(programs, folder, name, SCENE, "pressure", keys, points) for name in ("calm", "wild"))
    check(calm.run().wait() == 0, "undisturbed, it fails", calm.log())
    times = disturbed(wild, random.Random(1))
    expected, found = results_of(calm), results_of(wild)
    check(len(expected) == 8 * len(POINTS), len(expected), "results")
    check(times > 3, "was disturbed", times, "times only")
    for key, result in expected.items():
        check(found[key] == result, "differs after interruptions:", key)
    check(wild.say("doctor", wild.file).returncode == 0, "is not sound")
    print(f"{len(POINTS)} flows, {len(expected)} results: the same bytes after {times} interruptions")


def share_that_flows(programs, folder):
    """Relative viscosities exceed 1 + 2.5 φ, so a jammed viscosity of 1.5 makes the first point jam."""
    flows = [{"stress": 5, "jammed_viscosity": 1.5}, {"stress": 5, "jammed_viscosity": 100}]
    scene = SCENE | {"duration": lasting(stress_times=2)}
    campaign = Campaign(programs, folder, "still", scene, "shear_rate", "/flow", flows)
    # Equal rates of 0 have no spread to judge by, so the point stays open at the maximum for any tolerance.
    ended = campaign.run().wait()
    check(ended == 3, "the run ended with", ended)
    still, flowing = json.loads(campaign.say("export", campaign.file).stdout)["points"]
    for point, share in ((still, 0), (flowing, 1)):
        check(len(point["realisations"]) == 8, "lost realisations of", point["settings"])
        for realisation in point["realisations"]:
            check(realisation["mean"]["flowing"] == share, "flows", realisation["mean"]["flowing"], point["settings"])
    check(all(r["ending"]["cause"] == "jammed" for r in still["realisations"]), "has not ended as jammed")
    shown = campaign.say("status", campaign.file)
    check(shown.returncode == 0 and b"jammed" in shown.stdout, "status says nothing of jams:", shown)
    causes = campaign.query("SELECT cause, count(*) FROM realisations GROUP BY cause ORDER BY cause")
    check(causes == [("completed", 8), ("jammed", 8)], "has the causes", causes)
    print("what stands still is counted: 8 of 16 flow")


def main():
    with tempfile.TemporaryDirectory() as folder:
        share_that_flows(sys.argv[1], folder)
        every_flow(sys.argv[1], folder)


main()
