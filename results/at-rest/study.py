#!/usr/bin/python3
"""The viscosity of frictionless suspensions at rest, by linear response.

study.py BIN [FOLDER] [--quick | --from-table]
"""
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from studies.at_rest import SLOWEST, slow_rows
from studies.command_line import main
from studies.estimates import difference, estimate, quotient
from studies.figure import BLUE, GREEN, RED, Figure
from studies.published import JAMMED_AT_REST, diverging
from studies.scenes import REFERENCE_SCENE, during, merged
from studies.tables import entries, number, read_rows, write_table
from studies.verdicts import Check, Finding

import numpy as np

TITLE = "Viscosity at rest by linear response"
TARGET = "zero_shear_viscosity"
VISCOSITY, THERMAL_ENERGY = 0.1, 0.017
BROWNIAN_TIME = VISCOSITY / THERMAL_ENERGY
SCENE = merged(
    REFERENCE_SCENE,
    {
        "particles": {"count": 100},
        "flow": {"shear_rate": 0},
        "fluid": {"thermal_energy": THERMAL_ENERGY},
        "observables": ["stress", "linear_response"],
    },
)
# Brownian times of the window, 80 times the viscosity or more, and seeds.
WINDOWS = {0.30: (400, 60), 0.45: (800, 60), 0.50: (1600, 32)}
LARGER = 250, 16  # particles and seeds, at MIDDLE
MIDDLE = 0.45
HALVED_SEEDS = 24
# The correlation is taken up to so many Brownian times for each unit of the viscosity.
TIMES_OF_CORRELATION = 2.5


def scene_at(fraction, patch=None):
    window = during({"brownian_times": 100}, {"brownian_times": WINDOWS[fraction][0]})
    return merged(merged(SCENE, {"volume_fraction": fraction, **window}), patch or {})


def means_of(program, name, scene, seeds):
    """Of every seed."""
    points = program.run(name, scene, [{"/volume_fraction": scene["volume_fraction"]}], seeds, TARGET)
    return [r["mean"] for r in points[0]["realisations"] if r.get("mean")]


def by_correlation(means):
    """Up to the first lag beyond TIMES_OF_CORRELATION times the viscosity."""
    viscosity = estimate([m["zero_shear_viscosity"] for m in means])[0]
    lag = np.array(means[0]["linear_response"]["lag"]) / BROWNIAN_TIME
    place = int(np.searchsorted(lag, TIMES_OF_CORRELATION * viscosity))
    return estimate([m["linear_response"]["correlation"][place] for m in means])


def rows_of(fraction, count, step, means):
    head = {"fraction": fraction, "count": count, "step": step, "seeds": len(means)}
    rise = entries("rise", estimate([m["zero_shear_rise"] for m in means]))
    yield {
        **head,
        "by": "momentum",
        **entries("viscosity", estimate([m["zero_shear_viscosity"] for m in means])),
        **rise,
    }
    yield {**head, "by": "correlation", **entries("viscosity", by_correlation(means))}


def curve_rows(fraction, means):
    """eta(t), and the moduli, with their standard errors over seeds."""
    for axis, name in (("time", "viscosity"), ("frequency", "storage"), ("frequency", "loss")):
        places = means[0]["linear_response"][axis]
        values = np.array([m["linear_response"][name] for m in means])
        scale = BROWNIAN_TIME if axis == "frequency" else 1 / BROWNIAN_TIME
        modulus = THERMAL_ENERGY if axis == "frequency" else 1  # in units of kT / a^3
        for k, place in enumerate(places):
            yield {
                "fraction": fraction,
                "curve": name,
                "at": place * scale,
                **entries("value", estimate(values[:, k] / modulus)),
            }


def measure(program):
    rows, curves = [], []
    for fraction, (_, seeds) in WINDOWS.items():
        means = means_of(program, f"rest-{fraction:g}", scene_at(fraction), seeds)
        rows += rows_of(fraction, 100, "automatic", means)
        curves += curve_rows(fraction, means)
    count, seeds = LARGER
    means = means_of(program, "larger", scene_at(MIDDLE, {"particles": {"count": count}}), seeds)
    rows += rows_of(MIDDLE, count, "automatic", means)
    half = 0.5 * program.derived(scene_at(MIDDLE), TARGET)["timestep"]
    patch = {"integrator": {"method": "implicit", "timestep": half}}
    means = means_of(program, "halved", scene_at(MIDDLE, patch), HALVED_SEEDS)
    rows += rows_of(MIDDLE, 100, "half of it", means)
    columns = ["fraction", "count", "step", "by", "seeds", "viscosity", "viscosity_error", "rise", "rise_error"]
    write_table(HERE / "table.csv", columns, rows, 5)
    write_table(HERE / "curves.csv", ["fraction", "curve", "at", "value", "value_error"], curves, 5)


def select(table, **wanted):
    return next(r for r in table if all(r[k] == v for k, v in wanted.items()))


def in_errors(a, b):
    """The difference over its standard error, which is 1."""
    value, error = difference(a, b)
    return value / error, 1.0


def judge():
    table = read_rows(HERE / "table.csv")
    usual = {"count": 100, "step": "automatic"}
    for fraction in WINDOWS:
        row = select(table, fraction=fraction, by="momentum", **usual)
        found = number(row, "viscosity")
        other = number(select(table, fraction=fraction, by="correlation", **usual), "viscosity")
        yield Finding(f"φ = {fraction:g}: η_r at rest", "linear response", *found, row["seeds"] - 1)
        text = f"φ = {fraction:g}: by correlation less by momentum, in standard errors"
        yield Check(text, "two forms", in_errors(other, found)[0], 0, -2, 2)
        text = f"φ = {fraction:g}: rise from half of the time on, over η_r"
        yield Check(text, "the window", *quotient(number(row, "rise"), found), -0.1, 0.1, row["seeds"] - 1)
    found = number(select(table, fraction=MIDDLE, by="momentum", **usual), "viscosity")
    others = {
        f"N = {LARGER[0]} less N = 100": {"count": LARGER[0], "step": "automatic"},
        "half the step less the automatic one": {"count": 100, "step": "half of it"},
    }
    for text, which in others.items():
        other = number(select(table, fraction=MIDDLE, by="momentum", **which), "viscosity")
        text = f"φ = {MIDDLE:g}: {text}, in standard errors"
        yield Check(text, "size and step", in_errors(other, found)[0], 0, -2, 2)


def draw():
    curves = read_rows(HERE / "curves.csv")
    table = read_rows(HERE / "table.csv")
    figure = Figure(HERE / "chart.png", columns=3)
    rise = figure.panel("t / τ_B", "η(t) / η", log="xy", key="top left")
    moduli = figure.panel("ω τ_B", "G′, G″ (dashed) a³/kT", log="xy", key="top left")
    divergence = figure.panel("φ", "η_r at rest", log="y", x_range=(0.25, 0.58), key="top left")
    for fraction, colour in zip(WINDOWS, (BLUE, GREEN, RED)):
        label = f"φ = {fraction:g}"

        def of(name):
            return [
                (r["at"], *number(r, "value"))
                for r in curves
                if r["fraction"] == fraction and r["curve"] == name and r["value"] > 0
            ]

        rise.points(of("viscosity")[::3], label, colour, size=0.5)
        moduli.points(of("storage"), label, colour, size=0.8)
        moduli.line([(x, y) for x, y, _ in of("loss")], None, colour, dash=2)
    rest = [
        (r["fraction"], *number(r, "viscosity"))
        for r in table
        if (r["by"], r["count"], r["step"]) == ("momentum", 100, "automatic")
    ]
    divergence.points(rest, "at rest", BLUE)
    sheared = [(f, *number(r, "viscosity")) for f, r in slow_rows().items()]
    divergence.points(sheared, f"Pe = {SLOWEST}", RED, size=0.8)
    divergence.curve(
        lambda f: diverging(f, JAMMED_AT_REST, 1.5), "published fit of the limit", GREEN, (0.26, 0.56), dash=2
    )
    figure.draw()


def quick_measure(program):
    scene = merged(SCENE, {"volume_fraction": 0.3, **during({"brownian_times": 10}, {"brownian_times": 60})})
    means = means_of(program, "quick", merged(scene, {"particles": {"count": 60}}), 12)
    momentum = estimate([m["zero_shear_viscosity"] for m in means])
    # Einstein's and Batchelor's 1 + 2.5 phi + 5.9 phi^2 below, slow shear (2.3) within 20 % above.
    return [Check("φ = 0.3: η_r at rest", "1 + 2.5 φ + 5.9 φ² (Batchelor 1977), ± 20 %", *momentum, 1.82, 2.9, 11)]


main(HERE, TITLE, measure, quick_measure, judge, draw)
