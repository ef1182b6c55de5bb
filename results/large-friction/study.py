#!/usr/bin/python3
"""Friction of 1: divergence of the viscosity and number of contacts without noise, and flow with noise between the two
jamming volume fractions."""
import math
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from studies.driver import BLUE, Figure, Finding, JAMMED_AT_REST, RED, REFERENCE_SCENE, Statement, TABLE_SCENE
from studies.driver import difference, during, entries, estimate, first, in_brownian_times, in_strains
from studies.driver import jammed_and_exponent, main, mari_fit, merged, number, over, propagated, read_rows, row_ratio
from studies.driver import viscosity_row, where, write_table
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
# Volume fraction with noise, between 0.57, where fits for friction 1 diverge, and 0.587, where those at rest diverge.
DENSE, PECLET, LOWEST = 0.58, (1, 4.6, 10, 22, 100, 1e3, 1e4), 4.6
SLOW_PECLET = (0.02, 0.1)
SLOW = in_brownian_times(100, 100)
STIFF = 4  # factor of the stiffness
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
    rows += [{"stiffness": STIFF, **row} for row in noisy(program, "stiff", PECLET[-1:], NOISY_SEEDS, stiff)]
    rows = [{"stiffness": 1} | row for row in rows]
    names = (
        "peclet, friction, fraction, stiffness, seeds, lost, transient, viscosity±, pairs±, lubrication±, contact±, "
    )
    write_table(HERE / "table.csv", names + "contacts±, rattlers±", rows, 5)


def without_noise(table, friction):
    return [r for r in where(table, peclet="no noise", friction=friction) if r["seeds"] > 1]


def with_noise(table):
    return [r for r in where(table, stiffness=1) if r["peclet"] != "no noise"]


def jamming_of(table, low, high):
    """Returns φ_J and λ of μ = 1 from a range of volume fractions, with errors, and degrees of freedom."""
    rows = [r for r in without_noise(table, 1) if low <= r["fraction"] <= high]
    fractions, numbers = [r["fraction"] for r in rows], [number(r, "pairs") for r in rows]
    found = propagated(numbers, lambda values: jammed_and_exponent(fractions, values), 100)
    return *zip(*found), len(rows) - 2


def jamming_rows(table):
    (jammed, jammed_error), (exponent, exponent_error), degrees = jamming_of(table, FRACTIONS[1][0], FITTED)
    text = f"μ = 1, no noise: φ_J of η_r of pairs, φ = 0.4 to {FITTED:g}, less that at rest, 0.587 in print"
    yield Statement(text, "L 4.2.6", jammed - JAMMED_AT_REST, jammed_error, high=0, degrees=degrees)
    yield Finding("μ = 1, no noise: its λ", "L 4.2.6", exponent, exponent_error, degrees)
    for low in (0.4, 0.5):
        found, _, degrees = jamming_of(table, low, 0.56)
        yield Finding(f"μ = 1, no noise: φ_J of η_r of pairs, φ = {low:g} to 0.56", "L 4.2.6", *found, degrees)


def contact_rows(table):
    """Yields statements about contacts at the largest volume fraction at which all seeds flow."""
    last = {}
    for friction, published in PUBLISHED_CONTACTS.items():
        row = last[friction] = [r for r in without_noise(table, friction) if not r["lost"]][-1]
        name = f"μ = {friction}, no noise, φ = {row['fraction']:g}"
        text = f"{name}: contacts of a sphere that carries (published: about {published})"
        yield Statement(text, "L 4.2.7", *number(row, "contacts"), published - 1, published + 1, row["seeds"] - 1)
    text = "the first of these less the second (published: 2)"
    yield Statement(text, "L 4.2.7", *difference(*(number(last[m], "contacts") for m in (0, 1))), 0, degrees=SEEDS - 1)


def between_rows(table):
    rows = {r["peclet"]: r for r in with_noise(table)}
    middle = rows[LOWEST]
    text = f"φ = {DENSE:g}, μ = 1: seeds that end at Pe = {LOWEST:g} (finite), of {NOISY_SEEDS}"
    yield Statement(text, "L 4.2.6", middle["seeds"] / NOISY_SEEDS, 0, 1)
    for peclet in (*SLOW_PECLET, 22, 1e4):
        text = f"φ = {DENSE:g}, μ = 1: η_r of pairs at Pe = {peclet:g} over that at {LOWEST:g}"
        ratio = row_ratio(rows[peclet], middle, "pairs")
        yield Statement(text, "L 4.2.6", *ratio, 1, degrees=rows[peclet]["seeds"] - 1)
    stiff = first(table, stiffness=STIFF)
    text = f"φ = {DENSE:g}, μ = 1, Pe = 10⁴: η_r of pairs with four times k_n over that with k_n (jammed: above 1)"
    yield Finding(text, "L 4.2.6", *row_ratio(stiff, rows[1e4], "pairs"), stiff["seeds"] - 1)
    for peclet in (LOWEST, 22):
        text = f"φ = {DENSE:g}, μ = 1, Pe = {peclet:g}: contacts of a sphere that carries"
        yield Finding(text, "L 4.2.7", *number(rows[peclet], "contacts"), rows[peclet]["seeds"] - 1)


def judge():
    table = read_rows(HERE / "table.csv")
    return [*jamming_rows(table), *contact_rows(table), *between_rows(table)]


def draw():
    table = read_rows(HERE / "table.csv")
    figure = Figure(HERE / "chart.png", columns=3, size=(1400, 440))
    ends = {"x_range": (0.38, 0.64)}
    panel = figure.panel("φ", "η_r of pairs, no noise", log="y", key="bottom right", y_range=(2, 2e4), **ends)
    contacts = figure.panel("φ", "contacts of a sphere that carries", key="top left", y_range=(2, 7), **ends)
    for friction, colour in ((0, BLUE), (1, RED)):
        rows = without_noise(table, friction)
        panel.rows(rows, "fraction", "pairs", f"μ = {friction}", colour, 7, 0.9)
        contacts.rows(rows, "fraction", "contacts", f"μ = {friction}", colour, 7, 0.9)
        contacts.level(PUBLISHED_CONTACTS[friction], None, colour, (0.38, 0.64), dash=2)
    panel.curve(lambda f: mari_fit(f, 1), "Mari fit (published), μ = 1", RED, (0.38, 0.57), dash=2)
    ends = {"x_range": (0.01, 3e4), "y_range": (10, 3e5)}
    panel = figure.panel("Pe", "η_r of pairs, μ = 1", f"φ = {DENSE:g}", log="xy", powers="xy", **ends)
    panel.rows(with_noise(table), "peclet", "pairs", None, RED, 7, 0.9, joined=True)
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
