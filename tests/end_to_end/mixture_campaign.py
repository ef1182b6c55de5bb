#!/usr/bin/python3
"""mixture_campaign.py PROGRAMS      grains are added to colloids by a sweep over alpha alone, with the real engine

`validate` must show the published volume fractions 0.550, 0.576 ... 0.710 of radii 1:1.4:5:7 at alpha = 0 ... 0.5.
A campaign of larger colloids, which needs fewer of them, must end with a row for each alpha, the volume fractions of
its base, and alpha on the axis of its picture.
"""
import copy
import json
import os
import subprocess
import sys
import tempfile

ALPHA = [0, 0.1, 0.2, 0.3, 0.4, 0.5]
PUBLISHED = [0.550, 0.576, 0.604, 0.636, 0.671, 0.710]


def species(*radii):
    return [{"radius": radius, "volume_share": 0.5} for radius in radii]


CAMPAIGN = {
    "name": "grains",
    "scene": {
        "particles": {
            "count": 4000,
            "density": 0.01,
            "mixture": {"colloids": species(1, 1.4), "grains": species(5, 7), "alpha": 0},
        },
        "addition": {"added": "grains", "base_volume_fraction": 0.55},
        "fluid": {"viscosity": 0.1},
        "flow": {"shear_rate": 0.05},
        "contact": {"normal_stiffness": 1e3},
        "duration": {"equilibration": {"strain": 0}, "production": {"strain": 0.01}},
    },
    "sweep": [{"set": "/particles/mixture/alpha", "values": ALPHA}],
    "target": {"observable": "pressure", "absolute_tolerance": 1e9},
    "realisations": {"minimum": 8, "maximum": 8},
}


def check(holds, *what):
    if not holds:
        raise SystemExit("mixture_campaign.py: " + " ".join(map(str, what)))


def output_of(*command):
    found = subprocess.run(command, capture_output=True, text=True, check=False)
    check(found.returncode == 0, command, found.stdout, found.stderr)
    return found.stdout


def derived_agree(points, fractions, where):
    check(len(points) == len(ALPHA), where, "has", len(points), "points")
    for point, alpha, fraction in zip(points, ALPHA, fractions):
        derived = point["derived"]
        check(abs(derived["volume_fraction"] - fraction) < 5e-4, where, alpha, derived)
        check(abs(derived["alpha"] - alpha) < 0.01, where, alpha, derived)


def run_small(peclet, folder):
    """Radii 1:1.4:2:2.8, at volume fractions from 0.2 on."""
    campaign = copy.deepcopy(CAMPAIGN)
    campaign["scene"]["particles"]["count"] = 250
    campaign["scene"]["particles"]["mixture"]["grains"] = species(2, 2.8)
    campaign["scene"]["addition"]["base_volume_fraction"] = 0.2
    path = os.path.join(folder, "small.json")
    with open(path, "w", encoding="utf-8") as file:
        json.dump(campaign, file)
    output_of(peclet, "run", path, "--workers", "2")
    points = json.loads(output_of(peclet, "export", path, "--json"))["points"]
    # Of a part each of colloids and liquid 4: 1 / (1 + 4 (1 - alpha)).
    derived_agree(points, [1 / (5 - 4 * alpha) for alpha in ALPHA], "export")
    check([point["label"] for point in points] == [f"alpha={alpha:g}" for alpha in ALPHA], points)
    drawn = json.loads(output_of(peclet, "plot", "--json", path))
    symbols = {key["pointer"]: key["symbol"] for key in drawn["parameters"]}
    check(symbols[drawn["over"]] == "α", "the axis is not alpha")


def main():
    peclet = os.path.join(os.path.abspath(sys.argv[1]), "peclet")
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "grains.json")
        with open(path, "w", encoding="utf-8") as file:
            json.dump(CAMPAIGN, file)
        derived_agree(json.loads(output_of(peclet, "validate", path, "--json"))["points"], PUBLISHED, "validate")
        check("φ" in output_of(peclet, "validate", path), "validate has no column φ")
        run_small(peclet, folder)


main()
