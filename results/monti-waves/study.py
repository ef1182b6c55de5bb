#!/usr/bin/python3
"""Shear with and without a wave of the rate, for large and small spheres with friction, repulsion and attraction (Monti
et al. 2021, Table 3 and Fig. 10)."""
import math
import os
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from studies.driver import BLACK, BLUE, Check, Figure, Finding, GREEN, ORANGE, RED, Statement, column
from studies.driver import entries, estimate, first, groups, in_strains, main, merged, number, read_final, read_numbers
from studies.driver import read_rows, relative_difference, row_ratio, where, write_numbers, write_table
from studies.monti import DRAG, PROGRAM_RATIO, SCENE, TABLE_RATIO, contact, electrochemistry, lubrication, spheres
import numpy as np

TITLE = "A wave in the shear of Monti et al."
FRACTION, SHARE, LARGE = 0.5, 0.2, 3.0  # V2/V1 = 0.25
COUNT, SMALL_COUNT, SMALLEST_COUNT = 65536, 8192, 2048
AMPLITUDE = 20  # of the wave at N = 65536
STRAIN, LARGE_STRAIN = 6, 3  # of the window, which begins at the start; of N = 65536
BLOCKS, QUARTERS, PARTS = 32, 4, 6  # blocks and quarters of the window; parts of its last three quarters
PROFILES = "fraction", "velocity", "small", "large"  # as from profiles_of()
# Force F_R + F_A of small spheres in contact, and F_R/F_A, at rate = rate_0.
FORCES = {"table": (1.0, TABLE_RATIO), "program": (DRAG, PROGRAM_RATIO)}
# Runs: number of spheres, forces, with a wave, with the Faxen terms of its curvature; and seeds.
WAVES = (False, True), (True, True)
RUNS = {(SMALL_COUNT, "table", *wave): 6 for wave in (*WAVES, (True, False))}
RUNS |= {(SMALLEST_COUNT, forces, *wave): 8 for forces in FORCES for wave in WAVES}
LARGE_RUNS = {(COUNT, "table", False, True): 1, (COUNT, "table", True, True): 1}  # with --long
SCENE = merged(
    SCENE,
    spheres(SMALL_COUNT, FRACTION, LARGE, SHARE),
    contact=contact(4e5, 1),
    lubrication=lubrication(0.25),
    observables=["profiles"],
    files={"final_configuration": True},
)


def strain_of(count):
    return LARGE_STRAIN if count == COUNT else STRAIN


def edge(count):
    """Returns the edge of the cell with N spheres; their mean volume is 4 pi / 3 over the sum of shares / a^3."""
    volume = count * 4 * math.pi / 3 / (1 - SHARE + SHARE / LARGE**3)
    return (volume / FRACTION) ** (1 / 3)


def amplitude(count):
    """Returns the amplitude of a wave that changes the rate as much as theirs, by 20 k = 1.429 of it, k = 2 pi / L."""
    return AMPLITUDE * edge(count) / edge(COUNT)


def patch_of(count, forces, wave, faxen=True):
    """Returns the patch of a run; bins are two radii high."""
    flow = {"shear_rate": 1.0}
    if wave:
        flow |= {"waves": [{"periods": 1, "sine": amplitude(count)}], "faxen": faxen}
    patch = {"particles": {"count": count}, "flow": flow, "profiles": {"bins": round(edge(count) / 2)}}
    return {**in_strains(0, strain_of(count)), **patch, **electrochemistry(*FORCES[forces], 0.02)}


def results_of(program, name, patch, seeds):
    """Returns the whole results of one point, by seed, and the paths of their final configurations."""
    if seeds == 1:
        result = program.run_alone(name, merged(SCENE, patch), threads=1)
        return [result], [os.path.join(program.folder, f"{name}.final.xyz")]
    (point,) = program.run(name, merged(SCENE, patch), [{"/volume_fraction": FRACTION}], seeds)
    return program.stored_results(name)[0], program.final_configurations(name, point)


def later_mean(result):
    """Returns the mean of eta_r over the last three quarters of the window, and its error from means over six parts."""
    series = np.array(result["blocks"]["relative_viscosity"])[BLOCKS // QUARTERS :]
    return estimate(series.reshape(PARTS, -1).mean(axis=1))


def mean_of(results):
    """Returns the mean of eta_r and its error, over seeds, or within the run for a single seed."""
    if len(results) == 1:
        return later_mean(results[0])
    return estimate([later_mean(r)[0] for r in results])


def slowed(heights):
    """Returns True where the wave lowers the rate; heights are y / L."""
    return np.cos(2 * math.pi * heights) < 0


def profiles_of(result):
    """Returns the profiles over the second half of the window: volume fraction, velocity relative to the uniform shear,
    and volume fractions of small and of large spheres."""

    def late(part):
        return np.array(part)[QUARTERS // 2 :].mean(axis=0)

    parts = result["blocks"]["profiles"]
    volume, flux = (late(p) for p in (parts["volume_fraction"], parts["velocity"]["flux"]))
    return np.array([volume, flux / volume, *late(parts["volume_fraction_by_radius"])])


def middles(values):
    """Returns the heights y / L of equal bins."""
    return (np.arange(len(values)) + 0.5) / len(values)


def followed(result, count):
    """Returns the amplitude of the wave in the spheres' velocity over that of the fluid."""
    velocity = profiles_of(result)[1]
    return 2 * np.mean(velocity * np.sin(2 * math.pi * middles(velocity))) / amplitude(count)


def gathered(volume):
    """Returns the volume fraction in the half of the cell where the wave lowers the rate, minus that of the other half,
    over the mean."""
    slow = slowed(middles(volume))
    return (volume[slow].mean() - volume[~slow].mean()) / volume.mean()


def shares_where_slow(path):
    """Returns the shares of the small and of the large spheres of a final configuration in the half of the cell where
    the wave lowers the rate."""
    edges, places, radius = read_final(path)
    slow = slowed(places[1] / edges[1])
    return [slow[chosen].mean() for chosen in (radius < 2, radius > 2)]


def row_of(run, results, paths):
    count, forces, wave, faxen = run
    row = {"count": count, "forces": forces, "wave": int(wave), "faxen": int(wave and faxen), "seeds": len(results)}
    row |= entries("viscosity", mean_of(results))
    if wave:
        row |= entries("followed", estimate([followed(r, count) for r in results]))
    of_all, of_small, of_large = (np.array([gathered(profiles_of(r)[k]) for r in results]) for k in (0, 2, 3))
    row |= entries("gathered", estimate(of_all)) | entries("gathered_small", estimate(of_small))
    row |= entries("gathered_large", estimate(of_large)) | entries("segregated", estimate(of_large - of_small))
    small, large = zip(*(shares_where_slow(path) for path in paths))
    row |= entries("small_slow", estimate(small)) | entries("large_slow", estimate(large))
    row["soft"] = sum(r["largest_overlap"] > 0.01 for r in results)
    row["processor_seconds"] = np.mean([r["cost"]["cpu_seconds"] for r in results]) / strain_of(count)
    return row


def step_change(program, seeds):
    """Returns the relative change of eta_r with half of the automatic step, because results do not have the error of
    the step in a wave. Over a strain of 1 runs with the same seed stay correlated."""
    patch = merged(patch_of(1000, "program", True), in_strains(0, 1))
    half = {"integrator": program.part_of_step(0.5, merged(SCENE, patch))}
    whole, halved = (
        {r["seed"]: r["mean"]["relative_viscosity"] for r in results_of(program, name, merged(patch, step), seeds)[0]}
        for name, step in (("step-auto", {}), ("step-half", half))
    )
    return relative_difference(halved, whole, paired=True)


def judge():
    table = read_rows(HERE / "table.csv")
    for row in where(table, wave=1, faxen=1):
        without = first(table, count=row["count"], forces=row["forces"], wave=0)
        degrees = min(r["seeds"] if r["seeds"] > 1 else PARTS for r in (row, without)) - 1
        label = f"N = {round(row['count'])}, forces of the {row['forces']}"
        ratio = row_ratio(row, without, "viscosity")
        text = f"{label}: η_r with the wave over that without"
        if row["seeds"] == 1:
            yield Finding(text, "M fig 10", *ratio, degrees)
        else:
            # Print does not give the sign; here it lowers the viscosity, and "modifies" is by a tenth at least.
            yield Statement(f"{text} (it modifies the viscosity)", "M fig 10", *ratio, high=0.9, degrees=degrees)
            text = f"{label}: volume fraction where the wave lowers the rate less that elsewhere, over the mean"
            yield Finding(text, "M fig 10", *number(row, "gathered"), row["seeds"] - 1)
            text = f"{label}: the same of the large spheres less that of the small ones"
            yield Finding(text, "M fig 10", *number(row, "segregated"), row["seeds"] - 1)
    series, _ = read_series()
    for count in (SMALL_COUNT, SMALLEST_COUNT):
        strains = np.array(strains_of((count,)))
        early = (strains > LARGE_STRAIN / QUARTERS) & (strains < LARGE_STRAIN)
        waved, still = (series[count, "table", wave, True][early].mean() for wave in (True, False))
        text = f"N = {count}, strains 0.75 to 3 as for N = {COUNT}: η_r with the wave over that without"
        yield Finding(text, "M fig 10", float(waved / still), 0)
    numbers = read_numbers(HERE / "numbers.csv")
    text = f"N = {SMALL_COUNT}, wave: relative change of η_r by the terms of the curvature"
    yield Finding(text, "M eq 9", *numbers["faxen"])
    *found, degrees = numbers["step"]
    text = "N = 1000, wave, to a strain of 1: relative change of η_r with half of the automatic step"
    yield Check(text, "step", *found, -0.03, 0.03, degrees)


def name_of(run):
    count, forces, wave, faxen = run
    return f"{'YW' if wave else 'NW'}-{count}-{forces}{'' if faxen else '-no-faxen'}"


def measure(program):
    rows, by_seed, series, profiles = {}, {}, {}, {}
    for run, seeds in (RUNS | (LARGE_RUNS if program.long else {})).items():
        results, paths = results_of(program, name_of(run), patch_of(*run), seeds)
        rows[run] = row_of(run, results, paths)
        by_seed[run] = {r["seed"]: later_mean(r)[0] for r in results}
        series[run] = np.mean([r["blocks"]["relative_viscosity"] for r in results], axis=0)
        profiles[run] = np.mean([profiles_of(r) for r in results], axis=0)
    write_tables(rows, series, profiles)
    # Relative change of eta_r by the Faxen terms.
    faxen = relative_difference(*(by_seed[SMALL_COUNT, "table", True, faxen] for faxen in (True, False)), paired=True)
    write_numbers(HERE / "numbers.csv", {"faxen": faxen, "step": step_change(program, 12)})


def strains_of(run):
    """Returns the strains in the middle of the blocks."""
    return ((np.arange(BLOCKS) + 0.5) * strain_of(run[0]) / BLOCKS).tolist()


def write_tables(rows, series, profiles):
    names = "count, forces, wave, faxen, seeds, soft, viscosity±, followed±, gathered±, gathered_small±, "
    names += "gathered_large±, segregated±, small_slow±, large_slow±, processor_seconds"
    write_table(HERE / "table.csv", names, rows.values(), 4)
    names, lines = ("run", "strain", "viscosity"), []
    for run, values in series.items():
        lines += [dict(zip(names, (name_of(run), *of))) for of in zip(strains_of(run), values.tolist())]
    write_table(HERE / "series.csv", names, lines, 5)
    names, lines = ("run", "height", *PROFILES), []
    for run, columns in profiles.items():
        heights = middles(columns[0]).tolist()
        lines += [dict(zip(names, (name_of(run), *of))) for of in zip(heights, *columns.tolist())]
    write_table(HERE / "profiles.csv", names, lines, 5)


def read_series():
    """Returns the viscosities of blocks, and the profiles as from profiles_of(), both by run."""
    names = {name_of(run): run for run in RUNS | LARGE_RUNS}
    series, profiles = (groups(read_rows(HERE / f"{name}.csv"), "run") for name in ("series", "profiles"))
    return {names[name]: column(rows, "viscosity") for name, rows in series.items()}, {
        names[name]: np.array([column(rows, of) for of in PROFILES]) for name, rows in profiles.items()
    }


def colour_of(run):
    count, forces = run[:2]
    return ORANGE if forces == "program" else {COUNT: RED, SMALL_COUNT: BLUE, SMALLEST_COUNT: GREEN}[count]


def draw():
    series, profiles = read_series()
    figure = Figure(HERE / "chart.png", columns=2, rows=2, size=(1200, 1000))
    shown = [run for run in series if run[3]]

    def line(panel, run, x, y):
        title = f"N = {run[0]}, {run[1]}, {'with' if run[2] else 'no'} wave"
        panel.line(zip(x, y), title, colour_of(run), dash=1 if run[2] else 2, width=2)

    ends = {"x_range": (0, STRAIN), "y_range": (0, None)}
    panel = figure.panel("strain", "η_r", "φ = 0.5, μ = 1", key="bottom right", **ends)
    for run in shown:
        line(panel, run, strains_of(run), series[run])
    panel = figure.panel("y / L", "local rate / mean rate", key="top center", x_range=(0, 1), y_range=(-1, 4))
    published = AMPLITUDE * 2 * math.pi / edge(COUNT)
    panel.curve(lambda y: 1 + published * math.cos(2 * math.pi * y), "of the fluid (published)", BLACK)
    waved = [run for run in shown if run[2]]
    for run in waved:
        velocity = profiles[run][1]
        bins = len(velocity)
        rates = 1 + (np.roll(velocity, -1) - velocity) * bins / edge(run[0])  # between the bins
        title = f"of the spheres, N = {run[0]}, {run[1]}"
        panel.line(zip(np.arange(1, bins + 1) / bins, rates), title, colour_of(run), width=2)
    panel = figure.panel("y / L", "volume fraction", key="bottom right", x_range=(0, 1), y_range=(0.34, 0.6))
    for run in [r for r in shown if r[0] == SMALL_COUNT and not r[2]] + waved:
        line(panel, run, middles(profiles[run][0]), profiles[run][0])
    panel = figure.panel(
        "y / L", "volume fraction of a size / its mean", "with wave", x_range=(0, 1), y_range=(0.6, 1.7)
    )
    for run in [r for r in waved if r[0] > SMALLEST_COUNT]:
        for values, size, dash in ((profiles[run][2], "small", 2), (profiles[run][3], "large", 1)):
            if np.isfinite(values).all():
                title, points = f"{size}, N = {run[0]}, {run[1]}", zip(middles(values), values / values.mean())
                panel.line(points, title, colour_of(run), dash=dash, width=2)
    figure.draw()


def quick_measure(program):
    results, paths = results_of(program, "quick", patch_of(500, "program", True), 6)
    row = row_of((500, "program", True, True), results, paths)
    text = "N = 500: the wave of the spheres' velocity over that of the fluid"
    yield Check(text, "expected", *number(row, "followed"), 0.3, 0.9, 5)
    text = "N = 500: volume fraction where the wave lowers the rate less that elsewhere, over the mean"
    yield Check(text, "expected", *number(row, "gathered"), 0, 0.4, 5)


main(HERE, TITLE, measure, quick_measure, judge, draw)
