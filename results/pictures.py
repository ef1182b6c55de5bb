#!/usr/bin/python3
"""pictures.py [NAME ...]: draws chart.png of the studies without a study.py from the tables of their pages."""
import re
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
from studies.figure import BLACK, BLUE, GREEN, ORANGE, RED, Figure
from studies.published import mari_fit


def page_table(name, column):
    """Returns the rows of the first table of a study's page that has this column, as texts by column."""
    lines = iter((HERE / name / "README.md").read_text().splitlines())
    cells = [word.strip() for word in next(line for line in lines if f"| {column} |" in line).strip("|").split("|")]
    next(lines)
    rows = []
    for line in lines:
        if not line.startswith("|"):
            break
        rows.append(dict(zip(cells, (word.strip() for word in line.strip("|").split("|")))))
    return rows


def numbers(text):
    """Returns the numbers of a cell: "0.98 ± 0.01", "94.2 .. 95.9"."""
    return [float(number) for number in re.findall(r"[-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?", text)]


def draw_ranges(figure, rows, x, level, colours=()):
    """Draws a panel with one row for each (name, low, high), from above, and a line at `level`."""
    panel = figure.panel(x, key=None, y_range=(len(rows) - 0.4, -0.6))
    for place, (_, low, high) in enumerate(rows):
        colour = colours[place] if colours else BLUE
        panel.line([(low, place), (high, place)], None, colour, width=3)
        panel.points([(low, place), (high, place)], None, colour, size=0.7)
    panel.axes.axvline(level, color=BLACK, linewidth=1, linestyle="--")
    panel.words("y", [name for name, *_ in rows])
    return panel


def ends(text):
    """Returns the ends of a range, which are equal for one number."""
    found = numbers(text)
    return found[0], found[-1]


def coverage(path):
    rows = [
        (f"{row['population']}, {row['minimum']}, {row['workers']}", *ends(row["intervals hold the mean, %"]))
        for row in page_table("coverage", "intervals hold the mean, %")
    ]
    figure = Figure(path, columns=1, size=(1000, 480))
    colours = [ORANGE if name.startswith("lognormal") else BLUE for name, *_ in rows]
    draw_ranges(figure, rows, "intervals that hold the mean [%] (population, minimum of seeds, workers)", 95, colours)
    figure.draw()


def curves(path):
    table = [row for row in page_table("curves", "bands hold, %") if numbers(row["bands hold, %"])]
    rows = [(f"{row['curve']}, {row['spread of a seed']}", *ends(row["bands hold, %"])) for row in table]
    colours = [BLUE if row["curve"].startswith(("flow", "constant", "power")) else ORANGE for row in table]
    figure = Figure(path, columns=1, size=(1000, 620))
    draw_ranges(figure, rows, "points whose band holds the truth [%] (curve, spread of a seed)", 95, colours)
    figure.draw()


def planning(path):
    rows = [
        (f"{row['population'].split(', coefficient')[0]}, pilot {row['pilot']}", *ends(row["within the range, %"]))
        for row in page_table("planning", "within the range, %")
    ]
    figure = Figure(path, columns=1, size=(1000, 360))
    draw_ranges(figure, rows, "predicted ranges that hold the number of seeds that was needed [%]", 95)
    figure.draw()


def lammps_brownian(path):
    figure = Figure(path, columns=2, size=(1000, 360))
    labels = "step Δt 2X_A/m", "pressure at rest [kT/a³]"
    panel = figure.panel(*labels, x_range=(0, 0.6), y_range=(0.27, 0.29), key="top left")
    panel.level(0.2764, "equation of state")
    rows = page_table("lammps-brownian", "pressure, kT/a³")
    step, pressure = ([float(row[name]) for row in rows] for name in ("Δt 2X_A/m", "pressure, kT/a³"))
    panel.points([(x, y, 0.002) for x, y in zip(step, pressure)], "LAMMPS", RED)
    panel = figure.panel("", "η_r at Pe = 10", x_range=(-0.5, 1.5), y_range=(2.2, 2.3), key=None)
    rows = page_table("lammps-brownian", "η_r")
    for place, (row, colour) in enumerate(zip(rows, (RED, BLUE))):
        panel.points([(place, *numbers(row["η_r"]))], None, colour)
    panel.words("x", ["LAMMPS", "peclet"])
    figure.draw()


def lammps_ensemble(path):
    figure = Figure(path, columns=1, size=(800, 380))
    labels = "rate λγ̇", "over the exact answer"
    panel = figure.panel(*labels, log="x", x_range=(0.07, 5), y_range=(0.6, 1.15), key="bottom right")
    panel.level(1, "exact")
    for name, colour, shift in (("viscosity", BLUE, 1), ("normal stress", RED, 1.05)):
        rows = page_table("lammps-ensemble", name)
        panel.points([(float(row["rate λ"]) * shift, *numbers(row[name])) for row in rows], name, colour)
    figure.draw()


def packings(path):
    figure = Figure(path, columns=1, size=(800, 360))
    panel = figure.panel("volume fraction φ", "seeds of 20 that packed", y_range=(-1, 21), key="bottom left")
    for name, colour, mark in (("N = 1000", BLUE, 7), ("N = 200", RED, 6)):
        rows = page_table("packings", name)
        shift = 0.0005 if name == "N = 200" else -0.0005
        panel.points([(float(row["φ"]) + shift, float(row[name])) for row in rows], name, colour, mark)
    figure.draw()


def published_viscosity(path):
    figure = Figure(path, columns=1, size=(800, 400))
    labels = "volume fraction φ", "relative viscosity η_r"
    panel = figure.panel(*labels, log="y", x_range=(0.38, 0.57), y_range=(5, 50), key="top left")
    rows = page_table("published-viscosity", "Mari fit")
    for friction, colour in ((0, BLUE), (1, RED)):
        panel.curve(lambda phi, mu=friction: mari_fit(phi, mu), f"published fit, μ = {friction}", colour, (0.38, 0.56))
        own = [row for row in rows if row["μ"] == str(friction)]
        points = [(float(row["φ"]), *numbers(row["η_r"])) for row in own]
        panel.points(points, f"here, μ = {friction}", colour)
    figure.draw()


def timestep_gate(path):
    figure = Figure(path, columns=1, size=(900, 420))
    labels = "share: step over the largest stable one", "mean change of η_r [%], 0.005 if less"
    panel = figure.panel(*labels, log="y", y_range=(3e-3, 100), key="top left")
    rows = [row for row in page_table("timestep-gate", "η_r differs by, %") if numbers(row["η_r differs by, %"])]
    last = "gate, apart from the scene's bound"
    kinds = {"every window passes": GREEN, "some pass": ORANGE, "none passes": RED}
    for (title, colour), is_one in zip(
        kinds.items(),
        (
            lambda text: re.fullmatch(r"\d+ passed", text),
            lambda text: "passed" in text and not re.fullmatch(r"\d+ passed", text),
            lambda text: "passed" not in text,
        ),
    ):
        own = [row for row in rows if is_one(row[last])]
        places = [(float(row["share"]), max(abs(numbers(row["η_r differs by, %"])[0]), 0.005)) for row in own]
        panel.points(places, title, colour)
    panel.level(3, "3 %, asked for", BLACK, panel.axes.get_xlim(), dash=2)
    panel.line([(1, 3e-3), (1, 100)], "share of 1: the gate", GREEN, dash=2)
    figure.draw()


def transient(path):
    figure = Figure(path, columns=1, size=(800, 360))
    labels = "Péclet number Pe", "relative viscosity η_r"
    panel = figure.panel(*labels, log="x", x_range=(5, 2000), key="top left")
    rows = page_table("transient", "early")
    marked = [row["verdict of early"].endswith("transient") for row in rows]
    cases = (
        ("early", "after 0.1 (strain or Brownian times)", RED, False, 7),
        ("early", "after 0.1, marked transient", RED, True, 6),
        ("late", "after 2", BLUE, False, 7),
    )
    for name, title, colour, transient_ones, mark in cases:
        own = [row for row, is_marked in zip(rows, marked) if name == "late" or is_marked == transient_ones]
        panel.points([(float(row["Pe"]), *numbers(row[name])) for row in own], title, colour, mark)
    figure.draw()


DRAWN = (
    coverage,
    curves,
    lammps_brownian,
    lammps_ensemble,
    packings,
    planning,
    published_viscosity,
    timestep_gate,
    transient,
)


def main():
    wanted = sys.argv[1:]
    for draw in DRAWN:
        name = draw.__name__.replace("_", "-")
        if not wanted or name in wanted:
            draw(HERE / name / "chart.png")


if __name__ == "__main__":
    main()
