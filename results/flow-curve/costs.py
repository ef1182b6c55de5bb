#!/usr/bin/python3
"""costs.py PECLET FOLDER: writes curve.csv from the campaigns curves, curve-55 and check that were run in FOLDER.

Each row is a point of a curve: its own mean, its interval and the band of the curve; the seeds that counted, and those
that the point alone is expected to need for the same tolerance with its own spread; and the mean of other seeds: those
of `check`, and of the curve's campaigns, that did not count. Prints what the curves took, and how often bands hold the
mean of the other seeds.
"""
import csv
import json
import math
import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from studies.tables import write_rows
import numpy as np
from scipy.stats import t

CURVES, CHECK = ("curves", "curve-55"), "check"
TOLERANCE, MINIMUM, MAXIMUM = 0.05, 8, 800
LEVEL = 1 - 0.05 * (1 - 1.4 / MINIMUM)  # of the intervals: adjusted_confidence() of the stop rule


def asked(program, *words):
    return subprocess.run([program, *words], check=True, capture_output=True, text=True).stdout


def place_of(settings, fraction=0.55):
    """Returns volume fraction and Peclet number; the fraction is not swept in every campaign."""
    return float(settings.get("/volume_fraction", fraction)), float(settings["/peclet"])


def seeds_alone(mean, spread):
    """Returns the first stop test at which the interval of a point alone is expected to be within the tolerance."""
    seeds = MINIMUM
    while seeds < MAXIMUM and t.ppf((1 + LEVEL) / 2, seeds - 1) * spread > TOLERANCE * mean * seeds**0.5:
        seeds = (5 * seeds + 3) // 4
    return min(seeds, MAXIMUM)


def rows_of(program, folder):
    counted, others, seconds = {}, {}, {}
    for campaign in (*CURVES, CHECK):
        for line in asked(program, "results", str(folder / f"{campaign}.json")).splitlines():
            seed = json.loads(line)
            place, value = place_of(seed["settings"]), seed["result"]["mean"]["relative_viscosity"]
            if campaign == CHECK and seed["seed"] in counted.get(place, ()):
                continue
            is_other = campaign == CHECK or not seed["deciding"]
            (others if is_other else counted).setdefault(place, {})[seed["seed"]] = value
            if not is_other:
                seconds.setdefault(place, []).append(seed["result"]["cost"]["cpu_seconds"])
    for campaign in CURVES:
        for point in csv.DictReader(asked(program, "export", "--csv", str(folder / f"{campaign}.json")).splitlines()):
            place = place_of(point)
            values = np.array(list(counted[place].values()))
            other = np.array(list(others.get(place, {}).values()))
            number = {name: float(point[name] or "nan") for name in ("mean", "half_width")}
            band = {name: float(point[f"curve_{name}"] or "nan") for name in ("mean", "low", "high")}
            yield {
                "fraction": place[0],
                "peclet": place[1],
                "seeds": len(values),
                "seconds": float(np.mean(seconds[place])),
                "viscosity": number["mean"],
                "spread": float(values.std(ddof=1)),
                "half_width": number["half_width"],
                "curve": band["mean"],
                "low": band["low"],
                "high": band["high"],
                "verdict": point["verdict"],
                "seeds_alone": seeds_alone(number["mean"], values.std(ddof=1)),
                "other_seeds": len(other),
                "other": float(other.mean()) if len(other) > 1 else float("nan"),
                "other_error": float(other.std(ddof=1) / len(other) ** 0.5) if len(other) > 1 else float("nan"),
            }


def print_costs(rows):
    """Prints hours of processor time for each volume fraction; a point at rest is part of the curve only."""
    for fraction in sorted({row["fraction"] for row in rows}):
        for most, what in ((np.inf, "all points"), (0.05, "Pe up to 0.05")):
            own = [row for row in rows if row["fraction"] == fraction and row["peclet"] <= most]
            alone = sum(row["seconds"] * row["seeds_alone"] for row in own if row["peclet"] > 0) / 3600
            curve = sum(row["seconds"] * row["seeds"] for row in own) / 3600
            print(f"φ = {fraction}, {what}: {alone:.2f} h alone, {curve:.2f} h by the curve: {alone / curve:.2f} times")


def print_check(rows):
    """Prints how many bands and intervals hold the mean of other seeds, about ten times as many.

    Both are made wider by the error of the other seeds.
    """
    known = [row for row in rows if row["peclet"] > 0 and row["other_seeds"] >= 7 * row["seeds"]]
    for name, mean, half in (
        ("bands", "curve", lambda row: row["curve"] * math.log(row["high"] / row["low"]) / 2),
        ("intervals of points alone", "viscosity", lambda row: row["half_width"]),
    ):
        width = [math.hypot(half(row), 2.04 * row["other_error"]) for row in known]
        distance = [abs(row["other"] - row[mean]) / w for row, w in zip(known, width)]
        print(f"{sum(d <= 1 for d in distance)} of {len(known)} {name} hold the mean of the other seeds")


def main():
    rows = sorted(rows_of(sys.argv[1], Path(sys.argv[2])), key=lambda row: (row["fraction"], row["peclet"]))
    write_rows(HERE / "curve.csv", rows, 5)
    print_costs(rows)
    print_check(rows)


if __name__ == "__main__":
    if len(sys.argv) != 3:
        raise SystemExit(__doc__)
    main()
