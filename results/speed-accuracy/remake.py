#!/usr/bin/python3
"""remake.py BIN [FOLDER] [--quick] [--panel NAME]

Runs the campaigns of this study with the programs in BIN, keeps them in FOLDER (a second call goes on with what is
there), prints a summary and writes table.csv, chart.png and overview.png beside this script. --quick makes small
systems and few seeds, writes into FOLDER and fails where a default step loses a seed or, without a flag, changes the
viscosity by more than 1 % and more than chance does in one run of ten thousand: without noise it compares the two
methods and sees half a percent; with noise it sees little.
"""
import math
import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from studies.campaigns import Program
from studies.command_line import drive
from studies.estimates import estimate, relative_difference, student_quantile
from studies.scenes import REFERENCE_SCENE, during, merged
from studies.tables import markdown_head, markdown_row, write_table
from studies.viscosities import counts_text, flags, values_by_seed
from studies.speed_accuracy import COLUMNS, PANELS

import numpy as np


OVERVIEW = ["reference", "friction 1, phi 0.45", "Pe 1"]
QUICK_PANELS = ("reference", "Pe 100")
QUICK = {"particles": {"count": 100}, **during({"strain": 0.5}, {"strain": 1.5})}
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
    """Of every variant, the finest first: method, factor, tolerance, seeds, step, integrator block."""

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
    """A row for each variant, with `values` by seed and the `cost` of a realisation."""
    automatic = program.derived(merged(scene, {"integrator": {"method": "implicit"}}))["timestep"]
    largest = 2 * program.derived(merged(scene, {"integrator": {"method": "explicit"}}))["timestep"]
    for method, factor, tolerance, seeds, step, integrator in variants(case, automatic, largest):
        label = f"{method} {factor:g}" + (f" {tolerance:g}" if tolerance not in (None, NORMAL_TOLERANCE) else "")
        identifier = ("quick-" if quick else "") + f"{name} {label}".replace(" ", "-").replace(",", "")
        settings = [{"/integrator": integrator}]
        realisations = program.run(identifier, scene, settings, QUICK_SEEDS if quick else seeds)[0]["realisations"]
        living = [r for r in realisations if r.get("mean")]
        yield {
            "panel": name,
            "method": method,
            "step": factor,
            "tolerance": tolerance,
            "timestep": step,
            "values": values_by_seed(realisations),
            "pressures": values_by_seed(realisations, "pressure"),
            "flags": counts_text(flags(realisations)),
            "lost": len(realisations) - len(living),
            "seeds": len(realisations),
            "seconds_per_strain": median([r["cost"]["cpu_seconds"] / sum(r["strain"].values()) for r in living]),
            "cost": median([r["cost"]["cpu_seconds"] for r in living]),
            "particles": scene["particles"]["count"],
            "commit": " ".join(sorted(program.commits)),
        }


def relative_variance(made):
    """Seeds decide the scatter, not the step: what an error bar costs follows from the scatter of all of them."""
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
    # Without noise both methods follow the same trajectory for a while, and the explicit one is the reference; with
    # noise another step draws another noise, and the reference is the finest implicit step, because explicit ones miss
    # contacts.
    noise = "peclet" in scene
    reference = made[0]
    if not noise:
        reference = next((m for m in made if m["method"] == "explicit" and m["values"]), reference)
    variance = relative_variance(made)
    for m in made:
        row = {key: m[key] for key in COLUMNS if key in m}
        row["seconds_to_2_percent"] = m["cost"] * variance / 0.02**2
        if m["values"]:
            row["viscosity"], row["viscosity_error"] = estimate([*m["values"].values()])
            row["pressure"], row["pressure_error"] = estimate([*m["pressures"].values()])
            if m is not reference:
                bias, error, degrees = relative_difference(m["values"], reference["values"], not noise)
                row["bias_percent"] = 100 * bias
                row["bias_half_width_percent"] = 100 * error * student_quantile(degrees, 0.975)
                of_pressure = relative_difference(m["pressures"], reference["pressures"], not noise)
                row["pressure_bias_percent"] = 100 * of_pressure[0]
                row["pressure_bias_half_width_percent"] = 100 * of_pressure[1] * student_quantile(of_pressure[2], 0.975)
                row["surely_wrong"] = abs(bias) > max(0.01, error * student_quantile(degrees, 1 - 0.5e-4))
        yield row


def print_summary(rows):
    """The automatic step of every panel beside half of the largest stable explicit one."""
    by_variant = {(row["panel"], row["method"], row["step"], row["tolerance"]): row for row in rows}
    print(markdown_head(SUMMARY))
    for name in dict.fromkeys(row["panel"] for row in rows):
        implicit = by_variant[name, "implicit", 1, NORMAL_TOLERANCE]
        cost, before = (r["seconds_per_strain"] for r in (implicit, by_variant[name, "explicit", 0.5, None]))
        cells = [
            name,
            f"{implicit['viscosity']:.2f} ± {implicit['viscosity_error']:.2f}",
            f"{implicit['bias_percent']:.2f} ± {implicit['bias_half_width_percent']:.2f}",
            f"{cost:.3g}",
            f"{before:.3g}",
            f"{before / cost:.3g}",
            f"{implicit['seconds_to_2_percent']:.2g}",
        ]
        print(markdown_row(cells))


def judge(rows):
    for row in rows:
        if row["step"] == 1 and (row["lost"] or row.get("surely_wrong") and not row["flags"]):
            change = row.get("bias_percent", math.nan)
            sys.exit(
                f"{row['panel']}: the automatic step changes the viscosity by {change:.1f} % "
                f"and loses {row['lost']} seeds"
            )


def remake(arguments, folder):
    program = Program(arguments.binaries, folder)
    rows = []
    for name, case in PANELS.items():
        if arguments.quick and name not in QUICK_PANELS or arguments.panel not in (None, name):
            continue
        rows += rows_of(name, case, program, arguments.quick)
        print(f"{name}: done", file=sys.stderr, flush=True)
    whole = not arguments.quick and not arguments.panel
    target = HERE if whole else Path(folder)
    write_table(target / "table.csv", COLUMNS, rows, digits=5)
    print_summary(rows)
    draw = [sys.executable, HERE / "chart.py", target / "table.csv"]
    subprocess.run([*draw, target / "chart.png"], check=True)
    if whole:
        subprocess.run([*draw, target / "overview.png", *OVERVIEW], check=True)
    if arguments.quick:
        judge(rows)


drive(__doc__.splitlines()[0], list(PANELS), remake)
