#!/usr/bin/python3
"""mixture_campaign.py PROGRAMS

Tests a sweep over alpha alone, which adds grains to colloids, with the real engine. `validate` must show the
published volume fractions 0.550, 0.576 ... 0.710 of radii 1:1.4:5:7 at alpha = 0 ... 0.5. A campaign of
larger colloids, with fewer of them, must end with a row for each alpha, the volume fractions of its base, and
alpha on the axis of its picture.
"""
import copy
import json
import os
import sys
import tempfile

from campaign_folder import CampaignFolder

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


def output_of(campaign, verb, *words):
    found = campaign.say(verb, *words, campaign.file, text=True)
    check(found.returncode == 0, verb, found.stdout, found.stderr)
    return found.stdout


def derived_agree(points, fractions, where):
    check(len(points) == len(ALPHA), where, "has", len(points), "points")
    for point, alpha, fraction in zip(points, ALPHA, fractions):
        derived = point["derived"]
        check(abs(derived["volume_fraction"] - fraction) < 5e-4, where, alpha, derived)
        check(abs(derived["alpha"] - alpha) < 0.01, where, alpha, derived)


def run_small(programs, folder):
    """Runs radii 1:1.4:2:2.8 at volume fractions from 0.2 on."""
    document = copy.deepcopy(CAMPAIGN)
    document["scene"]["particles"]["count"] = 250
    document["scene"]["particles"]["mixture"]["grains"] = species(2, 2.8)
    document["scene"]["addition"]["base_volume_fraction"] = 0.2
    campaign = CampaignFolder(programs, folder, document)
    output_of(campaign, "run", "--workers=2")
    points = json.loads(output_of(campaign, "export", "--json"))["points"]
    # One part of colloids to 4 of liquid: 1 / (1 + 4 (1 - alpha)).
    derived_agree(points, [1 / (5 - 4 * alpha) for alpha in ALPHA], "export")
    check([point["label"] for point in points] == [f"alpha={alpha:g}" for alpha in ALPHA], points)
    drawn = json.loads(output_of(campaign, "plot", "--json"))
    symbols = {key["pointer"]: key["symbol"] for key in drawn["parameters"]}
    check(symbols[drawn["over"]] == "α", "the axis is not alpha")


def main():
    with tempfile.TemporaryDirectory() as folder:
        campaign = CampaignFolder(sys.argv[1], os.path.join(folder, "whole"), CAMPAIGN)
        derived_agree(json.loads(output_of(campaign, "validate", "--json"))["points"], PUBLISHED, "validate")
        check("φ" in output_of(campaign, "validate"), "validate has no column φ")
        run_small(sys.argv[1], os.path.join(folder, "small"))


main()
