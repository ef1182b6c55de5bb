#!/usr/bin/python3
"""map.py TABLE PICTURE

Draws the table of the stability map: a row for each case, a column for each step of each method.
"""
import csv
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from studies.figure import Figure

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
LABEL = 250  # of the names of the cases
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
    """From the top: the name of a panel and None, or that of a case and its cells by method and step."""
    lines = {}
    for row in rows:
        lines.setdefault((row["panel"], None), None)
        lines.setdefault((row["panel"], row["case"]), {})[row["method"], row["step"]] = row
    return [(case or panel, cells) for (panel, case), cells in lines.items()]


def halves(lines):
    """Two parts that stand side by side, the second one beginning with a panel; one part if there is little."""
    if len(lines) <= 30:
        return [lines]
    half = next(k for k in range(len(lines) // 2, len(lines)) if lines[k][1] is None)
    return [lines[:half], lines[half:]]


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
        x += 105
    panel.text(LEGEND, x + 15, top + HEIGHT * 0.4)


def main():
    with open(sys.argv[1], newline="") as f:
        rows = list(csv.DictReader(f))
    columns = list(dict.fromkeys((r["method"], r["step"]) for r in rows))
    parts = halves(lines_of(rows))
    width = LABEL + WIDTH * len(columns) + 20
    size = width * len(parts), HEIGHT * (max(map(len, parts)) + 5)
    figure = Figure(sys.argv[2], columns=1, size=size)
    panel = figure.blank((0, size[0]), (size[1], 0), place=(0, 1, 0, 1))
    for k, part in enumerate(parts):
        draw_part(panel, k * width + 10, columns, part)
    draw_legend(panel, size[1] - HEIGHT * 1.6)
    figure.draw()


main()
