#!/usr/bin/python3
"""table.py RUNS.jsonl ...

Prints the effect of each step on the stress: means over windows of the relative difference from the reference step,
with standard errors, and the answers of the gate about these windows; and how far off single windows are, by what the
gate says of them.
"""
import collections
import json
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from studies.estimates import estimate
from studies.tables import markdown_head, markdown_row

REFERENCE = 5e-5
LARGEST_OF_SCENE = 3.138e-4  # stable for the scene's stiffest pair; larger steps are refused before a run
TOLERANCE = 0.3  # guard.energy_imbalance
HEAD = (
    "μ",
    "φ",
    "Δt / 10⁻⁴",
    "windows",
    "η_r",
    "η_r differs by, %",
    "lubrication differs by, %",
    "share",
    "energy imbalance",
    "gate, apart from the scene's bound",
)
SOFT = 0.01  # overlap beyond which a result has the warning "overlap"


def window(row):
    return row["volume_fraction"], row["friction"], row["seed"], row["window"]


def viscosity(row):
    return 1 + 2.5 * row["volume_fraction"] + row["lubrication"] + row["contact"]


def lubrication(row):
    return row["lubrication"]


def difference(pairs, quantity):
    values = [100 * (quantity(row) / quantity(reference) - 1) for row, reference in pairs]
    mean, error = estimate(values)
    return f"{mean:+.2f}" if len(values) < 2 else f"{mean:+.2f} ± {error:.2f}"


def verdicts(rows):
    count = collections.Counter()
    for row in rows:
        if row["ending"] != "completed":
            count[row["ending"]] += 1
        elif row["stability_share"] >= 1:
            count["timestep"] += 1
        elif row["energy_imbalance"] > TOLERANCE:
            count["flagged timestep"] += 1
        elif row["largest_overlap"] > SOFT:
            count["flagged overlap"] += 1
        else:
            count["passed"] += 1
    return ", ".join(f"{number} {name}" for name, number in sorted(count.items()))


def measured(pairs):
    """Returns the cells for pairs of windows and their references."""
    if not pairs:
        return [""] * 5
    imbalance = [row["energy_imbalance"] for row, _ in pairs]
    return [
        f"{sum(viscosity(reference) for _, reference in pairs) / len(pairs):.2f}",
        difference(pairs, viscosity),
        difference(pairs, lubrication),
        f"{max(row['stability_share'] for row, _ in pairs):.3f}",
        f"{min(imbalance):.1e} … {max(imbalance):.1e}",
    ]


def print_windows(pairs):
    """Prints the number of windows, of those that pass and of those that one of two checks notices, and how far off
    they are at most."""
    passed = [pair for pair in pairs if verdicts([pair[0]]) == "1 passed"]
    crossed = [pair for pair in pairs if pair[0]["stability_share"] >= 1]
    calm = [pair for pair in crossed if pair[0]["energy_imbalance"] <= TOLERANCE]
    noticed = [pair for pair in pairs if verdicts([pair[0]]) == "1 flagged timestep"]
    for text, some in (
        ("pass, and the scene accepts their step", [p for p in passed if p[0]["timestep"] < LARGEST_OF_SCENE]),
        ("pass, but for the scene's bound", [p for p in passed if p[0]["timestep"] >= LARGEST_OF_SCENE]),
        ("fail by the share alone", calm),
        ("fail by the imbalance alone", noticed),
    ):
        most = [max(100 * abs(quantity(a) / quantity(b) - 1) for a, b in some) for quantity in (viscosity, lubrication)]
        print(f"{len(some)} windows {text}: η_r off by {most[0]:.2f} % at most, lubrication by {most[1]:.2f} %")


def main():
    rows = [json.loads(line) for name in sys.argv[1:] for line in open(name)]
    references = {window(row): row for row in rows if row["timestep"] == REFERENCE}
    points = collections.defaultdict(list)
    for row in rows:
        if row["window"] >= 0 and row["timestep"] != REFERENCE:
            points[row["friction"], row["volume_fraction"], row["timestep"]].append(row)
        elif row["window"] < 0:
            point = f"μ = {row['friction']}, φ = {row['volume_fraction']}, seed {row['seed']}"
            print(f"{point}: equilibration ended, {row['ending']}")
    completed = [row for group in points.values() for row in group if row["ending"] == "completed"]
    print_windows([(row, references[window(row)]) for row in completed])
    print(markdown_head(HEAD))
    for (friction, phi, step), group in sorted(points.items()):
        pairs = [(row, references[window(row)]) for row in group if row["ending"] == "completed"]
        mark = "" if step < LARGEST_OF_SCENE else "*"
        head = [f"{friction:g}", f"{phi:.2f}", f"{1e4 * step:g}{mark}", len(group)]
        print(markdown_row([*head, *measured(pairs), verdicts(group)]))


if __name__ == "__main__":
    main()
