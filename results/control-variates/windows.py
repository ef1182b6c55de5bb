#!/usr/bin/python3
"""windows.py FOLDER.peclet...

Variance of the relative viscosity plus the pairs' Brownian stress over that of the viscosity alone, for averages over shorter parts of
the production window, from the 32 blocks of each realisation in the database of a campaign. Intervals are 95 % by
resampling realisations.
"""
import json
import os
import random
import sqlite3
import sys

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
from campaigns import inflated  # noqa: E402

RESAMPLES = 1000


def moments(rows):
    """Count, sum and sum of squares of a list."""
    return len(rows), sum(rows), sum(x * x for x in rows)


def ratio(realisations):
    """Of sums over realisations: variance of the controlled averages over that of the plain ones."""
    totals = [[sum(r[k][m] for r in realisations) for m in range(3)] for k in (0, 1)]
    plain, controlled = ((squares - total * total / count) / (count - 1) for count, total, squares in totals)
    return controlled / plain


def main():
    print("| Pe | average over | averages | variance of η_r + B over that of η_r |\n|---|---|---|---|")
    generator = random.Random(1)
    for folder in sys.argv[1:]:
        database = sqlite3.connect(f"file:{os.path.join(folder, 'campaign.db')}?mode=ro", uri=True)
        for place, settings in database.execute("SELECT place, settings FROM points").fetchall():
            series, window = [], None
            for stored, dictionary in database.execute(
                "SELECT result, dictionary FROM realisations WHERE place = ? AND state = 'done' ORDER BY seed", (place,)
            ):
                result = json.loads(inflated(stored, dictionary))
                blocks = result["blocks"]
                series.append((blocks["relative_viscosity"], blocks["control_variates"]["brownian_pairwise"]))
                window = (
                    result["time"]["production"] / result["derived"]["brownian_time"],
                    result["strain"]["production"],
                )
            for together in (1, 2, 4, 8, 16, 32):
                per_seed = []
                for viscosity, brownian in series:
                    averages = [
                        (sum(viscosity[k : k + together]) / together, sum(brownian[k : k + together]) / together)
                        for k in range(0, len(viscosity), together)
                    ]
                    per_seed.append((moments([eta for eta, _ in averages]), moments([eta + b for eta, b in averages])))
                resampled = sorted(ratio(generator.choices(per_seed, k=len(per_seed))) for _ in range(RESAMPLES))
                low, high = resampled[int(0.025 * RESAMPLES)], resampled[int(0.975 * RESAMPLES)]
                part = together / 32
                print(
                    f"| {json.loads(settings)['/peclet']:g} | {window[0] * part:.3g} Brownian times, strain {window[1] * part:.2g} | "
                    f"{len(per_seed) * 32 // together} | {ratio(per_seed):.3f} ({low:.3f} .. {high:.3f}) |"
                )


main()
