#!/usr/bin/python3
"""flows_campaign.py PROGRAMS  flows that change, stretch or are driven by a stress, killed and resumed

A campaign has a point of each flow. Its runs are ended again and again, by SIGTERM, which leaves checkpoints, and by
SIGKILL of everything; at the end it must have the results of one that nobody disturbed, all but their cost. A point
whose stress lets it stand still must say what share flows, and aim at the rate of all.
"""
import json
import os
import random
import signal
import sqlite3
import subprocess
import sys
import tempfile
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "results"))
from studies.campaigns import read_results

SCENE = {
    "particles": {
        "count": 100,
        "density": 0.001,
        "species": [{"radius": 1, "number_share": 1}, {"radius": 1.4, "number_share": 1}],
    },
    "volume_fraction": 0.4,
    "fluid": {"viscosity": 1},
    "contact": {"normal_stiffness": 2e4, "friction": 0.5},
    "lubrication": {"form": "kim-karrila", "inner_gap": 0.001, "outer_gap": 0.05},
}


def lasting(**limit):
    ((name, amount),) = limit.items()
    return {"equilibration": {name: amount / 4}, "production": {name: amount}}


CYCLES = {"equilibration": {"cycles": 1}, "production": {"cycles": 4}}
# Flow, k_B T, observables and durations.
POINTS = [
    ({"shear_rate": 1, "cross_shear": {"amplitude": 0.05, "frequency": 10}}, 0, ["stress", "oscillation"], CYCLES),
    ({"oscillation": {"amplitude": 0.3, "frequency": 1}}, 0.1, ["stress", "oscillation"], CYCLES),
    ({"extension_rate": 0.5}, 0, ["stress", "transient"], lasting(strain=2)),
    ({"uniaxial_rate": -0.5}, 0, ["stress", "transient"], lasting(strain=2)),
    ({"segments": [{"shear_rate": 1, "strain": 1}, {"shear_rate": -1}]}, 0, ["stress", "transient"], lasting(strain=4)),
    (
        {"segments": [{"shear_rate": 0, "final_rate": 1, "time": 1}, {"shear_rate": 0}]},
        0.1,
        ["stress", "transient"],
        lasting(time=2),
    ),
    ({"stress": 5}, 0, ["stress", "contact_network"], lasting(stress_times=40)),
    ({"stress": 5}, 0.5, ["stress", "contact_network"], lasting(stress_times=5)),
]


def campaign(name):
    keys = ["/flow", "/fluid/thermal_energy", "/observables", "/duration"]
    return {
        "name": name,
        "scene": SCENE,
        "sweep": [{"set": keys, "values": [list(point) for point in POINTS]}],
        "target": {"observable": "pressure", "absolute_tolerance": 1e9},
        "realisations": {"minimum": 8, "maximum": 8},
    }


def standing_still(flow):
    """No suspension flows under a stress that would need less than 1 + 2.5 φ."""
    return {
        "name": "still",
        "scene": SCENE | {"duration": lasting(stress_times=2)},
        "sweep": [{"set": "/flow", "values": flow}],
        "target": {"observable": "shear_rate", "absolute_tolerance": 1e9},
        "realisations": {"minimum": 8, "maximum": 8},
    }


def check(holds, *what):
    if not holds:
        raise SystemExit("flows_campaign.py: " + " ".join(map(str, what)))


def written(folder, campaign_):
    path = os.path.join(folder, campaign_["name"] + ".json")
    with open(path, "w") as f:
        json.dump(campaign_, f)
    return path


def results_of(path):
    """By point and seed, without what a repetition may change."""
    found = {}
    for settings, results in read_results(path.removesuffix(".json") + ".peclet"):
        for result in results:
            for member in ("cost", "engine"):
                result.pop(member, None)
            found[json.dumps(settings), result["seed"]] = result
    return found


def disturbed(peclet, path, generator):
    """Runs it to the end through interruptions; returns how many there were."""
    for times in range(200):
        process = subprocess.Popen([peclet, "run", path, "--quiet"], stdout=subprocess.DEVNULL, start_new_session=True)
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


def every_flow(peclet, folder):
    calm, wild = written(folder, campaign("calm")), written(folder, campaign("wild"))
    subprocess.run([peclet, "run", calm, "--quiet"], check=True, stdout=subprocess.DEVNULL)
    times = disturbed(peclet, wild, random.Random(1))
    expected, found = results_of(calm), results_of(wild)
    check(len(expected) == 8 * len(POINTS), len(expected), "results")
    check(times > 3, "was disturbed", times, "times only")
    for key, result in expected.items():
        check(found[key] == result, "differs after interruptions:", key)
    subprocess.run([peclet, "doctor", wild], check=True, stdout=subprocess.DEVNULL)
    print(f"{len(POINTS)} flows, {len(expected)} results: the same bytes after {times} interruptions")


def share_that_flows(peclet, folder):
    flows = [{"stress": 5, "jammed_viscosity": 1.5}, {"stress": 5, "jammed_viscosity": 100}]
    path = written(folder, standing_still(flows))
    # Equal rates of 0 have no spread to judge by, whatever the tolerance: the point stays open at the maximum.
    ended = subprocess.run([peclet, "run", path, "--quiet"], stdout=subprocess.DEVNULL).returncode
    check(ended == 3, "the run ended with", ended)
    exported = json.loads(subprocess.run([peclet, "export", path], check=True, capture_output=True).stdout)
    still, flowing = exported["points"]
    for point, share in ((still, 0), (flowing, 1)):
        check(len(point["realisations"]) == 8, "lost realisations of", point["settings"])
        for realisation in point["realisations"]:
            check(realisation["mean"]["flowing"] == share, "flows", realisation["mean"]["flowing"], point["settings"])
    check(all(r["ending"]["cause"] == "jammed" for r in still["realisations"]), "has not ended as jammed")
    shown = subprocess.run([peclet, "status", path], check=True, capture_output=True, text=True).stdout
    check("jammed" in shown, "status says nothing of jams:", shown)
    database = sqlite3.connect(f"file:{path.removesuffix('.json')}.peclet/campaign.db?mode=ro", uri=True)
    causes = database.execute("SELECT cause, count(*) FROM realisations GROUP BY cause ORDER BY cause").fetchall()
    check(causes == [("completed", 8), ("jammed", 8)], "has the causes", causes)
    print("what stands still is counted: 8 of 16 flow")


def main():
    peclet = os.path.join(sys.argv[1], "peclet")
    with tempfile.TemporaryDirectory() as folder:
        share_that_flows(peclet, folder)
        every_flow(peclet, folder)


main()
