#!/usr/bin/python3
"""chart.py TABLE PICTURE [PANEL...]

Draws the table of this study with gnuplot: a panel for each case (or for those that are named), relative difference of the
viscosity from the reference over the processor time to a standard error of 2 %. Bars are 95 %; an arrow stands for what is beyond the panel. lammps.csv beside this script, where there is one, has points of LAMMPS.
"""
import csv
import os
import subprocess
import sys

COLUMNS = 4
RANGE = 6  # percent, of every panel
STYLES = {  # point type, colour
    "explicit": (5, "#c03028"),
    "implicit": (7, "#2060b0"),
    "implicit, tolerance 0.0001": (6, "#2060b0"),
    "LAMMPS": (9, "#308030"),
}


def style_of(row):
    return f"implicit, tolerance {row['tolerance']}" if row["tolerance"] == "0.0001" else row["method"]


def quoted(text):
    return '"' + text.replace('"', "") + '"'


def panel(name, rows):
    data = [r for r in rows if r["viscosity"] and float(r["seconds_to_2_percent"]) > 0]
    dropped = [f"{r['method']} {float(r['step']):.2g}" for r in rows if not r["viscosity"]]
    times = [float(r["seconds_to_2_percent"]) for r in data]
    yield f"set title {quoted(name + (' (no seed left: ' + ', '.join(dropped) + ')' if dropped else ''))} offset 0,-0.6"
    yield f"set xrange [{min(times) / 3:.3g}:{max(times) * 3:.3g}]"
    plots = []
    for style, (point, colour) in STYLES.items():
        chosen = [r for r in data if style_of(r) == style]
        if not chosen:
            continue
        block = f"$d{len(plots)}"
        yield f"{block} << EOD"
        for r in chosen:
            bias = float(r["bias_percent"] or 0)
            label = ("" if style == "LAMMPS" else f"{float(r['step']):.2g}") + (
                "!" if r["flags"] or r["lost"] not in ("", "0") else ""
            )
            if abs(bias) > RANGE:
                label += f" {'↑' if bias > 0 else '↓'} {bias:.0f} %"
            shown = max(-0.85 * RANGE, min(0.85 * RANGE, bias)) if abs(bias) > RANGE else bias
            yield f"{r['seconds_to_2_percent']} {shown} {float(r['bias_half_width_percent'] or 0)} {quoted(label)}"
        yield "EOD"
        plots.append(f"{block} using 1:2:3 with yerrorbars pt {point} ps 1.1 lc rgb '{colour}'")
        plots.append(f"{block} using 1:2:4 with labels offset 0,1 font ',10' tc rgb '{colour}'")
    yield "plot " + ", ".join(plots)


def script(rows, picture):
    names = list(dict.fromkeys(r["panel"] for r in rows))
    lines = -(-(len(names) + 1) // COLUMNS)
    width, height = COLUMNS * 380, lines * 310
    yield f"set terminal pngcairo size {width}, {height} font 'Sans,11'"
    yield f"set output {quoted(picture)}"
    yield (
        f"set multiplot layout {lines}, {COLUMNS} margins {70 / width}, {1 - 20 / width}, {60 / height}, {1 - 30 / height} "
        f"spacing {75 / width}, {95 / height}"
    )
    yield "set logscale x; set format x '%g'; set grid lc rgb '#d8d8d8'; set key off"
    yield f"set yrange [-{RANGE}:{RANGE}]; set ytics 2; set ylabel 'difference of η_r / %' offset 1.2; set xlabel 's of processor to a standard error of 2 %' offset 0,0.6"
    yield "set object 1 rectangle from graph 0, first -2 to graph 1, first 2 behind fc rgb '#eef4e8' fs solid noborder"
    for name in names:
        yield from panel(name, [r for r in rows if r["panel"] == name])
    # the legend has a place of its own
    yield "unset object 1; unset grid; unset xlabel; unset ylabel; unset tics; unset border; unset logscale x; unset title"
    yield "set xrange [0:1]; set yrange [0:1]"
    for k, (style, (point, colour)) in enumerate(STYLES.items()):
        y = 0.9 - 0.12 * k
        yield f"set label {10 + k} {quoted(style)} at 0.12, {y} left tc rgb '{colour}' point pt {point} ps 1.1 lc rgb '{colour}' offset 1.5, 0"
    yield (
        'set label 20 "numbers: explicit step over\\nthe largest stable one, implicit step\\nover the automatic one;\\n'
        '!: flagged or seeds lost;\\nbars: 95 %; band: 2 %" at 0.02, 0.36 left'
    )
    yield "plot -1 with lines lc rgb 'white'"


def main():
    table, picture, wanted = sys.argv[1], sys.argv[2], sys.argv[3:]
    rows = []
    for path in (table, os.path.join(os.path.dirname(os.path.abspath(__file__)), "lammps.csv")):
        if os.path.exists(path):
            with open(path, newline="") as f:
                rows += list(csv.DictReader(f))
    cases = {r["panel"] for r in rows if r["method"] != "LAMMPS"}
    rows = [r for r in rows if r["panel"] in (wanted or cases)]
    if wanted:
        rows.sort(key=lambda r: wanted.index(r["panel"]))
    subprocess.run(["gnuplot"], input="\n".join(script(rows, picture)) + "\n", text=True, check=True)


main()
