#!/usr/bin/python3
"""costs.py: prints what the curves of curve.csv took, and what their points alone would have taken.

Each row of curve.csv is a point of a curve: its own mean with its interval, the band of the curve, the seeds that
counted and the processor time of one, and the seeds that the point alone is expected to need for the same tolerance
with its own spread. A point at rest has a Péclet number of 0.
"""
import csv
import json
import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from studies.tables import read_rows, write_rows
import numpy as np
from scipy.stats import t

CURVES = "curves", "curve-55"  # campaigns
TOLERANCE, MINIMUM, MAXIMUM = 0.05, 8, 800
LEVEL = 1 - 0.05 * (1 - 1.4 / MINIMUM)  # of the intervals: adjusted_confidence() of the stop rule


def asked(program, *words):
    return subprocess.run([program, *words], check=True, capture_output=True, text=True).stdout


def place_of(settings):
    return float(settings["/volume_fraction"]), float(settings["/peclet"])


def seeds_alone(mean, spread):
    """Returns the first stop test at which the interval of a point alone is expected to be within the tolerance."""
    seeds = MINIMUM
    while seeds < MAXIMUM and t.ppf((1 + LEVEL) / 2, seeds - 1) * spread > TOLERANCE * mean * seeds**0.5:
        seeds = (5 * seeds + 3) // 4
    return min(seeds, MAXIMUM)


def counted_seeds(program, path):
    """Returns the viscosities and the processor times of the seeds that counted, by volume fraction and Pe."""
    counted = {}
    for seed in map(json.loads, asked(program, "results", path).splitlines()):
        if seed["deciding"]:
            result = seed["result"]
            number = result["mean"]["relative_viscosity"], result["cost"]["cpu_seconds"]
            counted.setdefault(place_of(seed["settings"]), []).append(number)
    return {place: np.array(numbers).T for place, numbers in counted.items()}


def curve_rows(program, folder):
    for campaign in CURVES:
        path = str(folder / f"{campaign}.json")
        counted = counted_seeds(program, path)
        for point in csv.DictReader(asked(program, "export", "--csv", path).splitlines()):
            place = place_of(point)
            values, seconds = counted[place]
            mean, half, curve, low, high = (
                float(point[name] or "nan") for name in ("mean", "half_width", "curve_mean", "curve_low", "curve_high")
            )
            yield {
                "fraction": place[0],
                "peclet": place[1],
                "seeds": len(values),
                "seconds": float(seconds.mean()),
                "viscosity": mean,
                "spread": float(values.std(ddof=1)),
                "half_width": half,
                "curve": curve,
                "low": low,
                "high": high,
                "verdict": point["verdict"],
                "seeds_alone": seeds_alone(mean, values.std(ddof=1)),
            }


def write_curves(program, folder):
    """Writes curve.csv from the campaigns that were run in a folder."""
    rows = sorted(curve_rows(program, folder), key=lambda row: (row["fraction"], row["peclet"]))
    write_rows(HERE / "curve.csv", rows, 5)


def main():
    """Prints hours of processor time for each volume fraction; a point at rest is part of the curve only."""
    rows = read_rows(HERE / "curve.csv")
    for fraction in sorted({row["fraction"] for row in rows}):
        for most, what in ((np.inf, "all points"), (0.05, "Pe up to 0.05")):
            own = [row for row in rows if row["fraction"] == fraction and row["peclet"] <= most]
            alone = sum(row["seconds"] * row["seeds_alone"] for row in own if row["peclet"] > 0) / 3600
            curve = sum(row["seconds"] * row["seeds"] for row in own) / 3600
            print(f"φ = {fraction}, {what}: {alone:.2f} h alone, {curve:.2f} h by the curve: {alone / curve:.2f} times")


if __name__ == "__main__":
    main()
