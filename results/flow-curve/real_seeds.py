#!/usr/bin/python3
"""real_seeds.py PECLET FOLDER: how often intervals and bands of real seeds hold the mean of ten times as many.

Divides the 88 seeds of the campaign check, run in FOLDER, into eleven blocks of eight. Each block gives a curve of
seven points for each volume fraction; the other seeds give its truth. Prints how often intervals of points and bands
hold it, with the same block at every point, and with another block at each; then the correlations between neighbours.
They differ if the scene has "seeds_in_common": true.
"""
import json
import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
REFERENCE = HERE.parents[1] / "tests" / "reference"
sys.path[:0] = [str(HERE.parent), str(REFERENCE)]
from studies.estimates import estimate
from costs import LEVEL, MINIMUM as BLOCK
import numpy as np
from scipy.stats import norm, t

if not REFERENCE.is_dir():
    sys.exit(f"{sys.argv[0]}: needs {REFERENCE}/curve.py, which is part of the source only")
import curve

SEEDS = 88


def values_of(program, folder):
    """Returns the viscosities by volume fraction and Péclet number, in the order of the seeds."""
    said = subprocess.run([program, "results", str(folder / "check.json")], check=True, capture_output=True, text=True)
    values = {}
    for seed in map(json.loads, said.stdout.splitlines()):
        place = seed["settings"]["/volume_fraction"], seed["settings"]["/peclet"]
        values.setdefault(place, {})[seed["seed"]] = seed["result"]["mean"]["relative_viscosity"]
    return {place: np.array([by_seed[k] for k in range(SEEDS)]) for place, by_seed in values.items()}


def held(peclets, own, others):
    """Returns, for the points of a curve, whether intervals and band hold the means of the other seeds."""
    (mean, error), (truth, its_error) = (np.array([estimate(v) for v in of]).T for of in (own, others))
    place, noise = np.log(peclets), (error / mean) ** 2 * (BLOCK - 1) / (BLOCK - 3)
    grid, weights = curve.models(place, np.log(mean), noise)
    found = [curve.posterior(place, np.log(mean), noise, place, model) for model in grid]
    band, deviation = curve.mixed(weights, np.array([m for m, _ in found]), np.array([np.diag(c) for _, c in found]))
    normal, student = norm.ppf((1 + LEVEL) / 2), t.ppf((1 + LEVEL) / 2, BLOCK - 1)
    return (
        np.abs(truth - mean) <= np.hypot(student * error, normal * its_error),
        np.abs(np.log(truth) - band) <= normal * np.hypot(deviation, its_error / truth),
    )


def main():
    values = values_of(sys.argv[1], Path(sys.argv[2]))
    fractions, peclets = (sorted({place[k] for place in values}) for k in (0, 1))
    blocks = SEEDS // BLOCK
    for apart in (0, 3):
        intervals, bands = [], []
        for fraction in fractions:
            for block in range(blocks):
                of = [np.array_split(values[fraction, p], blocks) for p in peclets]
                chosen = [(block + apart * k) % blocks for k in range(len(peclets))]
                own = [parts[one] for parts, one in zip(of, chosen)]
                others = [np.concatenate(parts[:one] + parts[one + 1 :]) for parts, one in zip(of, chosen)]
                interval, band = held(peclets, own, others)
                intervals.extend(interval)
                bands.extend(band)
        print(f"{'other' if apart else 'the same'} seeds at each point: of {len(bands)}", end=" ")
        print(f"intervals {100 * np.mean(intervals):.1f} %, bands {100 * np.mean(bands):.1f} % hold the mean")
    for fraction in fractions:
        pairs = [np.corrcoef(values[fraction, a], values[fraction, b])[0, 1] for a, b in zip(peclets, peclets[1:])]
        print(f"φ = {fraction}: correlation with the next:", ", ".join(f"{pair:.2f}" for pair in pairs))


if __name__ == "__main__":
    if len(sys.argv) != 3:
        raise SystemExit(__doc__)
    main()
