#!/usr/bin/python3
"""Friction of 1: divergence of the viscosity and number of contacts without noise, and flow with noise between the two
jamming volume fractions."""
import math
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from studies.driver import BLUE, Figure, Finding, FLOWING, JAMMED, RED, REFERENCE_SCENE, Statement, TABLE_SCENE
from studies.driver import difference, during, entries, estimate, fit_with_error, in_brownian_times, in_strains
from studies.driver import logarithm, main, mari_fit, merged, number, over, read_rows, row_ratio, viscosity_row, where
from studies.driver import write_table
import numpy as np

TITLE = "Large friction"
# Volume fractions without noise, by friction.
FRACTIONS = {0: (0.58, 0.60, 0.61, 0.62), 1: (0.40, 0.45, 0.50, 0.53, 0.54, 0.55, 0.56)}
FITTED = 0.55  # largest volume fraction of the fit for friction 1
SOFT = {"guard": {"largest_overlap": 0.3}}  # jammed spheres of this stiffness overlap by more than the default, 0.05
NETWORK = {"observables": ["stress", "contact_network"]}
STEADY = merged(REFERENCE_SCENE, NETWORK, SOFT, in_strains(2, 4), particles={"count": 250}, contact={"friction": 0})
SEEDS = 8
# Contacts that a sphere needs to carry a force: four without friction, two with friction.
CARRYING = {0: 4, 1: 2}
# Volume fraction with noise, below 0.587, where published fits at rest diverge.
DENSE, PECLET, LOWEST, FAST = 0.58, (1, 4.6, 10, 22, 100, 1e3, 1e4), 4.6, 1e4
SLOW_PECLET = (0.02, 0.1)
SLOW = in_brownian_times(300, 200)
STIFF = 4  # factor of the stiffness
JAMMED_VISCOSITY = 5e3  # realisations above it are counted as jammed
NOISY = merged(
    TABLE_SCENE,
    NETWORK,
    SOFT,
    during({"strain": 1, "brownian_times": 40}, {"strain": 2, "brownian_times": 40}),
    contact={"friction": 1},
)
NOISY_SEEDS = 6
PUBLISHED_CONTACTS = {0: 6, 1: 4}


def carried(mean, friction):
    """Returns the mean contacts of spheres that can carry a force, and the share of the other spheres."""
    shares = np.array(mean["contact_network"]["contacts"])
    count, least = np.arange(len(shares)), CARRYING[friction]
    carrying = shares[least:].sum()
    return float((count * shares)[least:].sum() / carrying), float(1 - carrying)


def rows_of(program, name, scene, pointer, values, seeds):
    friction = int(scene["contact"]["friction"])
    for value, point in zip(values, program.run(name, scene, [{pointer: v} for v in values], seeds)):
        row = {"friction": friction, pointer.split("_")[-1].strip("/"): value} | viscosity_row(point)
        row["jammed"] = sum(viscosity > JAMMED_VISCOSITY for viscosity in point.by_seed().values())
        found = np.array([carried(m, friction) for m in point.means])
        for k, quantity in enumerate(("contacts", "rattlers")):
            row |= entries(quantity, estimate(found[:, k]) if len(found) else (math.nan, math.nan))
        yield row


def steady(program, name, friction, fractions, seeds, patch=None):
    scene = merged(STEADY, {"contact": {"friction": friction}}, patch or {})
    rows = rows_of(program, name, scene, "/volume_fraction", fractions, seeds)
    return [{"peclet": "no noise", **row} for row in rows]


def noisy(program, name, peclets, seeds, patch=None):
    scene = merged(NOISY, {"volume_fraction": DENSE}, patch or {})
    return [{"fraction": DENSE, **row} for row in rows_of(program, name, scene, "/peclet", peclets, seeds)]


def measure(program):
    rows = []
    for friction, fractions in FRACTIONS.items():
        rows += steady(program, f"steady-{friction}", friction, fractions, SEEDS)
    rows += noisy(program, "slow", SLOW_PECLET, NOISY_SEEDS, SLOW)
    rows += noisy(program, "noisy", PECLET, NOISY_SEEDS)
    stiff = {"contact": {"normal_stiffness": STIFF * NOISY["contact"]["normal_stiffness"]}}
    rows += [{"stiffness": STIFF, **row} for row in noisy(program, "stiff", (LOWEST, FAST), NOISY_SEEDS, stiff)]
    rows = [{"stiffness": 1} | row for row in rows]
    names = "peclet, friction, fraction, stiffness, seeds, lost, jammed, transient, viscosity±, pairs±, lubrication±, "
    write_table(HERE / "table.csv", names + "contact±, contacts±, rattlers±", rows, 5)


def without_noise(table, friction):
    return [r for r in where(table, peclet="no noise", friction=friction) if r["seeds"] > 1]


def with_noise(table, stiffness=1):
    return [r for r in where(table, stiffness=stiffness) if r["peclet"] != "no noise"]


def jamming_rows(table):
    """Yields findings about the fit without noise; what it gives goes with the volume fractions that it includes."""
    for low, high in ((FRACTIONS[1][0], FITTED), (FRACTIONS[1][0], 0.56), (0.5, 0.56)):
        rows = [r for r in without_noise(table, 1) if low <= r["fraction"] <= high]
        for symbol, (found, error, _, _) in zip(("φ_J", "λ"), fit_with_error(rows, "pairs")):
            text = f"μ = 1, no noise: {symbol} of η_r of pairs, φ = {low:g} to {high:g}"
            yield Finding(text, "L 4.2.6", found, error, len(rows) - 2)


def contact_rows(table):
    """Yields statements about contacts at the largest volume fraction of which no realisation is lost."""
    last = {}
    for friction, published in PUBLISHED_CONTACTS.items():
        row = last[friction] = [r for r in without_noise(table, friction) if not r["lost"]][-1]
        name = f"μ = {friction}, no noise, φ = {row['fraction']:g}"
        text = f"{name}: contacts of a sphere that carries (published: about {published})"
        yield Statement(text, "L 4.2.7", *number(row, "contacts"), published - 1, published + 1, row["seeds"] - 1)
    text = "no noise: these contacts without friction less those with it (published: 2)"
    yield Finding(text, "L 4.2.7", *difference(*(number(last[m], "contacts") for m in (0, 1))), SEEDS - 1)


def between_rows(table):
    rows, stiff = ({r["peclet"]: r for r in with_noise(table, factor)} for factor in (1, STIFF))
    name = f"φ = {DENSE:g}, μ = 1"
    for peclet, words, bounds in ((LOWEST, "flows", {"high": FLOWING}), (FAST, "jams", {"low": JAMMED})):
        slope = over(logarithm(row_ratio(stiff[peclet], rows[peclet], "pairs")), math.log(STIFF))
        text = f"{name}, Pe = {peclet:g}: d ln η_r/d ln k_n of the pairs ({words})"
        yield Statement(text, "L 4.2.6", *slope, degrees=NOISY_SEEDS - 1, **bounds)
    text = f"{name}: η_r of pairs at Pe = 22 over that at {LOWEST:g}"
    yield Statement(text, "L 4.2.6", *row_ratio(rows[22], rows[LOWEST], "pairs"), 1, degrees=NOISY_SEEDS - 1)
    for peclet in SLOW_PECLET:
        text = f"{name}: η_r of pairs at Pe = {peclet:g} over that at {LOWEST:g}"
        yield Finding(text, "L 4.2.6", *row_ratio(rows[peclet], rows[LOWEST], "pairs"), NOISY_SEEDS - 1)
    for peclet in (LOWEST, 22):
        text = f"{name}, Pe = {peclet:g}: contacts of a sphere that carries"
        yield Finding(text, "L 4.2.7", *number(rows[peclet], "contacts"), NOISY_SEEDS - 1)


def judge():
    table = read_rows(HERE / "table.csv")
    return [*jamming_rows(table), *contact_rows(table), *between_rows(table)]


def draw():
    table = read_rows(HERE / "table.csv")
    figure = Figure(HERE / "chart.png", columns=3, size=(1400, 440))
    ends = {"x_range": (0.38, 0.64)}
    panel = figure.panel("φ", "η_r, no noise", log="y", key="bottom right", y_range=(2, 2e4), **ends)
    contacts = figure.panel("φ", "contacts of a sphere that carries", key="top left", y_range=(2, 7), **ends)
    for friction, colour in ((0, BLUE), (1, RED)):
        rows = without_noise(table, friction)
        panel.rows(rows, "fraction", "viscosity", f"μ = {friction}", colour, 7, 0.9)
        contacts.rows(rows, "fraction", "contacts", f"μ = {friction}", colour, 7, 0.9)
        contacts.level(PUBLISHED_CONTACTS[friction], None, colour, (0.38, 0.64), dash=2)
    panel.curve(lambda f: mari_fit(f, 1), "Mari fit (published), μ = 1", RED, (0.38, 0.57), dash=2)
    ends = {"x_range": (0.01, 3e4), "y_range": (10, 3e5)}
    panel = figure.panel("Pe", "η_r of pairs, μ = 1", f"φ = {DENSE:g}", log="xy", powers="xy", key="top left", **ends)
    for factor, title, mark in ((1, "k_n", 7), (STIFF, f"{STIFF} k_n", 4)):
        panel.rows(with_noise(table, factor), "peclet", "pairs", title, RED, mark, 0.9, joined=factor == 1)
    figure.draw()


def quick_measure(program):
    small = {"particles": {"count": 100}}
    smooth, rough = (steady(program, f"quick-{m}", m, (f,), 6, small)[0] for m, f in ((0, 0.60), (1, 0.53)))
    text = "μ = 0, φ = 0.60: contacts of a sphere that carries"
    yield Statement(text, "L 4.2.7", *number(smooth, "contacts"), 4, 7, 5)
    yield Statement("μ = 1, φ = 0.53: the same", "L 4.2.7", *number(rough, "contacts"), 2, 5, 5)
    ratio = over(number(rough, "pairs"), mari_fit(0.53, 1))
    yield Statement("μ = 1, φ = 0.53: η_r of pairs over the published fit of η_r", "L 4.2.6", *ratio, 0.3, 1.5, 5)


main(HERE, TITLE, measure, quick_measure, judge, draw)
