#!/usr/bin/python3
"""peclet export campaign.json | table.py

What the control variate saves: variances over the realisations of a point of the relative viscosity eta, of eta + B
with B the viscosity of the pairs' Brownian stress (mean zero), and of eta - beta B with beta regressed on the other
half of the realisations. Its interval: 95 %, by resampling realisations 4000 times. Errors of means: standard errors.
"""
import json
import random
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from studies.estimates import estimate
from studies.tables import markdown_head, markdown_row, number_text

import numpy as np

XY, OTHERS = 3, (0, 1, 2, 4, 5)  # components of a stress
HEAD = (
    "Pe",
    "realisations",
    "η_r",
    "η_r + B",
    "B",
    "standard deviation of η_r",
    "variance of η_r + B over that of η_r",
    "with β cross-fitted",
    "β",
    "correlation of η_r + B with the structural stress",
    "largest one with xx, yy, zz, xz or yz of B",
    "s of processor each",
)


def ratio(eta, b):
    return (eta + b).var(ddof=1) / eta.var(ddof=1)


def slope(eta, b):
    return np.cov(eta, b)[0, 1] / b.var(ddof=1)


def cross_fitted(eta, b):
    from_odd, from_even = slope(eta[1::2], b[1::2]), slope(eta[::2], b[::2])
    values = np.concatenate((eta[::2] - from_odd * b[::2], eta[1::2] - from_even * b[1::2]))
    return values.var(ddof=1) / eta.var(ddof=1), (from_odd + from_even) / 2


def interval(eta, b):
    generator, places = random.Random(1), range(len(eta))
    chosen = np.array([[generator.choice(places) for _ in places] for _ in range(4000)])
    draws = np.sort((eta + b)[chosen].var(axis=1, ddof=1) / eta[chosen].var(axis=1, ddof=1))
    return draws[100], draws[3899]


def correlation(a, b):
    return np.corrcoef(a, b)[0, 1]


def main():
    export = json.load(sys.stdin)
    print(markdown_head(HEAD))
    for point in export["points"]:
        results = [r for r in point["realisations"] + point["surplus"] if r.get("mean")]
        eta = np.array([r["mean"]["relative_viscosity"] for r in results])
        brownian = np.array([r["mean"]["brownian_pairwise"] for r in results])
        structural = np.array([r["mean"]["brownian_structural"][XY] for r in results])
        b = brownian[:, XY]
        low, high = interval(eta, b)
        fitted, beta = cross_fitted(eta, b)
        cells = [
            point["settings"]["/peclet"],
            len(results),
            *(number_text(estimate(values), 3) for values in (eta, eta + b, b)),
            f"{eta.std(ddof=1):.2f}",
            f"**{ratio(eta, b):.3f}** ({low:.3f} .. {high:.3f})",
            f"{fitted:.3f}",
            f"{beta:.2f}",
            f"{correlation(eta + b, structural):.2f}",
            f"{max((correlation(eta + b, brownian[:, k]) for k in OTHERS), key=abs):.2f}",
            f"{np.median([r['cost']['cpu_seconds'] for r in results]):.2g}",
        ]
        print(markdown_row(cells))


main()
