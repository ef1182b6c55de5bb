#!/usr/bin/python3
"""map.py TABLE PICTURE

Draws the table of the stability map with gnuplot: a row for each case, a column for each step of each method.
"""
import csv
import subprocess
import sys

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
CELL = 92, 22  # pixels
LABEL = 250


def quoted(text):
    return '"' + text.replace('"', "") + '"'


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


def main():
    with open(sys.argv[1], newline="") as f:
        rows = list(csv.DictReader(f))
    columns = list(dict.fromkeys((r["method"], r["step"]) for r in rows))
    lines = []  # panel or case, cells
    for panel in dict.fromkeys(r["panel"] for r in rows):
        lines.append((panel, None))
        for case in dict.fromkeys(r["case"] for r in rows if r["panel"] == panel):
            lines.append(
                (case, {(r["method"], r["step"]): r for r in rows if r["panel"] == panel and r["case"] == case})
            )
    # two halves side by side
    half = next(k for k in range(len(lines) // 2, len(lines)) if lines[k][1] is None) if len(lines) > 30 else len(lines)
    width = LABEL + CELL[0] * len(columns) + 20
    parts = [lines[:half], lines[half:]]
    parts = [p for p in parts if p]
    height = CELL[1] * (max(map(len, parts)) + 5)
    script = [
        f"set terminal pngcairo size {width * len(parts)}, {height} font 'Sans,10'",
        f"set output {quoted(sys.argv[2])}",
        f"set xrange [0:{width * len(parts)}]; set yrange [{height}:0]; unset tics; unset border; unset key",
        "set lmargin 0; set rmargin 0; set tmargin 0; set bmargin 0",
    ]

    def label(x, y, text, where="left", font="Sans,10"):
        script.append(f"set label {quoted(text)} at {x}, {y} {where} font '{font}' noenhanced front")

    number = 0
    for k, part in enumerate(parts):
        left = k * width + 10
        for column, (method, step) in enumerate(columns):
            x = left + LABEL + CELL[0] * (column + 0.5)
            label(x, CELL[1] * 0.8, method, "center")
            label(x, CELL[1] * 1.6, f"{float(step):.3g} x", "center")
        for line, (name, cells) in enumerate(part):
            y = CELL[1] * (line + 2.2)
            label(
                left + (0 if cells is None else 14), y + CELL[1] / 2, name, font="Sans,10" if cells else "Sans Bold,11"
            )
            for column, key in enumerate(columns if cells else ()):
                number += 1
                x = left + LABEL + CELL[0] * column
                script.append(
                    f"set object {number} rectangle from {x}, {y} to {x + CELL[0]}, {y + CELL[1]} fc rgb '{COLOURS[cells[key]['verdict']]}' fs solid border lc rgb 'white'"
                )
                label(x + CELL[0] / 2, y + CELL[1] / 2, text_of(cells[key]), "center")
    y = height - CELL[1] * 1.6
    x = 10
    for verdict, colour in COLOURS.items():
        number += 1
        script.append(
            f"set object {number} rectangle from {x}, {y} to {x + 30}, {y + CELL[1] * 0.8} fc rgb '{colour}' fs solid border lc rgb '#888888'"
        )
        label(x + 36, y + CELL[1] * 0.4, verdict)
        x += 105
    label(
        x + 15,
        y + CELL[1] * 0.4,
        "!: flagged;  numbers: difference of the viscosity from the reference and half of its 95 % interval, in percent",
    )
    script.append("plot -1 with lines lc rgb 'white'")
    subprocess.run(["gnuplot"], input="\n".join(script) + "\n", text=True, check=True)


main()
