#!/usr/bin/python3
"""Failures of each method of integration: a row for each case, a column for each step of each method."""
import collections
import statistics
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from studies.driver import Check, Figure, Point, REFERENCE_SCENE, at_peclet, counts_text, during, entries, flags
from studies.driver import in_strains, main, merged, read_texts, relative_difference, student_quantile, write_table

TITLE = "Where each method fails, and how"
BASE = merged(REFERENCE_SCENE, in_strains(0.5, 0.75), particles={"count": 100})
# Steps of the columns: explicit ones over the largest stable step of the scene, implicit ones over the automatic one.
STEPS = {"explicit": (0.5, 0.999, 2), "implicit": (0.25, 1, 2, 3.99, 8)}
# Further steps with noise and friction by Peclet number, no columns. The first implicit one is the reference. At ONSET
# the step matters most; onset.csv has all steps there.
ONSET, USUAL = 100, {"implicit": (1 / 16,)}
FURTHER = {1: USUAL, 10: USUAL, ONSET: {"explicit": (0.25,), "implicit": (1 / 64, 1 / 16)}, 1000: USUAL}


def stiffness(k):
    return {"contact": {"normal_stiffness": k}}


def friction(mu):
    return {"contact": {"friction": mu}}


def brownian(number):
    return {**at_peclet(number), **during({"strain": 0.5, "brownian_times": 10}, {"strain": 2, "brownian_times": 20})}


def large_spheres(ratio):
    # A ratio of 7 gives three large spheres; the others have equal volumes.
    small = 0.5 if ratio < 7 else 0.22
    return {
        "particles": {
            "count": 300,
            "species": [{"radius": 1.0, "volume_share": small}, {"radius": ratio, "volume_share": 1 - small}],
        }
    }


def repulsion(strength, length, **others):
    return {"repulsion": {"form": "exponential", "strength": strength, "relative_length": length, **others}}


STARTUP = in_strains(0, 0.75)
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
        ("phi 0.62", merged(STARTUP, volume_fraction=0.62), 16),
        ("A 1, kappa 0.01", merged(STARTUP, repulsion(1, 0.01)), 8),
        ("A 100, kappa 0.01", merged(STARTUP, repulsion(100, 0.01)), 32),
        ("A 1, kappa 0.05", merged(STARTUP, repulsion(1, 0.05)), 8),
        ("A 100, kappa 0.05", merged(STARTUP, repulsion(100, 0.05)), 32),
        ("A 100, kappa 0.05, cut off at 5", merged(STARTUP, repulsion(100, 0.05, cutoff_lengths=5)), 32),
    ],
    "inertia": [
        (f"St {stokes:g}", {"particles": {"density": 0.1 * stokes / 0.045}}, 4) for stokes in (0.001, 0.01, 0.1, 1, 10)
    ],
    "Peclet number": [
        (
            f"Pe {pe:g}, phi {phi:g}",
            {**brownian(pe), "volume_fraction": phi},
            16 if phi < 0.5 else 32 if pe < 10 else 64,
        )
        for phi in (0.3, 0.5)
        for pe in (0.1, 1, 10, 100, 1e4)
    ],
    "Peclet number and friction": [
        (f"Pe {pe:g}, mu 1", merged(brownian(pe), friction(1)), seeds)
        for pe, seeds in ((1, 32), (10, 64), (100, 128), (1000, 64))
    ],
}
QUICK = {"stiffness and volume fraction": 4, "start-up": 2}
COLUMNS = "panel", "case", "method", "step", "timestep", "verdict", "bias_percent", "bias_half_width_percent"
COLUMNS += "flags", "causes", "seeds", "commit"
CAUSES_OF_JAMS = {"overlap", "packing"}


def further_of(scene):
    return FURTHER[scene["peclet"]] if "peclet" in scene and scene["contact"].get("friction") else {}


def finest_of(scene):
    """Returns method and factor of the reference. Without noise trajectories of one seed stay together for a while;
    explicit steps with noise make contacts too rare, and implicit ones too many, which friction feels."""
    if "peclet" not in scene:
        return "explicit", 0.5
    return "implicit", further_of(scene).get("implicit", (0.25,))[0]


def integrators(program, scene):
    """Yields the columns and further steps: method, factor, integrator block, and the answer if the step is refused,
    else None."""
    for method, factor_of_auto in (("explicit", 0.5), ("implicit", 1)):
        answer = program.derived(merged(scene, integrator={"method": method}))
        for factor in STEPS[method] + further_of(scene).get(method, ()):
            block = {"method": method, "timestep": factor * (answer["timestep"] / factor_of_auto)}
            refused = program.derived(merged(scene, integrator=block)).get("refused")
            yield method, factor, block, refused


# Smallest relative bias that counts, if it also exceeds chance in one of a thousand cells.
LEAST_BIAS = 0.03
RARE = 1 - 0.5e-3


def verdict_of(difference, values, causes):
    """Returns the verdict of a cell, from its difference to the reference, values by seed, and lost seeds by cause."""
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
    """Yields a row for each step, without verdict, with its `point`, `values` by seed and `lost` by cause."""
    label, _, seeds = case
    columns = list(integrators(program, scene))
    identifier = "".join(c if c.isalnum() or c in ".-" else "-" for c in f"{name} {label}")
    settings = [{"/integrator": block} for _, _, block, refused in columns if not refused]
    of_block = {}
    for point in program.run(identifier, scene, settings, seeds):
        block = point["settings"]["/integrator"]
        of_block[block["method"], block["timestep"]] = point
    for method, factor, block, refused in columns:
        point = Point(realisations=[]) if refused else of_block[method, block["timestep"]]
        lost = collections.Counter(r["ending"]["cause"] for r in point["realisations"] if not r.get("mean"))
        cell = {"panel": name, "case": label, "method": method, "step": factor, "timestep": block["timestep"]}
        cell |= {"seeds": len(point["realisations"]), "commit": " ".join(sorted(program.commits)), "point": point}
        yield cell | {"values": point.by_seed(), "lost": lost, "flags": counts_text(flags(point)), "refused": refused}


def rows_of(name, case, program):
    scene = merged(BASE, case[1])
    cells = list(cells_of(name, case, scene, program))
    noise = "peclet" in scene  # another step then has other noise
    reference = next(c for c in cells if (c["method"], c["step"]) == finest_of(scene))
    for cell in cells:
        if cell["step"] not in STEPS[cell["method"]]:
            continue
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


def measure(program, panels=PANELS, path=HERE / "table.csv"):
    rows = []
    for name, cases in panels.items():
        for case in cases:
            rows += rows_of(name, case, program)
            print(f"{name}: {case[0]}", file=sys.stderr, flush=True)
    write_table(path, COLUMNS, rows, digits=4)


def onset_rows(program):
    """Yields rows of all accepted steps at the onset of friction, with the median processor time of a seed."""
    name = "Peclet number and friction"
    case = next(c for c in PANELS[name] if c[1]["peclet"] == ONSET)
    for cell in cells_of(name, case, merged(BASE, case[1]), program):
        if not cell["refused"]:
            point = cell["point"]
            row = {key: cell[key] for key in ("method", "step", "seeds")}
            row |= entries("contacts", point.measured("contacts_per_particle"))
            row |= entries("viscosity", point.measured("relative_viscosity"))
            yield row | {"seconds": statistics.median(r["cost"]["cpu_seconds"] for r in point.results)}


def measure_all(program):
    measure(program)
    write_table(HERE / "onset.csv", "method, step, seeds, contacts±, viscosity±, seconds", onset_rows(program), 4)


def judge(path=HERE / "table.csv"):
    silent = [r for r in read_texts(path) if r["verdict"] == "biased" and not r["flags"]]
    for row in silent:
        print(f"wrong without a flag: {row['panel']}, {row['case']}, {row['method']} {row['step']}", file=sys.stderr)
    yield Check("cells that are biased, and none of whose results says so", "warnings", len(silent), 0, high=0)


COLOURS = {
    "ok": "#b8dcae",
    "undecided": "#e9efb4",
    "biased": "#e88a30",
    "losses": "#dcb0d8",
    "blown up": "#d06058",
    "jammed": "#8fb4dc",
    "refused": "#d9d9d9",
    "no reference": "#ffffff",
}
WIDTH, HEIGHT = 92, 22  # of a cell, in pixels
LABEL = 250  # width of the names of the cases, in pixels
LEGEND = (
    "!: flagged;  numbers: difference of the viscosity from the reference and half of its 95 % interval, in percent"
)


def text_of(row):
    verdict = row["verdict"]
    flag = " !" if row["flags"] else ""
    if verdict in ("ok", "biased", "undecided"):
        bias, half_width = float(row["bias_percent"]), float(row["bias_half_width_percent"])
        if bias == half_width == 0:
            return "reference" + flag
        digits = 1 if abs(bias) < 9.95 and half_width < 9.95 else 0
        return f"{bias:+.{digits}f}({half_width:.{digits}f})" + flag
    if verdict == "losses":
        return row["causes"].replace("displacement", "displ.").replace(":", " ") + flag
    if verdict in ("blown up", "jammed"):
        return row["causes"].split(":")[0].replace("displacement", "displ.") + flag
    return {"refused": "refused", "no reference": "?"}[verdict] + flag


def lines_of(rows):
    """Returns the lines of the map from the top: (panel, None), or (case, cells by method and step)."""
    lines = {}
    for row in rows:
        lines.setdefault((row["panel"], None), None)
        lines.setdefault((row["panel"], row["case"]), {})[row["method"], row["step"]] = row
    return [(case or panel, cells) for (panel, case), cells in lines.items()]


def halves(lines):
    """Returns the lines in two parts side by side, the second one beginning with a panel; in one part if they are
    few."""
    half = next((k for k in range(len(lines) // 2, len(lines)) if lines[k][1] is None), 0)
    return [lines[:half], lines[half:]] if len(lines) > 30 else [lines]


def draw_part(panel, left, columns, lines):
    for column, (method, step) in enumerate(columns):
        middle = left + LABEL + WIDTH * (column + 0.5)
        panel.text(method, middle, HEIGHT * 0.8, "center")
        panel.text(f"{float(step):.3g} x", middle, HEIGHT * 1.6, "center")
    for k, (name, cells) in enumerate(lines):
        top = HEIGHT * (k + 2.2)
        if cells is None:
            panel.text(name, left, top + HEIGHT / 2, weight="bold")
            continue
        panel.text(name, left + 14, top + HEIGHT / 2)
        for column, key in enumerate(columns):
            x = left + LABEL + WIDTH * column
            panel.box(x, x + WIDTH, top, top + HEIGHT, COLOURS[cells[key]["verdict"]], border="white")
            panel.text(text_of(cells[key]), x + WIDTH / 2, top + HEIGHT / 2, "center")


def draw_legend(panel, top):
    x = 10
    for verdict, colour in COLOURS.items():
        panel.box(x, x + 30, top, top + HEIGHT * 0.8, colour, border="#888888")
        panel.text(verdict, x + 36, top + HEIGHT * 0.4)
        x += 122
    panel.text(LEGEND, 10, top + HEIGHT * 1.5)


def draw(path=HERE / "table.csv"):
    rows, picture = read_texts(path), path.with_name("map.png")
    columns = list(dict.fromkeys((r["method"], r["step"]) for r in rows))
    parts = halves(lines_of(rows))
    width = LABEL + WIDTH * len(columns) + 20
    size = width * len(parts), HEIGHT * (max(map(len, parts)) + 5)
    figure = Figure(picture, columns=1, size=size)
    panel = figure.blank((0, size[0]), (size[1], 0), place=(0, 1, 0, 1))
    for k, part in enumerate(parts):
        draw_part(panel, k * width + 10, columns, part)
    draw_legend(panel, size[1] - HEIGHT * 2.2)
    figure.draw()


def quick_measure(program):
    """Runs six cases, and draws their map."""
    path = Path(program.folder) / "table.csv"
    measure(program, {name: PANELS[name][:count] for name, count in QUICK.items()}, path)
    draw(path)
    return judge(path)


main(HERE, TITLE, measure_all, quick_measure, judge, draw)
