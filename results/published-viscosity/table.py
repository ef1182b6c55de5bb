#!/usr/bin/python3
"""peclet export campaign.json | table.py, also with outer-gap.json

Prints the relative viscosities of a campaign beside the fits of Mari et al. as quoted by Monti et al. (2021):
1.4 (1 - phi/0.66)^-1.6 without friction and 0.71 (1 - phi/0.575)^-2.3 with friction coefficient 1.
All seeds that have ended are included.
"""
import json
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from studies.estimates import estimate, over
from studies.published import mari_fit
from studies.tables import markdown_head, markdown_row, number_text

HEAD = ["φ", "μ", "outer gap", "seeds", "η_r", "of the pairs", "N₁/ηγ̇", "N₂/ηγ̇", "Mari fit", "η_r / fit"]
QUANTITIES = ("relative_viscosity", "relative_viscosity_pair", "first_normal_difference", "second_normal_difference")


def main():
    export = json.load(sys.stdin)
    scene = export["document"]["scene"]
    print(markdown_head(HEAD))
    for point in export["points"]:
        means = [r["mean"] for r in point["realisations"] + point["extra"] if r.get("mean")]
        settings = {**scene["contact"], **scene["lubrication"]}
        settings |= {path.split("/")[-1]: value for path, value in point["settings"].items()}
        phi, friction = settings["volume_fraction"], settings["friction"]
        found = [estimate([mean[name] for mean in means]) for name in QUANTITIES]
        reference = mari_fit(phi, friction)
        cells = [f"{phi:.2f}", friction, settings["outer_gap"], len(means), *(number_text(f, 2) for f in found)]
        print(markdown_row([*cells, f"{reference:.2f}", number_text(over(found[0], reference), 3)]))


if __name__ == "__main__":
    main()
