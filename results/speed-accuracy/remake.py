#!/usr/bin/python3
"""remake.py BIN [FOLDER] [--quick] [--panel NAME]

Runs the campaigns of this study with the programs in BIN, keeps them in FOLDER (a second call goes on with what is there), prints a
summary and writes table.csv, chart.png and overview.png beside this script. --quick makes small systems and few seeds, writes into
FOLDER and fails where a default step loses a seed or, without a flag, changes the viscosity by more than 1 % and more than chance does
in one run of ten thousand: without noise it compares the two methods and sees half a percent; with noise it sees little.
"""
import math
import os
import statistics
import subprocess
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.dirname(HERE))
from campaigns import (
    REFERENCE_SCENE,
    Program,
    at_peclet,
    counts_text,
    drive,
    estimate,
    flags,
    merged,
    relative_difference,
    student_quantile,  # noqa: E402
    values_by_seed,
    write_table,
)

BROWNIAN_WINDOW = {"duration": {"equilibration": {"brownian_times": 10}, "production": {"brownian_times": 40}}}

# name, what differs from the reference scene, seeds, explicit steps (of the largest stable one) and implicit ones (of the
# automatic one) with their seeds where those are others, tolerances at the automatic step
PANELS = [
    ("reference", {}, 8, {0.5: None, 0.999: None}, {0.25: None, 0.5: None, 1: None, 2: None, 3.99: None}, [1e-4]),
    (
        "friction 1, phi 0.45",
        {"contact": {"friction": 1}, "volume_fraction": 0.45},
        8,
        {0.5: None},
        {0.5: None, 1: None, 2: None, 3.99: None},
        [1e-4],
    ),
    ("friction 1", {"contact": {"friction": 1}}, 4, {0.5: None}, {0.5: None, 1: None, 2: None}, []),
    ("N 250", {"particles": {"count": 250}}, 16, {0.5: None}, {1: None, 2: None}, []),
    ("N 4000", {"particles": {"count": 4000}}, 2, {0.5: None}, {1: None, 2: None}, []),
    ("outer gap 0.2", {"lubrication": {"outer_gap": 0.2}}, 4, {0.5: None}, {1: None, 2: None}, []),
    ("outer gap 0.5", {"lubrication": {"outer_gap": 0.5}}, 2, {0.5: None}, {1: None, 2: None}, []),
    ("inner gap 0.01", {"lubrication": {"inner_gap": 1e-2}}, 4, {0.5: None}, {0.5: None, 1: None, 2: None}, []),
    (
        "inner gap 0.0001",
        {"lubrication": {"inner_gap": 1e-4}, "particles": {"count": 250}},
        8,
        {0.5: 4},
        {0.5: None, 1: None, 2: None},
        [],
    ),
    ("stiffness 1000", {"contact": {"normal_stiffness": 1e3}}, 4, {0.5: None}, {0.5: None, 1: None, 2: None}, []),
    ("stiffness 100000", {"contact": {"normal_stiffness": 1e5}}, 4, {0.5: None}, {0.5: None, 1: None, 2: None}, []),
    ("Pe 100", at_peclet(100), 48, {0.5: 16}, {0.5: None, 1: None, 2: None, 3.99: None}, []),
    (
        "Pe 1",
        {**at_peclet(1), **BROWNIAN_WINDOW, "particles": {"count": 250}},
        32,
        {0.5: 16},
        {0.25: 48, 0.5: 48, 1: 64, 2: None, 3.99: None},
        [1e-4],
    ),
    (
        "Pe 0.1",
        {**at_peclet(0.1), **BROWNIAN_WINDOW, "particles": {"count": 250}},
        64,
        {0.5: 24},
        {0.5: None, 1: 128, 2: None},
        [],
    ),
]
OVERVIEW = ["reference", "friction 1, phi 0.45", "Pe 1"]
QUICK_PANELS = {
    "reference": {
        "particles": {"count": 100},
        "duration": {"equilibration": {"strain": 0.5}, "production": {"strain": 1}},
    },
    "Pe 100": {
        "particles": {"count": 100},
        "duration": {"equilibration": {"strain": 0.5}, "production": {"strain": 1}},
    },
}
QUICK_SEEDS = 8
COLUMNS = [
    "panel",
    "method",
    "step",
    "timestep",
    "tolerance",
    "seeds",
    "lost",
    "flags",
    "viscosity",
    "viscosity_error",
    "bias_percent",
    "bias_half_width_percent",
    "seconds_per_strain",
    "seconds_to_2_percent",
    "particles",
    "commit",
]


def median(values):
    return statistics.median(values) if values else math.nan


def variants(panel, automatic, largest):
    """Label parts and the integrator block of every variant, the finest first."""
    _, _, seeds, explicit, implicit, tolerances = panel
    for factor, own in sorted(implicit.items()):
        yield (
            "implicit",
            factor,
            1e-3,
            own or seeds,
            {"method": "implicit", "timestep": "auto" if factor == 1 else factor * automatic},
        )
    for tolerance in tolerances:
        yield "implicit", 1, tolerance, seeds, {"method": "implicit", "timestep": "auto", "tolerance": tolerance}
    for factor, own in sorted(explicit.items()):
        yield (
            "explicit",
            factor,
            None,
            own or seeds,
            {"method": "explicit", "timestep": "auto" if factor == 0.5 else factor * largest},
        )


def rows_of(panel, program, quick):
    name, patch = panel[:2]
    scene = merged(REFERENCE_SCENE, patch)
    if quick:
        scene = merged(scene, QUICK_PANELS[name])
    automatic = program.derived(merged(scene, {"integrator": {"method": "implicit"}}))["timestep"]
    largest = 2 * program.derived(merged(scene, {"integrator": {"method": "explicit"}}))["timestep"]
    # Without noise both methods follow the same trajectory for a while, and the explicit one is the reference; with noise
    # another step draws another noise, and the reference is the finest implicit step, because explicit ones miss contacts.
    noise = "peclet" in scene
    made = []
    for method, factor, tolerance, seeds, integrator in variants(panel, automatic, largest):
        label = f"{method} {factor:g}" + (f" {tolerance:g}" if tolerance not in (None, 1e-3) else "")
        identifier = f"{name} {label}".replace(" ", "-").replace(",", "")
        points = program.run(
            ("quick-" if quick else "") + identifier,
            scene,
            [{"/integrator": integrator}],
            QUICK_SEEDS if quick else seeds,
        )
        realisations = points[0]["realisations"]
        living = [r for r in realisations if r.get("mean")]
        made.append(
            {
                "panel": name,
                "method": method,
                "step": factor,
                "tolerance": tolerance,
                "values": values_by_seed(realisations),
                "flags": counts_text(flags(realisations)),
                "lost": len(realisations) - len(living),
                "seeds": len(realisations),
                "seconds_per_strain": median([r["cost"]["cpu_seconds"] / sum(r["strain"].values()) for r in living]),
                "cost": median([r["cost"]["cpu_seconds"] for r in living]),
                "particles": scene["particles"]["count"],
                "commit": " ".join(sorted(program.commits)),
                "timestep": integrator["timestep"]
                if integrator["timestep"] != "auto"
                else automatic
                if method == "implicit"
                else largest / 2,
            }
        )
    reference = made[0] if noise else next((m for m in made if m["method"] == "explicit" and m["values"]), made[0])
    # Seeds decide the scatter, not the step: what an error bar costs follows from the scatter of all of them.
    scatter = []
    for m in made:
        if len(m["values"]) > 1 and not m["lost"] and not m["flags"]:
            mean, error = estimate(list(m["values"].values()))
            scatter.append((len(m["values"]), (error / mean) ** 2 * len(m["values"])))
    variance = sum(n * v for n, v in scatter) / sum(n for n, _ in scatter)
    for m in made:
        row = {key: m[key] for key in COLUMNS if key in m}
        row["seconds_to_2_percent"] = m["cost"] * variance / 0.02**2
        if m["values"]:
            row["viscosity"], row["viscosity_error"] = estimate(list(m["values"].values()))
            if m is not reference:
                bias, error, degrees = relative_difference(m["values"], reference["values"], not noise)
                row["bias_percent"] = 100 * bias
                row["bias_half_width_percent"] = 100 * error * student_quantile(degrees, 0.975)
                row["surely_wrong"] = abs(bias) > max(0.01, error * student_quantile(degrees, 1 - 0.5e-4))
        yield row


def print_summary(rows):
    """The automatic step of every panel beside half of the largest stable explicit one."""
    print(
        "| case | η_r | automatic step against the reference, % | s per strain, implicit | explicit | times as much | s to a standard error of 2 % |"
    )
    print("|---|---|---|---|---|---|---|")
    for name in dict.fromkeys(row["panel"] for row in rows):

        def of(method, step, tolerance):
            return next(
                r
                for r in rows
                if (r["panel"], r["method"], r["step"], r["tolerance"]) == (name, method, step, tolerance)
            )

        implicit, explicit = of("implicit", 1, 1e-3), of("explicit", 0.5, None)
        cost, before = implicit["seconds_per_strain"], explicit["seconds_per_strain"]
        print(
            f"| {name} | {implicit['viscosity']:.2f} ± {implicit['viscosity_error']:.2f} | "
            f"{implicit['bias_percent']:.2f} ± {implicit['bias_half_width_percent']:.2f} | {cost:.3g} | {before:.3g} | "
            f"{before / cost:.3g} | {implicit['seconds_to_2_percent']:.2g} |"
        )


def remake(arguments, folder):
    program = Program(arguments.binaries, folder)
    rows = []
    for panel in PANELS:
        if arguments.quick and panel[0] not in QUICK_PANELS or arguments.panel not in (None, panel[0]):
            continue
        rows += rows_of(panel, program, arguments.quick)
        print(f"{panel[0]}: done", file=sys.stderr, flush=True)
    whole = not arguments.quick and not arguments.panel
    target = HERE if whole else folder
    table = os.path.join(target, "table.csv")
    write_table(table, COLUMNS, rows, digits=5)
    print_summary(rows)
    draw = [sys.executable, os.path.join(HERE, "chart.py"), table]
    subprocess.run([*draw, os.path.join(target, "chart.png")], check=True)
    if whole:
        subprocess.run([*draw, os.path.join(target, "overview.png"), *OVERVIEW], check=True)
    if arguments.quick:
        for row in rows:
            if row["step"] == 1 and (row["lost"] or row.get("surely_wrong") and not row["flags"]):
                sys.exit(
                    f"{row['panel']}: the automatic step changes the viscosity by {row.get('bias_percent', math.nan):.1f} % and loses {row['lost']} seeds"
                )


drive(__doc__.splitlines()[0], [panel[0] for panel in PANELS], remake)
