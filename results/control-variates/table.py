#!/usr/bin/python3
"""peclet export campaign.json | table.py

What the control variate saves: variances over the realisations of a point of the relative viscosity eta, of eta + B with B the
viscosity of the pairs' Brownian stress (mean zero), and of eta - beta B with beta regressed on the other half of the realisations.
Its interval: 95 %, by resampling realisations 4000 times. Errors of means: standard errors.
"""
import json
import math
import random
import statistics
import sys


def ratio(pairs):
    plain = statistics.variance([eta for eta, _ in pairs])
    fixed = statistics.variance([eta + b for eta, b in pairs])
    return fixed / plain


def slope(pairs):
    mean_eta, mean_b = statistics.fmean(p[0] for p in pairs), statistics.fmean(p[1] for p in pairs)
    return sum((eta - mean_eta) * (b - mean_b) for eta, b in pairs) / sum((b - mean_b) ** 2 for _, b in pairs)


def cross_fitted(pairs):
    even, odd = pairs[::2], pairs[1::2]
    from_odd, from_even = slope(odd), slope(even)
    values = [eta - from_odd * b for eta, b in even] + [eta - from_even * b for eta, b in odd]
    return statistics.variance(values) / statistics.variance([eta for eta, _ in pairs]), (from_odd + from_even) / 2


def interval(pairs):
    generator = random.Random(1)
    draws = sorted(ratio([generator.choice(pairs) for _ in pairs]) for _ in range(4000))
    return draws[100], draws[3899]


def correlation(a, b):
    mean_a, mean_b = statistics.fmean(a), statistics.fmean(b)
    return sum((x - mean_a) * (y - mean_b) for x, y in zip(a, b)) / math.sqrt(
        sum((x - mean_a) ** 2 for x in a) * sum((y - mean_b) ** 2 for y in b)
    )


def mean_text(values):
    return f"{statistics.fmean(values):.3f} ± {statistics.stdev(values) / math.sqrt(len(values)):.3f}"


def main():
    export = json.load(sys.stdin)
    print(
        "| Pe | realisations | η_r | η_r + B | B | standard deviation of η_r | variance of η_r + B over that of η_r | with β cross-fitted | β | "
        "correlation of η_r + B with the structural stress | largest one with xx, yy, zz, xz or yz of B | s of processor each |"
    )
    print("|---|---|---|---|---|---|---|---|---|---|---|---|")
    for point in export["points"]:
        results = [r for r in point["realisations"] + point["surplus"] if r.get("mean")]
        pairs = [(r["mean"]["relative_viscosity"], r["mean"]["brownian_pairwise"][3]) for r in results]
        low, high = interval(pairs)
        fitted, beta = cross_fitted(pairs)
        controlled = [eta + b for eta, b in pairs]
        structural = correlation(controlled, [r["mean"]["brownian_structural"][3] for r in results])
        others = max(
            (correlation(controlled, [r["mean"]["brownian_pairwise"][k] for r in results]) for k in (0, 1, 2, 4, 5)),
            key=abs,
        )
        cost = statistics.median(r["cost"]["cpu_seconds"] for r in results)
        print(
            f"| {point['settings']['/peclet']} | {len(pairs)} | {mean_text([p[0] for p in pairs])} | {mean_text([p[0] + p[1] for p in pairs])} | "
            f"{mean_text([p[1] for p in pairs])} | {statistics.stdev([p[0] for p in pairs]):.2f} | **{ratio(pairs):.3f}** ({low:.3f} .. {high:.3f}) | "
            f"{fitted:.3f} | {beta:.2f} | {structural:.2f} | {others:.2f} | {cost:.2g} |"
        )


main()
