#!/usr/bin/python3
"""peclet export campaign.json | table.py, and the same with outer-gap.json

Prints the relative viscosities of the campaign beside the fits of Mari et al. as quoted by Monti et al. (2021):
1.4 (1 - phi/0.66)^-1.6 without friction and 0.71 (1 - phi/0.575)^-2.3 with friction coefficient 1.
Every seed that has ended counts, surplus ones too.
"""
import json
import math
import sys


def fit(phi, friction):
    return 0.71 * (1 - phi / 0.575) ** -2.3 if friction else 1.4 * (1 - phi / 0.66) ** -1.6


def main():
    export = json.load(sys.stdin)
    print("| φ | μ | outer gap | seeds | η_r | of the pairs | N₁/ηγ̇ | N₂/ηγ̇ | Mari fit | η_r / fit |")
    print("|---|---|---|---|---|---|---|---|---|---|")
    for point in export["points"]:
        means = [r["mean"] for r in point["realisations"] + point["surplus"] if r.get("mean")]
        scene = export["document"]["scene"]
        settings = {**scene["contact"], **scene["lubrication"]}
        settings |= {path.split("/")[-1]: value for path, value in point["settings"].items()}
        phi, friction = settings["volume_fraction"], settings["friction"]

        def estimate(name):
            values = [mean[name] for mean in means]
            mean = sum(values) / len(values)
            spread = math.sqrt(sum((v - mean) ** 2 for v in values) / (len(values) - 1) / len(values))
            return mean, spread

        def text(name, digits=2):
            mean, error = estimate(name)
            return f"{mean:.{digits}f} ± {error:.{digits}f}"

        mean, error = estimate("relative_viscosity")
        reference = fit(phi, friction)
        print(
            f"| {phi:.2f} | {friction} | {settings['outer_gap']} | {len(means)} | {text('relative_viscosity')} | {text('relative_viscosity_pair')} | "
            f"{text('first_normal_difference')} | {text('second_normal_difference')} | {reference:.2f} | "
            f"{mean / reference:.3f} ± {error / reference:.3f} |"
        )


if __name__ == "__main__":
    main()
