#!/usr/bin/python3
"""Cost of a step and its effect on viscosity and pressure: relative difference from the reference over the processor
time to a standard error of 2 %. lammps.csv has points of LAMMPS."""
import math
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from studies.driver import BLUE, Check, Figure, GREEN, RED, REFERENCE_SCENE, counts_text, entries, estimate, flags
from studies.driver import in_strains, main, markdown_head, markdown_row, merged, number, number_text, read_texts
from studies.driver import relative_difference, student_quantile, where, write_table
from studies.speed_accuracy import COLUMNS, PANELS
import numpy as np

TITLE = "Speed and accuracy of steps"
OVERVIEW = ["reference", "friction 1, phi 0.45", "Pe 1"]
QUICK_PANELS = ("reference", "Pe 100")
QUICK = {"particles": {"count": 100}, **in_strains(0.5, 1.5)}
QUICK_SEEDS = 8
SUMMARY = (
    "case",
    "η_r",
    "automatic step against the reference, %",
    "s per strain, implicit",
    "explicit",
    "times as much",
    "s to a standard error of 2 %",
)
NORMAL_TOLERANCE = "default"


def median(values):
    return float(np.median(values)) if values else math.nan


def variants(case, automatic, largest):
    """Yields the variants of a case, the finest first: method, factor, tolerance, seeds, step, integrator block."""

    def block(method, factor, step, **more):
        timestep = "auto" if factor == (1 if method == "implicit" else 0.5) else step
        return {"method": method, "timestep": timestep, **more}

    for factor, own in sorted(case.implicit.items()):
        step = factor * automatic
        yield "implicit", factor, NORMAL_TOLERANCE, own or case.seeds, step, block("implicit", factor, step)
    for tolerance in case.tolerances:
        integrator = block("implicit", 1, automatic, tolerance=tolerance)
        yield "implicit", 1, tolerance, case.seeds, automatic, integrator
    for factor, own in sorted(case.explicit.items()):
        step = factor * largest
        yield "explicit", factor, None, own or case.seeds, step, block("explicit", factor, step)


def made_of(name, case, scene, program, quick):
    """Yields a row for each variant, with `values` by seed and the `cost` of a realisation."""
    automatic = program.derived(merged(scene, integrator={"method": "implicit"}))["timestep"]
    largest = 2 * program.derived(merged(scene, integrator={"method": "explicit"}))["timestep"]
    for method, factor, tolerance, seeds, step, integrator in variants(case, automatic, largest):
        label = f"{method} {factor:g}" + (f" {tolerance:g}" if tolerance not in (None, NORMAL_TOLERANCE) else "")
        identifier = ("quick-" if quick else "") + f"{name} {label}".replace(" ", "-").replace(",", "")
        (point,) = program.run(identifier, scene, [{"/integrator": integrator}], QUICK_SEEDS if quick else seeds)
        living = point.results
        row = {"panel": name, "method": method, "step": factor, "tolerance": tolerance, "timestep": step}
        row |= {"values": point.by_seed(), "pressures": point.by_seed("pressure"), "flags": counts_text(flags(point))}
        row |= {"lost": point.lost, "seeds": len(point["realisations"]), "particles": scene["particles"]["count"]}
        row["seconds_per_strain"] = median([r["cost"]["cpu_seconds"] / sum(r["strain"].values()) for r in living])
        row["cost"] = median([r["cost"]["cpu_seconds"] for r in living])
        yield row | {"commit": " ".join(sorted(program.commits))}


def relative_variance(made):
    """Returns the relative variance over seeds, mean over all variants, because it does not depend on the step."""
    scatter = []
    for m in made:
        if len(m["values"]) > 1 and not m["lost"] and not m["flags"]:
            mean, error = estimate([*m["values"].values()])
            scatter.append(((error / mean) ** 2 * len(m["values"]), len(m["values"])))
    variances, weights = zip(*scatter)
    return float(np.average(variances, weights=weights))


def rows_of(name, case, program, quick):
    scene = merged(REFERENCE_SCENE, case.patch)
    if quick:
        scene = merged(scene, QUICK)
    made = [*made_of(name, case, scene, program, quick)]
    # Without noise both methods follow the same trajectory for a while, and the explicit one is the reference. With
    # noise another step has other noise; the reference is the finest implicit step, because explicit ones miss
    # contacts.
    noise = "peclet" in scene
    reference = made[0]
    if not noise:
        reference = next((m for m in made if m["method"] == "explicit" and m["values"]), reference)
    variance = relative_variance(made)
    for m in made:
        row = {key: m[key] for key in COLUMNS if key in m}
        row["seconds_to_2_percent"] = m["cost"] * variance / 0.02**2
        for quantity, prefix, name in (("values", "", "viscosity"), ("pressures", "pressure_", "pressure")):
            if m["values"]:
                row |= entries(name, estimate([*m[quantity].values()]))
            if m["values"] and m is not reference:
                bias, error, degrees = relative_difference(m[quantity], reference[quantity], not noise)
                row[f"{prefix}bias_percent"] = 100 * bias
                row[f"{prefix}bias_half_width_percent"] = 100 * error * student_quantile(degrees, 0.975)
                # Set by the viscosity, which comes first.
                row.setdefault("surely_wrong", abs(bias) > max(0.01, error * student_quantile(degrees, 1 - 0.5e-4)))
        yield row


def print_summary(rows):
    """Prints a table of the automatic step of every panel and half of the largest stable explicit one."""
    by_variant = {(row["panel"], row["method"], row["step"], row["tolerance"]): row for row in rows}
    print(markdown_head(SUMMARY))
    for name in dict.fromkeys(row["panel"] for row in rows):
        implicit = by_variant[name, "implicit", 1, NORMAL_TOLERANCE]
        cost, before = (r["seconds_per_strain"] for r in (implicit, by_variant[name, "explicit", 0.5, None]))
        bias = number_text((implicit["bias_percent"], implicit["bias_half_width_percent"]), 2)
        cells = [name, number_text(number(implicit, "viscosity"), 2), bias, f"{cost:.3g}", f"{before:.3g}"]
        print(markdown_row([*cells, f"{before / cost:.3g}", f"{implicit['seconds_to_2_percent']:.2g}"]))


def all_rows(program, panels, quick=False):
    for name in panels:
        yield from rows_of(name, PANELS[name], program, quick)
        print(f"{name}: done", file=sys.stderr, flush=True)


def checks(rows):
    """Yields checks of the automatic step: it must lose no seed, and change the viscosity by at most 1 %, unless by
    chance, to a level of 1e-4. Without noise this resolves half a percent; with noise it resolves little."""
    automatic = [row for row in rows if row["step"] == 1]
    wrong = [row for row in automatic if row.get("surely_wrong") and not row["flags"]]
    for row in wrong:
        print(f"{row['panel']}: the automatic step changes η_r by {row['bias_percent']:.1f} %", file=sys.stderr)
    yield Check("automatic steps that change η_r, without a flag", "bias", len(wrong), 0, high=0)
    yield Check("seeds that automatic steps lose", "losses", sum(row["lost"] for row in automatic), 0, high=0)


def measure(program):
    rows = list(all_rows(program, PANELS))
    write_table(HERE / "table.csv", COLUMNS, rows, digits=5)
    print_summary(rows)
    return checks(rows)


def quick_measure(program):
    """Runs two panels with small systems and few seeds, and draws their chart."""
    rows = list(all_rows(program, QUICK_PANELS, quick=True))
    path = Path(program.folder) / "table.csv"
    write_table(path, COLUMNS, rows, digits=5)
    print_summary(rows)
    draw_chart(read_texts(path), path.with_name("chart.png"))
    return checks(rows)


ACROSS = 4
RANGE = 6  # of the differences in every panel [%]
TEXT = 0.06, 1.0  # width over that of a panel, height [%]
STYLES = {  # point type, colour
    "explicit": (5, RED),
    "implicit": (7, BLUE),
    "implicit, tolerance 0.0001": (6, BLUE),
    "LAMMPS": (9, GREEN),
}
LEGEND = (
    "numbers: explicit step over\nthe largest stable one, implicit step\nover the automatic one;\n"
    "!: flagged or seeds lost;\nbars: 95 %; band: 2 %"
)


def style_of(row):
    return f"implicit, tolerance {row['tolerance']}" if row["tolerance"] == "0.0001" else row["method"]


def bar_of(row, of):
    """Returns the place of a point (x, y), the half-width of its bar, and the text above it."""
    bias = float(row[f"{of}bias_percent"] or 0)
    text = "" if row["method"] == "LAMMPS" else f"{float(row['step']):.2g}"
    if row["flags"] or row["lost"] not in ("", "0"):
        text += "!"
    shown = bias
    if abs(bias) > RANGE:
        text += f" {'↑' if bias > 0 else '↓'} {bias:.0f} %"
        shown = 0.85 * RANGE if bias > 0 else -0.85 * RANGE
    return float(row["seconds_to_2_percent"]), shown, float(row[f"{of}bias_half_width_percent"] or 0), text


def rows_of_texts(bars, span):
    """Returns the number of text rows by which each text must be raised so that it covers none before it."""
    taken, rows = [], []
    for x, y, *_ in bars:
        place, row = math.log(x, span), 0
        while any(abs(place - p) < TEXT[0] and abs(y + row * TEXT[1] - q) < 0.8 * TEXT[1] for p, q in taken):
            row += 1
        taken.append((place, y + row * TEXT[1]))
        rows.append(row)
    return rows


def add_panel(figure, name, rows, of=""):
    """Draws a panel; `of` is "" for the viscosity, or "pressure_"."""
    known = [r for r in rows if r["viscosity"] and float(r["seconds_to_2_percent"]) > 0]
    chosen = [r for r in known if r.get("pressure") or not of]
    dropped = [f"{r['method']} {float(r['step']):.2g}" for r in rows if not r["viscosity"]]
    title = f"{name} (no seed left: {', '.join(dropped)})" if dropped else name
    times = [float(r["seconds_to_2_percent"]) for r in chosen]
    titles = "s of processor to a standard error of 2 %", f"difference of {'P' if of else 'η_r'} / %", title
    ends = {"x_range": (min(times) / 3, max(times) * 3), "y_range": (-RANGE, RANGE), "y_step": 2}
    panel = figure.panel(*titles, log="x", key=None, **ends)
    panel.box(None, None, -2, 2, "#eef4e8")
    bars = sorted((*bar_of(r, of), style_of(r)) for r in chosen)
    for (x, y, half, text, style), row in zip(bars, rows_of_texts(bars, 9 * max(times) / min(times))):
        mark, colour = STYLES[style]
        panel.points([(x, y, half)], None, colour, mark, 1.1)
        panel.texts([(x, y, text)], colour, above=1 + row)


def add_legend(figure):
    """Draws the legend in its own panel."""
    panel = figure.blank()
    for k, (style, (mark, colour)) in enumerate(STYLES.items()):
        panel.points([(0.06, 0.9 - 0.12 * k)], None, colour, mark, 1.1)
        panel.text(style, 0.12, 0.9 - 0.12 * k, colour=colour)
    panel.text(LEGEND, 0.02, 0.4, va="top")


def draw_chart(rows, picture, pressure=True):
    names = list(dict.fromkeys(r["panel"] for r in rows))
    measured = {r["panel"] for r in rows if r.get("pressure")}
    with_pressure = [name for name in names if pressure and name in measured]
    lines = -(-(len(names) + len(with_pressure) + 1) // ACROSS)
    figure = Figure(picture, ACROSS, lines, (ACROSS * 380, lines * 310))
    for name in names:
        add_panel(figure, name, where(rows, panel=name))
    for name in with_pressure:
        add_panel(figure, name, where(rows, panel=name), "pressure_")
    add_legend(figure)
    figure.draw()


def draw():
    """Draws the charts, with LAMMPS in the panels of its cases."""
    rows = read_texts(HERE / "table.csv") + read_texts(HERE / "lammps.csv")
    draw_chart(rows, HERE / "chart.png")
    draw_chart([row for name in OVERVIEW for row in rows if row["panel"] == name], HERE / "overview.png", False)


main(HERE, TITLE, measure, quick_measure, draw=draw)
