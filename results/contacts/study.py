#!/usr/bin/python3
"""Contacts in weak and in strong flow: their lifetimes and clusters."""
import os
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from studies.driver import BLUE, Figure, Finding, GREEN, RED, Statement, TABLE_SCENE, at_peclet, contacts_per_sphere
from studies.driver import during, entries, estimate, first, frames_of, largest_cluster, lifetime, main, merged, number
from studies.driver import read_rows, row_ratio, where, write_rows
import numpy as np

TITLE = "Contacts in weak and in strong flow"
WEAK, STRONG = 0.01, 1e4
PECLETS = (WEAK, 0.1, 1, 10, 100, 1000, STRONG)
SEEDS = 8
STEPS = 400  # of the window, each with a frame
FINER, FINER_PECLETS = 0.25, (1, 100, STRONG)  # share of the automatic step, and where it is tried
FRACTION = 0.5
SCENE = merged(
    TABLE_SCENE, volume_fraction=FRACTION, observables=["stress", "trajectory"], trajectory={"contacts": True}
)
BEFORE = {"strain": 2, "brownian_times": 60}  # whichever comes first
# Bound for "short-lived": a fraction of the strain 1 that separates two spheres, and of the Brownian time.
SHORT = 0.1


def of_seed(program, name, scene, seed):
    """Runs one seed and returns the lifetime of contacts [steps], contacts per sphere, share of the largest cluster,
    mean and largest overlap, and the result."""
    result = program.run_alone(name, scene, 1, seed)
    frames, overlaps = zip(*frames_of(os.path.join(program.folder, f"{name}.trajectory.gsd")))
    count = scene["particles"]["count"]
    contacts = np.mean([contacts_per_sphere(pairs, count) for pairs in frames])
    largest = np.mean([largest_cluster(pairs, count) for pairs in frames])
    overlaps = np.concatenate(overlaps)
    return lifetime(frames), contacts, largest, overlaps.mean(), overlaps.max(), result


def row_at(program, peclet, seeds, patch, share=1):
    """Returns the row of a Péclet number, with this share of the automatic step."""
    bare = merged(SCENE, at_peclet(peclet), during(BEFORE, {"strain": 1}), observables=None, trajectory=None)
    step = share * program.derived(bare)["timestep"]
    window = {**during(BEFORE, {"time": STEPS * step}), "trajectory": {"interval": {"time": step}}}
    integrator = {"integrator": {"timestep": step if share < 1 else "auto"}}
    scene = merged(SCENE, at_peclet(peclet), window, integrator, patch)
    found = [of_seed(program, f"pe-{peclet:g}-{share:g}-{seed}", scene, seed) for seed in range(seeds)]
    steps, *others, results = zip(*found)
    # Shear time and Brownian time of the scene, from the groups of a result.
    shear, brownian = (results[0]["derived"][f"{name}_time"] for name in ("shear", "brownian"))
    row = {"peclet": peclet, "step": share, "seeds": seeds} | entries("steps", estimate(steps))
    row |= entries("strain", estimate([s * step / shear for s in steps]))
    row |= entries("brownian_times", estimate([s * step / brownian for s in steps]))
    for name, values in zip(("contacts", "largest", "overlap", "deepest"), others):
        row |= entries(name, estimate(values))
    return row


def measure(program):
    rows = [row_at(program, peclet, SEEDS, {}) for peclet in PECLETS]
    rows += [row_at(program, peclet, SEEDS, {}, FINER) for peclet in FINER_PECLETS]
    write_rows(HERE / "table.csv", rows, 5)


def rows_judged(table, degrees):
    weak, strong = (first(table, peclet=peclet) for peclet in (WEAK, STRONG))
    lasts = f"Pe = {WEAK:g}: Brownian times ηa³/k_BT that a contact lasts (published: short-lived)"
    yield Statement(lasts, "L 4.2.5", *number(weak, "brownian_times"), 0, SHORT, degrees)
    for name, text in (("contacts", "contacts of a sphere"), ("largest", "spheres in the largest cluster of contacts")):
        text = f"{text} at Pe = {STRONG:g} over that at {WEAK:g} (published: chains)"
        yield Statement(text, "L 4.2.5", *row_ratio(strong, weak, name), 1, degrees=degrees)
    row = max(table, key=lambda r: r["overlap"])
    text = f"mean overlap of contacts over the radius where it is largest (Pe = {row['peclet']:g})"
    yield Statement(f"{text}: orders of magnitude less", "L 3.8", *number(row, "overlap"), 0, 0.01, degrees)


QUANTITIES = {
    "strain": "strain that a contact lasts",
    "brownian_times": "Brownian times ηa³/k_BT that a contact lasts",
    "contacts": "contacts of a sphere",
    "largest": "share of the spheres in the largest cluster of contacts, mean over time",
    "deepest": "largest overlap over the radius, mean over seeds",
}


def judge():
    every = read_rows(HERE / "table.csv")
    table = where(every, step=1)
    yield from rows_judged(table, SEEDS - 1)
    for row in table:
        for name, words in QUANTITIES.items():
            yield Finding(f"Pe = {row['peclet']:g}: {words}", "contacts", *number(row, name), SEEDS - 1)
    for row in where(every, step=FINER):
        for name in ("strain", "contacts"):
            text = f"Pe = {row['peclet']:g}: {QUANTITIES[name]}, with a quarter of the automatic step over that with it"
            yield Finding(text, "step", *row_ratio(row, first(table, peclet=row["peclet"]), name), SEEDS - 1)


def draw():
    table = where(read_rows(HERE / "table.csv"), step=1)
    figure = Figure(HERE / "chart.png", columns=2, size=(1100, 450))
    x = {"log": "xy", "powers": "x", "x_range": (0.005, 2e4), "key": "top left"}
    panel = figure.panel("Pe", "time that a contact lasts", **x)
    for name, text, colour in (("strain", "in strains", RED), ("brownian_times", "in ηa³/k_{B}T", BLUE)):
        panel.rows(table, "peclet", name, text, colour, joined=True)
    panel = figure.panel("Pe", "contacts of a sphere; share in the largest cluster", **x)
    for name, text, colour in (("contacts", "contacts", RED), ("largest", "largest cluster", GREEN)):
        panel.rows(table, "peclet", name, text, colour, joined=True)
    figure.draw()


def quick_measure(program):
    patch = {"particles": {"count": 100}, "duration": {"equilibration": {"strain": 1, "brownian_times": 5}}}
    table = [row_at(program, peclet, 3, patch) for peclet in (WEAK, STRONG)]
    return rows_judged(table, 2)


main(HERE, TITLE, measure, quick_measure, judge, draw)
