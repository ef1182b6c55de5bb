#!/usr/bin/python3
"""remake.py BIN [FOLDER] [--quick] [--panel NAME]

Runs the campaigns of this study with the programs in BIN, keeps them in FOLDER (a second call goes on with what is there), and
writes table.csv and chart.png beside this script; --quick makes small systems and few seeds, writes into FOLDER and fails
where an unflagged default step is wrong by more than 1 % and three standard errors.
"""
import argparse
import csv
import math
import os
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.dirname(HERE))
from campaigns import Program, controlled_viscosity, estimate, merged  # noqa: E402

REFERENCE_SCENE = {
    "particles": {"count": 1000, "density": 0.1,
                  "species": [{"radius": 1.0, "volume_share": 0.5}, {"radius": 1.4, "volume_share": 0.5}]},
    "volume_fraction": 0.5,
    "fluid": {"viscosity": 0.1},
    "flow": {"shear_rate": 0.045},
    "contact": {"normal_stiffness": 1e4},
    "lubrication": {"form": "kim-karrila", "inner_gap": 1e-3, "outer_gap": 0.05},
    "duration": {"equilibration": {"strain": 1}, "production": {"strain": 2}},
}


def at_peclet(number):
    return {"flow": None, "peclet": number, "limits": {"shear_rate": 0.045, "thermal_energy": 0.017}}


BROWNIAN_WINDOW = {"duration": {"equilibration": {"brownian_times": 10}, "production": {"brownian_times": 40}}}

# name, what differs from the reference scene, seeds, explicit steps (of the largest stable one) and implicit ones (of the
# automatic one) with their seeds where those are others, tolerances at the automatic step
PANELS = [
    ("reference", {}, 8, {0.5: None, 0.999: None}, {0.25: None, 0.5: None, 1: None, 2: None, 3.99: None}, [1e-4]),
    ("friction 1, phi 0.45", {"contact": {"friction": 1}, "volume_fraction": 0.45}, 8, {0.5: None},
     {0.5: None, 1: None, 2: None, 3.99: None}, [1e-4]),
    ("friction 1", {"contact": {"friction": 1}}, 4, {0.5: None}, {0.5: None, 1: None, 2: None}, []),
    ("N 250", {"particles": {"count": 250}}, 16, {0.5: None}, {1: None, 2: None}, []),
    ("N 4000", {"particles": {"count": 4000}}, 2, {0.5: None}, {1: None, 2: None}, []),
    ("outer gap 0.2", {"lubrication": {"outer_gap": 0.2}}, 4, {0.5: None}, {1: None, 2: None}, []),
    ("outer gap 0.5", {"lubrication": {"outer_gap": 0.5}}, 2, {0.5: None}, {1: None, 2: None}, []),
    ("inner gap 0.01", {"lubrication": {"inner_gap": 1e-2}}, 4, {0.5: None}, {0.5: None, 1: None, 2: None}, []),
    ("inner gap 0.0001", {"lubrication": {"inner_gap": 1e-4}, "particles": {"count": 250}}, 8, {0.5: 4}, {0.5: None, 1: None, 2: None}, []),
    ("stiffness 1000", {"contact": {"normal_stiffness": 1e3}}, 4, {0.5: None}, {0.5: None, 1: None, 2: None}, []),
    ("stiffness 100000", {"contact": {"normal_stiffness": 1e5}}, 4, {0.5: None}, {0.5: None, 1: None, 2: None}, []),
    ("Pe 100", at_peclet(100), 48, {0.5: 16}, {0.5: None, 1: None, 2: None, 3.99: None}, []),
    ("Pe 1", {**at_peclet(1), **BROWNIAN_WINDOW, "particles": {"count": 250}}, 32, {0.5: 16},
     {0.25: 48, 0.5: 48, 1: 64, 2: None, 3.99: None}, [1e-4]),
    ("Pe 0.1", {**at_peclet(0.1), **BROWNIAN_WINDOW, "particles": {"count": 250}}, 64, {0.5: 24}, {0.5: None, 1: 128, 2: None}, []),
]
OVERVIEW = ["reference", "friction 1, phi 0.45", "Pe 1"]
QUICK_PANELS = {
    "reference": {"particles": {"count": 100}, "duration": {"equilibration": {"strain": 0.5}, "production": {"strain": 1}}},
    "Pe 100": {"particles": {"count": 100}, "duration": {"equilibration": {"strain": 0.5}, "production": {"strain": 1}}},
}
QUICK_SEEDS = 8
COLUMNS = ["panel", "method", "step", "timestep", "tolerance", "seeds", "lost", "flags", "viscosity", "viscosity_error", "bias_percent",
           "bias_error_percent", "seconds_per_strain", "seconds_to_2_percent", "particles"]


def variants(panel, automatic, largest):
    """Label parts and the integrator block of every variant, the finest first: the others are compared with it."""
    _, _, seeds, explicit, implicit, tolerances = panel
    for factor, own in sorted(implicit.items()):
        yield ("implicit", factor, 1e-3, own or seeds,
               {"method": "implicit", "timestep": "auto" if factor == 1 else factor * automatic})
    for tolerance in tolerances:
        yield "implicit", 1, tolerance, seeds, {"method": "implicit", "timestep": "auto", "tolerance": tolerance}
    for factor, own in sorted(explicit.items()):
        yield ("explicit", factor, None, own or seeds,
               {"method": "explicit", "timestep": "auto" if factor == 0.5 else factor * largest})


def compare(values, reference, paired):
    """Relative difference in percent and its standard error."""
    common = sorted(values.keys() & reference.keys())
    if paired and len(common) > 1:
        mean, error = estimate([values[s] / reference[s] for s in common])
        return 100 * (mean - 1), 100 * error
    (a, da), (b, db) = estimate(list(values.values())), estimate(list(reference.values()))
    return 100 * (a / b - 1), 100 * a / b * math.hypot(da / a, db / b)


def rows_of(panel, program, quick):
    name, patch = panel[:2]
    scene = merged(REFERENCE_SCENE, patch)
    if quick:
        scene = merged(scene, QUICK_PANELS[name])
    automatic = program.derived(merged(scene, {"integrator": {"method": "implicit"}}))["timestep"]
    largest = 2 * program.derived(merged(scene, {"integrator": {"method": "explicit"}}))["timestep"]
    # Without noise two methods follow the same trajectory for a while; the explicit one is the published method.
    noise = "peclet" in scene
    made = []
    for method, factor, tolerance, seeds, integrator in variants(panel, automatic, largest):
        label = f"{method} {factor:g}" + (f" {tolerance:g}" if tolerance not in (None, 1e-3) else "")
        identifier = f"{name} {label}".replace(" ", "-").replace(",", "")
        points = program.run(("quick-" if quick else "") + identifier, scene, [{"/integrator": integrator}],
                             QUICK_SEEDS if quick else seeds)
        realisations = points[0]["realisations"]
        values = {r["seed"]: controlled_viscosity(r["mean"]) for r in realisations if r.get("mean")}
        flags = sorted({w["code"] for r in realisations for w in r.get("warnings", [])} & {"timestep", "solver", "overlap"})
        strain_costs = [r["cost"]["cpu_seconds"] / sum(r["strain"].values()) for r in realisations if r.get("mean")]
        costs = [r["cost"]["cpu_seconds"] for r in realisations if r.get("mean")]
        made.append({"panel": name, "method": method, "step": factor, "tolerance": tolerance, "values": values, "flags": " ".join(flags),
                     "lost": len(realisations) - len(values), "strain": min(strain_costs, default=math.nan),
                     "cost": min(costs, default=math.nan), "particles": scene["particles"]["count"],
                     "timestep": realisations[0]["timestep"]})
    reference = made[0] if noise else next(m for m in made if m["method"] == "explicit" and m["values"])
    # Seeds decide the scatter, not the step: what an error bar costs follows from the scatter of all of them.
    scatter = []
    for m in made:
        if len(m["values"]) > 1:
            mean, error = estimate(list(m["values"].values()))
            scatter.append((len(m["values"]), (error / mean) ** 2 * len(m["values"])))
    variance = sum(n * v for n, v in scatter) / sum(n for n, _ in scatter)
    for m in made:
        row = {key: m[key] for key in ("panel", "method", "step", "timestep", "tolerance", "flags", "lost", "particles")}
        row["seeds"] = len(m["values"]) + m["lost"]
        row["seconds_per_strain"] = m["strain"]
        row["seconds_to_2_percent"] = m["cost"] * variance / 0.02**2
        if m["values"]:
            row["viscosity"], row["viscosity_error"] = estimate(list(m["values"].values()))
            row["bias_percent"], row["bias_error_percent"] = (0, 0) if m is reference else compare(m["values"], reference["values"], not noise)
        yield row


def write(rows, path):
    with open(path, "w", newline="") as f:
        writer = csv.DictWriter(f, COLUMNS)
        writer.writeheader()
        for row in rows:
            writer.writerow({k: f"{v:.5g}" if isinstance(v, float) else v for k, v in row.items()})


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("binaries")
    parser.add_argument("folder", nargs="?", help="of the campaigns; a temporary one unless given")
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--panel", help="this one alone, into the folder")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as temporary:
        remake(arguments, arguments.folder or temporary)


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
    write(rows, table)
    draw = [sys.executable, os.path.join(HERE, "chart.py"), table]
    subprocess.run([*draw, os.path.join(target, "chart.png")], check=True)
    if whole:
        subprocess.run([*draw, os.path.join(target, "overview.png"), *OVERVIEW], check=True)
    if arguments.quick:
        for row in rows:
            wrong = abs(row.get("bias_percent", 0)) > max(1, 3 * row.get("bias_error_percent", 0))
            if row["step"] == 1 and not row["flags"] and wrong:
                sys.exit(f"{row['panel']}: the automatic step changes the viscosity by {row['bias_percent']:.1f} %")


main()
