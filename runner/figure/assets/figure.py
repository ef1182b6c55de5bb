#!/usr/bin/env python3
"""Draws a figure of a campaign of peclet again: python3 THIS.py [FILE.pdf | FILE.png | FILE.svg]

Its numbers are below, as `peclet export` has them. Without a file the figure is shown. `peclet plot` replaces this
script only while it is as peclet wrote it.
"""
import json
import os
import shlex
import sys

try:
    import matplotlib
    import matplotlib.pyplot as plt
except ImportError as missing:
    # By whose python3 this is: conda's, Debian's, or another one (pyenv, venv), which pip serves.
    cure = f"{shlex.quote(sys.executable)} -m pip install matplotlib"
    if os.path.exists(os.path.join(sys.prefix, "conda-meta")):
        cure = "conda install matplotlib"
    elif sys.prefix == "/usr" and os.path.exists("/etc/debian_version"):
        cure = "apt install python3-matplotlib"
    sys.exit(f"{sys.executable} cannot import matplotlib ({missing}); install it with {cure}")

FIGURE = json.loads(r"""@FIGURE@""")
COLOURS = ["#0072b2", "#c44e00", "#00805c", "#a8487f", "#b07700", "#3a8fc0", "#6b6b00", "#1b1b1b"]
MARKERS = ["o", "s", "D", "^", "v", "P", "H"]
STYLE = {
    "font.family": "sans-serif",
    "font.sans-serif": ["Helvetica", "Arial", "Liberation Sans", "DejaVu Sans"],
    "font.size": 9,
    "axes.labelsize": 10,
    "xtick.direction": "in",
    "ytick.direction": "in",
    "xtick.top": True,
    "ytick.right": True,
    "savefig.dpi": 200,
    "svg.hashsalt": "peclet",
}


def columns_of(curve):
    """Lists by name of what has not jammed, and for each mark whether it has converged."""
    marks = [mark for mark in curve["marks"] if mark[-1] is None]
    columns = {name: [mark[k] for mark in marks] for k, name in enumerate(FIGURE["columns"])}
    return columns, [standing == "converged" for standing in columns["standing"]]


def draw_bars(axes, curve, colour):
    """Intervals; those of points that are still open are dashed."""
    columns, _ = columns_of(curve)
    for provisional in (False, True):
        rows = [
            row
            for row in zip(columns["x"], columns["mean"], columns["half_width"], columns["standing"])
            if row[2] is not None and (row[3] == "provisional") == provisional
        ]
        if rows:
            x, mean, half, _ = zip(*rows)
            bars = axes.errorbar(x, mean, half, fmt="none", ecolor=colour, elinewidth=1, capsize=2.5, zorder=2)
            if provisional:
                bars[2][0].set_linestyle((0, (3, 2)))


def draw_jams(axes, curve, colour):
    """Points that have jammed: at their number, or at the edge of the frame where they have none."""
    for mark in curve["marks"]:
        row = dict(zip(FIGURE["columns"], mark))
        if row["jammed"] is None:
            continue
        here = row["jammed"] == "at its number"
        height = row["mean"] if here else float(row["jammed"] == "upper edge")
        if here and row["half_width"] is not None:
            axes.errorbar(row["x"], height, row["half_width"], fmt="none", ecolor=colour, elinewidth=1, capsize=2.5)
        scale_of = axes.transData if here else axes.get_xaxis_transform()
        axes.plot(row["x"], height, "x", color=colour, markersize=6, transform=scale_of, clip_on=False, zorder=3)


def draw_curve(axes, curve, place):
    colour, marker = COLOURS[place % len(COLOURS)], MARKERS[place % len(MARKERS)]
    columns, converged = columns_of(curve)
    x, mean, allowed = columns["x"], columns["mean"], columns["good_enough"]
    if FIGURE["tolerance"]:
        rows = [(at, y - half, y + half) for at, y, half in zip(x, mean, allowed) if half is not None]
        if rows:
            axes.fill_between(*zip(*rows), color=colour, alpha=0.16, linewidth=0)
    axes.plot(x, mean, color=colour, linewidth=0.8, alpha=0.6)
    draw_bars(axes, curve, colour)
    for full in (True, False):
        rows = [(at, y) for at, y, whole in zip(x, mean, converged) if whole == full]
        if rows:
            axes.plot(*zip(*rows), marker, color=colour, markersize=5, markerfacecolor=colour if full else "white")
    draw_jams(axes, curve, colour)
    if curve["name"]:
        axes.plot([], [], marker, color=colour, markersize=5, label=curve["name"])


def draw_legend(axes):
    marks = [dict(zip(FIGURE["columns"], row)) for curve in FIGURE["curves"] for row in curve["marks"]]
    standings = {row["standing"] for row in marks if row["jammed"] is None}
    hollow = {"color": COLOURS[0], "marker": MARKERS[0], "markersize": 5, "markerfacecolor": "white"}
    if "undecided" in standings:
        axes.plot([], [], linestyle="none", label="not converged", **hollow)
    if "provisional" in standings:
        axes.plot([], [], linestyle=(0, (3, 2)), linewidth=1, label="provisional", **hollow)
    if any(row["jammed"] for row in marks):
        axes.plot([], [], "x", color=COLOURS[0], markersize=6, label="jammed")
    if FIGURE["tolerance"]:
        axes.fill_between([], [], [], color=COLOURS[0], alpha=0.16, linewidth=0, label="tolerance")
    if axes.get_legend_handles_labels()[1]:
        beside = FIGURE["legend"] == "beside"
        place = {"loc": "upper left", "bbox_to_anchor": (1, 1.02)} if beside else {"loc": FIGURE["legend"]}
        axes.legend(frameon=False, **place)


def scale(axes, name):
    """Scale, limits and ticks of one axis, as the picture of peclet itself has them."""
    wanted = FIGURE[name]
    getattr(axes, f"set_{name}scale")("log" if wanted["log"] else "linear")
    getattr(axes, f"set_{name}lim")(*wanted["limits"])
    places, texts = zip(*wanted["ticks"])
    getattr(axes, f"set_{name}ticks")(places, texts)
    getattr(axes, f"set_{name}ticks")(wanted["minor_ticks"], [""] * len(wanted["minor_ticks"]), minor=True)
    getattr(axes, f"set_{name}label")(wanted["title"])


def draw():
    plt.rcParams.update(STYLE)
    width = 6.1 if FIGURE["legend"] == "beside" else 4.9
    drawing, axes = plt.subplots(figsize=(width, 3.4), layout="constrained")
    for place, curve in enumerate(FIGURE["curves"]):
        draw_curve(axes, curve, place)
    scale(axes, "x")
    scale(axes, "y")
    draw_legend(axes)
    return drawing, axes


def main():
    drawing, _ = draw()
    if len(sys.argv) < 2:
        plt.show()
        return
    # Without the time of day, so that the same numbers give the same bytes.
    dates = {"pdf": {"CreationDate": None}, "svg": {"Date": None}}
    drawing.savefig(sys.argv[1], metadata=dates.get(sys.argv[1].rpartition(".")[2]))


if __name__ == "__main__":
    if len(sys.argv) > 1:
        matplotlib.use("Agg")
    main()
