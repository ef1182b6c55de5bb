#!/usr/bin/python3
"""chart.py TABLE PICTURE [PANEL...]

Draws the table of this study: a panel for each case (or for those that are named), relative difference of the viscosity
from the reference over the processor time to a standard error of 2 %, and the same of the pressure where it is known.
Bars are 95 %; an arrow stands for what is beyond the panel. lammps.csv beside this script, where there is one, has
points of LAMMPS.
"""
import csv
import math
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from studies.figure import BLUE, GREEN, RED, Figure

COLUMNS = 4
RANGE = 6  # percent, of every panel
TEXT = 0.06, 1.0  # width over that of a panel, height in percent
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
    """Place of a point, half of its bar, and what is written above it."""
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
    """How many rows higher than above its point each text must stand to cover none before it."""
    taken, rows = [], []
    for x, y, *_ in bars:
        place, row = math.log(x, span), 0
        while any(abs(place - p) < TEXT[0] and abs(y + row * TEXT[1] - q) < 0.8 * TEXT[1] for p, q in taken):
            row += 1
        taken.append((place, y + row * TEXT[1]))
        rows.append(row)
    return rows


def add_panel(figure, name, rows, of=""):
    """`of`: nothing for the viscosity, or "pressure_"."""
    chosen = [r for r in rows if r["viscosity"] and float(r["seconds_to_2_percent"]) > 0]
    if of:
        chosen = [r for r in chosen if r.get("pressure")]
    dropped = [f"{r['method']} {float(r['step']):.2g}" for r in rows if not r["viscosity"]]
    title = f"{name} (no seed left: {', '.join(dropped)})" if dropped else name
    times = [float(r["seconds_to_2_percent"]) for r in chosen]
    panel = figure.panel(
        "s of processor to a standard error of 2 %",
        "difference of P / %" if of else "difference of η_r / %",
        title,
        log="x",
        key=None,
        x_range=(min(times) / 3, max(times) * 3),
        y_range=(-RANGE, RANGE),
        y_step=2,
    )
    panel.box(None, None, -2, 2, "#eef4e8")
    bars = sorted((*bar_of(r, of), style_of(r)) for r in chosen)
    for (x, y, half, text, style), row in zip(bars, rows_of_texts(bars, 9 * max(times) / min(times))):
        mark, colour = STYLES[style]
        panel.points([(x, y, half)], None, colour, mark, 1.1)
        panel.texts([(x, y, text)], colour, above=1 + row)


def add_legend(figure):
    """In a place of its own."""
    panel = figure.blank()
    for k, (style, (mark, colour)) in enumerate(STYLES.items()):
        panel.points([(0.06, 0.9 - 0.12 * k)], None, colour, mark, 1.1)
        panel.text(style, 0.12, 0.9 - 0.12 * k, colour=colour)
    panel.text(LEGEND, 0.02, 0.4, va="top")


def draw(rows, picture):
    names = list(dict.fromkeys(r["panel"] for r in rows))
    with_pressure = [name for name in names if any(r["panel"] == name and r.get("pressure") for r in rows)]
    lines = -(-(len(names) + len(with_pressure) + 1) // COLUMNS)
    figure = Figure(picture, COLUMNS, lines, (COLUMNS * 380, lines * 310))
    for name in names:
        add_panel(figure, name, [r for r in rows if r["panel"] == name])
    for name in with_pressure:
        add_panel(figure, name, [r for r in rows if r["panel"] == name], "pressure_")
    add_legend(figure)
    figure.draw()


def main():
    table, picture, wanted = sys.argv[1], sys.argv[2], sys.argv[3:]
    rows = []
    for path in (Path(table), HERE / "lammps.csv"):
        if path.exists():
            with open(path, newline="") as f:
                rows += list(csv.DictReader(f))
    cases = {r["panel"] for r in rows if r["method"] != "LAMMPS"}
    rows = [r for r in rows if r["panel"] in (wanted or cases)]
    if wanted:
        rows.sort(key=lambda r: wanted.index(r["panel"]))
    draw(rows, picture)


main()
