#!/usr/bin/python3
"""windows.py FOLDER.peclet...

Variance of the relative viscosity plus the pairs' Brownian stress over that of the viscosity alone, for averages over
shorter parts of the production window, from the 32 blocks of each realisation in the database of a campaign. Intervals
are 95 % by resampling realisations.
"""
import random
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from studies.campaigns import read_results
from studies.tables import markdown_head, markdown_row

import numpy as np

BLOCKS, RESAMPLES = 32, 1000


def moments(rows):
    """By realisation: count, sum and sum of squares of its averages."""
    return np.stack((np.full(len(rows), rows.shape[1]), rows.sum(axis=1), np.square(rows).sum(axis=1)), axis=1)


def variance(moments):
    count, total, squares = moments.sum(axis=0)
    return (squares - total * total / count) / (count - 1)


def ratio(plain, controlled):
    """Of moments of realisations: variance of the controlled averages over that of the plain ones."""
    return variance(controlled) / variance(plain)


def window_of(result):
    """Brownian times and strain of the production window."""
    return result["time"]["production"] / result["derived"]["brownian_time"], result["strain"]["production"]


def main():
    print(markdown_head(["Pe", "average over", "averages", "variance of η_r + B over that of η_r"]))
    generator = random.Random(1)
    for folder in sys.argv[1:]:
        for settings, results in read_results(folder):
            blocks = [r["blocks"] for r in results]
            viscosity = np.array([b["relative_viscosity"] for b in blocks])
            controlled = viscosity + [b["control_variates"]["brownian_pairwise"] for b in blocks]
            times, strain = window_of(results[-1])
            seeds = range(len(results))
            for together in (1, 2, 4, 8, 16, 32):
                parts = (rows.reshape(len(seeds), -1, together).mean(axis=2) for rows in (viscosity, controlled))
                sums = [moments(part) for part in parts]
                draws = [generator.choices(seeds, k=len(seeds)) for _ in range(RESAMPLES)]
                resampled = np.sort([ratio(*(s[chosen] for s in sums)) for chosen in draws])
                low, high = resampled[int(0.025 * RESAMPLES)], resampled[int(0.975 * RESAMPLES)]
                part = together / BLOCKS
                cells = [
                    f"{settings['/peclet']:g}",
                    f"{times * part:.3g} Brownian times, strain {strain * part:.2g}",
                    len(seeds) * BLOCKS // together,
                    f"{ratio(*sums):.3f} ({low:.3f} .. {high:.3f})",
                ]
                print(markdown_row(cells))


main()
