#!/usr/bin/python3
"""Reduction of the variance by the stress B of the random forces: as part of the stress, a control variate of the rest
with the coefficient -1, and by regression of the rest on its components."""
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from studies.driver import BLUE, Check, Figure, Finding, GREEN, RED, REFERENCE_SCENE, at_peclet, cross_fitted, during
from studies.driver import entries, estimate, in_brownian_times, jackknife, main, merged, number, read_rows
from studies.driver import variance_ratio, write_rows
import numpy as np

TITLE = "What control variates save"
PECLETS = (0.01, 1, 10, 100, 0.1)
SEEDS = 400
SCENE = merged(
    REFERENCE_SCENE,
    during({"strain": 1, "brownian_times": 20}, {"strain": 2, "brownian_times": 40}),
    particles={"count": 60},
)
BLOCKS = 32  # of a window
XY = 3
# Components of B that are controls; None: B_xy with the coefficient -1, which gives the stress that acts.
FIXED, ONE, ALL = "B_xy, coefficient -1", "B_xy, fitted", "six components of B, fitted"
CONTROLS = {FIXED: None, ONE: (XY,), ALL: range(6)}
COLOURS = dict(zip(CONTROLS, (BLUE, GREEN, RED)))


def controlled(viscosity, stress, components):
    """Returns the viscosities minus controls. `stress` is B over viscosity * rate; a coefficient of -1 adds B."""
    if components is None:
        return viscosity + stress[:, XY]
    return cross_fitted(viscosity, stress[:, list(components)])


def correlation(a, b):
    return jackknife(lambda chosen: np.corrcoef(a[chosen], b[chosen])[0, 1], len(a))


def rows_of(peclet, means):
    stress = np.array([m["stress"]["brownian_lubrication"] for m in means])
    viscosity = np.array([m["relative_viscosity"] for m in means]) - stress[:, XY]
    structural = np.array([m["brownian_structural"][XY] for m in means])
    for name, components in CONTROLS.items():
        found = controlled(viscosity, stress, components)
        row = {"peclet": peclet, "controls": name, "seeds": len(means)}
        row |= entries("ratio", variance_ratio(viscosity, found))
        row |= entries("viscosity", estimate(viscosity)) | entries("controlled", estimate(found))
        row |= entries("change", estimate(found - viscosity))
        row |= entries("structural", correlation(found, structural))
        yield row


def window_rows(peclet, results):
    """Yields rows of variance ratios for averages over parts of the window, with the coefficient -1."""
    found = np.array([r["blocks"]["relative_viscosity"] for r in results])
    viscosity = found - [r["blocks"]["shear_stress"]["brownian_lubrication"] for r in results]
    whole = results[0]["time"]["production"] / results[0]["derived"]["brownian_time"]
    for together in (1, 2, 4, 8, 16, 32):
        averages = (rows.reshape(len(rows), -1, together).mean(axis=2) for rows in (viscosity, found))
        row = {"peclet": peclet, "brownian_times": whole * together / BLOCKS, "seeds": len(results)}
        yield row | entries("ratio", variance_ratio(*averages))


def results_at(program, peclet, seeds, scene=SCENE):
    name = f"pe-{peclet:g}"
    program.run(name, merged(scene, at_peclet(peclet)), [{"/volume_fraction": 0.5}], seeds)
    (results,) = program.stored_results(name)
    return [r for r in results if r.get("mean")]


def measure(program):
    table, windows = [], []
    for peclet in PECLETS:
        results = results_at(program, peclet, SEEDS)
        table += rows_of(peclet, [r["mean"] for r in results])
        windows += window_rows(peclet, results)
    write_rows(HERE / "table.csv", table, 5)
    write_rows(HERE / "windows.csv", windows, 4)


def change_of(row, most=3):
    value, error = number(row, "change")
    text = f"Pe = {row['peclet']:g}, {row['controls']}: change of the mean, in standard errors of it"
    return Check(text, "no bias", value / error, 0, -most, most)


def judge():
    table = read_rows(HERE / "table.csv")
    for row in table:
        yield change_of(row)
    for row in table:
        text = f"Pe = {row['peclet']:g}, {row['controls']}: variance over that without controls"
        yield Finding(text, "saving", *number(row, "ratio"), row["seeds"] - 1)


def draw():
    table, windows = (read_rows(HERE / f"{name}.csv") for name in ("table", "windows"))
    figure = Figure(HERE / "chart.png", columns=2, size=(1100, 450))
    axes = {"y_range": (0, 1.2)}
    ends = {"x_range": (0.005, 200), "key": "bottom right", **axes}
    panel = figure.panel("Pe", "variance of η_r over that without B", log="x", powers="x", **ends)
    for k, (name, colour) in enumerate(COLOURS.items()):
        rows = [(r["peclet"] * 1.12 ** (k - 1), *number(r, "ratio")) for r in table if r["controls"] == name]
        panel.points(sorted(rows), name, colour, joined=True)
    panel = figure.panel("average over, τ_B", "variance of η_r over that without B", log="x", key="top left", **axes)
    for peclet, colour in ((0.01, BLUE), (0.1, GREEN), (1, RED)):
        rows = [(r["brownian_times"], *number(r, "ratio")) for r in windows if r["peclet"] == peclet]
        panel.points(rows, f"Pe = {peclet:g}", colour, joined=True)
    figure.draw()


def quick_measure(program):
    scene = merged(SCENE, in_brownian_times(2, 4), particles={"count": 30})
    for row in rows_of(1, [r["mean"] for r in results_at(program, 1, 200, scene)]):
        yield change_of(row, 6)
        # In windows of four Brownian times most of the scatter is white noise of B.
        text = f"Pe = 1, {row['controls']}: variance over that without controls"
        yield Check(text, "saving", *number(row, "ratio"), 0, 0.8, row["seeds"] - 1)


main(HERE, TITLE, measure, quick_measure, judge, draw)
