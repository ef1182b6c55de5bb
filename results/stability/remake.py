#!/usr/bin/python3
"""remake.py BIN [FOLDER] [--quick] [--panel NAME]

Runs the cells of the stability map with the programs in BIN, keeps their campaigns in FOLDER (a second call goes on
with what is there), and writes table.csv and map.png beside this script; with --quick or --panel into FOLDER. Fails
where a cell is biased and no realisation says so; chance makes one of a thousand cells so.
"""
import collections
import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from studies.campaigns import Program
from studies.command_line import drive
from studies.estimates import relative_difference, student_quantile
from studies.scenes import REFERENCE_SCENE, at_peclet, during, merged
from studies.tables import write_table
from studies.viscosities import counts_text, flags, values_by_seed

BASE = merged(REFERENCE_SCENE, {"particles": {"count": 100}, **during({"strain": 0.5}, {"strain": 0.75})})
# Steps of each column: explicit ones over the largest stable step of the scene, implicit ones over the automatic one.
EXPLICIT, IMPLICIT = (0.5, 0.999, 2), (0.25, 1, 2, 3.99, 8)


def stiffness(k):
    return {"contact": {"normal_stiffness": k}}


def friction(mu):
    return {"contact": {"friction": mu}}


def brownian(number):
    parts = during({"strain": 0.5, "brownian_times": 10}, {"strain": 2, "brownian_times": 20})
    return {**at_peclet(number), **parts}


def large_spheres(ratio):
    # three large spheres for ratio 7 and equal volumes for the others
    small = 0.5 if ratio < 7 else 0.22
    return {
        "particles": {
            "count": 300,
            "species": [{"radius": 1.0, "volume_share": small}, {"radius": ratio, "volume_share": 1 - small}],
        }
    }


def repulsion(strength, length):
    return {"repulsion": {"form": "exponential", "strength": strength, "relative_length": length}}


STARTUP = during({"strain": 0}, {"strain": 0.75})
PANELS = {
    "stiffness and volume fraction": [
        (f"k {k:g}, phi {phi:g}", {**stiffness(k), "volume_fraction": phi}, 4 if phi < 0.5 else 16)
        for k in (1e3, 1e4, 1e5)
        for phi in (0.3, 0.5, 0.6, 0.63, 0.66)
    ],
    "friction": [
        (f"mu {mu:g}, phi {phi:g}", {**friction(mu), "volume_fraction": phi}, 8 if phi < 0.5 else 16)
        for mu in (0.1, 0.5, 1, 10)
        for phi in (0.4, 0.5, 0.55, 0.6)
    ],
    "gaps": [
        (f"gaps {inner:g} to {outer:g}", {"lubrication": {"inner_gap": inner, "outer_gap": outer}}, 8)
        for inner, outer in ((1e-2, 0.05), (1e-4, 0.05), (1e-3, 0.2), (1e-3, 0.5))
    ],
    "sizes": [(f"radii 1 : {ratio:g}", large_spheres(ratio), 6) for ratio in (1, 2, 4, 7)],
    "small boxes": [(f"N {count}", {"particles": {"count": count}}, 8) for count in (6, 8, 12, 20, 40)],
    "start-up": [
        ("mu 0", STARTUP, 8),
        ("mu 1", merged(STARTUP, friction(1)), 8),
        ("phi 0.62", merged(STARTUP, {"volume_fraction": 0.62}), 16),
        ("A 1, kappa 0.01", merged(STARTUP, repulsion(1, 0.01)), 8),
        ("A 100, kappa 0.01", merged(STARTUP, repulsion(100, 0.01)), 32),
        ("A 1, kappa 0.05", merged(STARTUP, repulsion(1, 0.05)), 8),
        ("A 100, kappa 0.05", merged(STARTUP, repulsion(100, 0.05)), 32),
    ],
    "inertia": [
        (f"St {stokes:g}", {"particles": {"density": 0.1 * stokes / 0.045}}, 4) for stokes in (0.001, 0.01, 0.1, 1, 10)
    ],
    "Peclet number": [
        (f"Pe {pe:g}, phi {phi:g}", {**brownian(pe), "volume_fraction": phi}, 16 if phi < 0.5 else 32)
        for phi in (0.3, 0.5)
        for pe in (0.1, 1, 10, 100, 1e4)
    ],
    "Peclet number and friction": [(f"Pe {pe:g}, mu 1", merged(brownian(pe), friction(1)), 32) for pe in (1, 100)],
}
QUICK = {"stiffness and volume fraction": 4, "start-up": 2}
COLUMNS = [
    "panel",
    "case",
    "method",
    "step",
    "timestep",
    "verdict",
    "bias_percent",
    "bias_half_width_percent",
    "flags",
    "causes",
    "seeds",
    "commit",
]
CAUSES_OF_JAMS = {"overlap", "packing"}


def integrators(program, scene):
    """Every column: method, factor and integrator block, or None with what was answered where the step is refused."""
    for method, factors, factor_of_auto in (("explicit", EXPLICIT, 0.5), ("implicit", IMPLICIT, 1)):
        answer = program.derived(merged(scene, {"integrator": {"method": method}}))
        for factor in factors:
            block = {"method": method, "timestep": factor * (answer["timestep"] / factor_of_auto)}
            refused = program.derived(merged(scene, {"integrator": block})).get("refused")
            yield method, factor, block, refused


# A bias counts from this on, where it is more than chance does in one of a thousand cells.
LEAST_BIAS = 0.03
RARE = 1 - 0.5e-3


def verdict_of(difference, values, causes):
    """What a cell is."""
    if sum(causes.values()) > len(values):
        cause = causes.most_common(1)[0][0]
        return "jammed" if cause in CAUSES_OF_JAMS else "blown up"
    if causes:
        return "losses"
    if difference is None:
        return "no reference"
    bias, error, degrees = difference
    doubt = error * student_quantile(degrees, RARE)
    if abs(bias) > max(LEAST_BIAS, doubt):
        return "biased"
    return "ok" if doubt < 0.1 else "undecided"


def cells_of(name, case, scene, program):
    """A row for each column, without its verdict, with `values` by seed and `lost` by cause."""
    label, _, seeds = case
    columns = list(integrators(program, scene))
    identifier = "".join(c if c.isalnum() or c in ".-" else "-" for c in f"{name} {label}")
    settings = [{"/integrator": block} for _, _, block, refused in columns if not refused]
    of_block = {}
    for point in program.run(identifier, scene, settings, seeds):
        block = point["settings"]["/integrator"]
        of_block[block["method"], block["timestep"]] = point["realisations"]
    for method, factor, block, refused in columns:
        realisations = [] if refused else of_block[method, block["timestep"]]
        yield {
            "panel": name,
            "case": label,
            "method": method,
            "step": factor,
            "timestep": block["timestep"],
            "seeds": len(realisations),
            "values": values_by_seed(realisations),
            "commit": " ".join(sorted(program.commits)),
            "lost": collections.Counter(r["ending"]["cause"] for r in realisations if not r.get("mean")),
            "flags": counts_text(flags(realisations)),
            "refused": refused,
        }


def rows_of(name, case, program):
    scene = merged(BASE, case[1])
    cells = list(cells_of(name, case, scene, program))
    # Without noise trajectories of one seed stay together for a while; with noise another step draws another one.
    noise = "peclet" in scene
    finest = ("implicit", 0.25) if noise else ("explicit", 0.5)
    reference = next(c for c in cells if (c["method"], c["step"]) == finest)
    for cell in cells:
        row = {key: cell[key] for key in COLUMNS if key in cell}
        difference = None
        if cell["values"].keys() & reference["values"].keys():
            difference = 0, 0, len(reference["values"]) - 1
            if cell is not reference:
                difference = relative_difference(cell["values"], reference["values"], not noise)
            row["bias_percent"] = 100 * difference[0]
            row["bias_half_width_percent"] = 100 * difference[1] * student_quantile(difference[2], 0.975)
        row["verdict"] = "refused" if cell["refused"] else verdict_of(difference, cell["values"], cell["lost"])
        row["causes"] = counts_text(cell["lost"])
        yield row


def remake(arguments, folder):
    program = Program(arguments.binaries, folder)
    rows = []
    for name, cases in PANELS.items():
        if arguments.quick:
            cases = cases[: QUICK.get(name, 0)]
        if arguments.panel not in (None, name):
            continue
        for case in cases:
            rows += rows_of(name, case, program)
            print(f"{name}: {case[0]}", file=sys.stderr, flush=True)
    target = Path(folder) if arguments.quick or arguments.panel else HERE
    table = target / "table.csv"
    write_table(table, COLUMNS, rows, digits=4)
    silent = [r for r in rows if r["verdict"] == "biased" and not r["flags"]]
    for row in silent:
        cell = f"{row['panel']}, {row['case']}, {row['method']} {row['step']:g}"
        print(f"wrong without a flag: {cell}: {row['bias_percent']:.1f} %", file=sys.stderr)
    subprocess.run([sys.executable, HERE / "map.py", table, target / "map.png"], check=True)
    sys.exit(1 if silent else 0)


drive(__doc__.splitlines()[0], list(PANELS), remake)
