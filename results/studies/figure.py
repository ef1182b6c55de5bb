"""Pictures: panels with axes, points with error bars, and curves, drawn by gnuplot into a png."""
import math
import subprocess

import numpy as np

BLUE, GREEN, ORANGE, RED, PURPLE = "#2060b0", "#308030", "#d08020", "#c03028", "#8040a0"
BLACK, GREY, LIGHT_GREY = "#000000", "#a0a0a0", "#d8d8d8"


def quoted(text):
    """A text of gnuplot. Its marks stay in force: _ and ^ lower and raise what follows, \\n begins a line."""
    return '"' + str(text).replace('"', "'") + '"'


def cell(value):
    """A number of a data block, or a text; NaN where a number is missing."""
    if isinstance(value, str):
        return quoted(value)
    return f"{value:.7g}" if math.isfinite(value) else "NaN"


def shade(colours, position):
    """The colour at this position, from 0 to 1, of a scale through equally distant colours."""
    scale = np.array([[int(c[k : k + 2], 16) for k in (1, 3, 5)] for c in colours])
    places = np.linspace(0, 1, len(scale))
    return "#" + "".join(f"{round(np.interp(position, places, channel)):02x}" for channel in scale.T)


class Panel:
    """Axes and what is drawn between them, in this order.

    log          axes that are logarithmic: "", "x", "y" or "xy"
    powers       axes whose numbers are powers of ten
    x_range, y_range    (from, to), each None where the data decide
    x_ticks, y_ticks    where numbers stand; x_step, y_step    how far apart
    key          place of the titles, as gnuplot has it; None for none
    place        of the axes in the picture: left, right, bottom, top, from 0 to 1; in the next cell unless given
    settings     what else gnuplot has to be told
    """

    def __init__(self, x="", y="", title="", *, log="", powers="", key="top right", place=None, settings=(), **axes):
        self._lines = [
            "reset",
            "set format '%g'",
            f"set grid lc rgb '{LIGHT_GREY}'",
            f"set key {key}" if key else "set key off",
        ]
        self._lines += [f"set xlabel {quoted(x)}", f"set ylabel {quoted(y)}", f"set title {quoted(title)}"]
        if log:
            self._lines.append(f"set logscale {log}")
        self._lines += [f"set format {axis} '10^{{%L}}'" for axis in powers]
        if place:
            sides = zip(("lmargin", "rmargin", "bmargin", "tmargin"), place)
            self._lines += [f"set {side} at screen {at}" for side, at in sides]
        self._log, self._x_range = log, axes.get("x_range")
        for name, values in axes.items():
            axis, what = name.split("_")
            if what == "range":
                ends = ["*" if v is None else f"{v:.7g}" for v in values]
                self._lines.append(f"set {axis}range [{':'.join(ends)}]")
            elif what == "ticks":
                self._lines.append(f"set {axis}tics ({', '.join(f'{v:g}' for v in values)})")
            elif what == "step":
                self._lines.append(f"set {axis}tics {values:g}")
            else:
                raise TypeError(f"no setting of an axis: {name}")
        self._lines += settings
        self._blocks, self._plots = [], []

    def _plot(self, rows, how, title):
        """Adds rows of numbers, drawn in this way."""
        self._blocks.append([" ".join(cell(v) for v in row) for row in rows])
        name = f"${{block}}{len(self._blocks) - 1}"
        self._plots.append(f"{name} using {how} {f'title {quoted(title)}' if title else 'notitle'}")

    def points(self, rows, title, colour, mark=7, size=1.0, joined=False, width=1.0):
        """Rows of (x, y), (x, y, half a bar) or (x, y, lower end, upper end of a bar)."""
        rows = list(rows)
        columns = len(rows[0]) if rows else 2
        if columns == 2:
            style = "linespoints" if joined else "points"
        else:
            style = "yerrorlines" if joined else "yerrorbars"
        using = ":".join(str(k + 1) for k in range(columns))
        self._plot(rows, f"{using} with {style} pt {mark} ps {size:g} lw {width:g} lc rgb '{colour}'", title)

    def texts(self, rows, colour, above=1.0, size=10):
        """Rows of (x, y, text): the text stands so many of its heights above the point."""
        self._plot(rows, f"1:2:3 with labels offset 0,{above:g} font ',{size}' tc rgb '{colour}'", None)

    def line(self, rows, title, colour=BLACK, dash=1, width=1.0):
        """Straight pieces between (x, y)."""
        self._plot(rows, f"1:2 with lines dt {dash} lw {width:g} lc rgb '{colour}'", title)

    def curve(self, function, title, colour=BLACK, span=None, samples=600, **style):
        """y = function(x), from one end of `span` to the other; of the range of x unless it is given."""
        spaced = np.geomspace if "x" in self._log else np.linspace
        self.line([(x, function(x)) for x in spaced(*(span or self._x_range), samples)], title, colour, **style)

    def level(self, y, title=None, colour=BLACK, span=None, **style):
        """A horizontal line."""
        self.line([(x, y) for x in span or self._x_range], title, colour, **style)

    def upright(self, x, low=None, high=None):
        """A dotted vertical line, over the whole height unless its ends are given."""
        ends = ["graph 0" if low is None else f"{low:g}", "graph 1" if high is None else f"{high:g}"]
        self._lines.append(f"set arrow from {x:g}, {ends[0]} to {x:g}, {ends[1]} nohead dt 3")

    def text(self, text, x, y, side="left", style=""):
        """A text with this side at a place."""
        self._lines.append(f"set label {quoted(text)} at {x:g}, {y:g} {side} {style}".rstrip())

    def box(self, left, right, bottom, top, colour, border=None):
        """A filled rectangle behind all else; ends are numbers or, as gnuplot has it, places like "graph 0"."""
        edge = f"border lc rgb '{border}'" if border else "noborder"
        self._lines.append(
            f"set object rectangle from {left}, {bottom} to {right}, {top} behind fc rgb '{colour}' fs solid {edge}"
        )

    def image(self, rows, colours, label=None):
        """Rows of (x, y, value), line after line of a regular grid, in colours by value; `label` for a scale beside
        it."""
        scale = ", ".join(f"{value:g} '{colour}'" for value, colour in colours.items())
        self._lines.append(f"set palette defined ({scale}); set cbrange [{min(colours):g}:{max(colours):g}]")
        self._lines.append(f"set colorbox; set cblabel {quoted(label)}" if label else "unset colorbox")
        self._plot(rows, "1:2:3 with image", None)

    def script(self, block):
        """Lines for gnuplot; names of data begin with `block`."""
        yield from self._lines
        for k, rows in enumerate(self._blocks):
            yield f"${block}{k} << EOD"
            yield from rows
            yield "EOD"
        plots = [plot.replace("{block}", block, 1) for plot in self._plots]
        # Without data there is nothing that gnuplot could find the ends of the axes by.
        yield "plot " + (", ".join(plots) or "NaN notitle")


class Figure:
    """Panels in rows of `columns`, in the order in which they are asked for; size in pixels."""

    def __init__(self, path, columns, rows=1, size=(1100, 480), layout="", font="Sans,11"):
        self._head = [
            f"set terminal pngcairo size {size[0]}, {size[1]} font '{font}'",
            f"set output {quoted(path)}",
            f"set multiplot layout {rows}, {columns} {layout}".rstrip(),
        ]
        self._room, self._panels = rows * columns, []

    def panel(self, *labels, **settings):
        if len(self._panels) == self._room:
            raise ValueError(f"a figure of {self._room} panels has no room for another")
        self._panels.append(Panel(*labels, **settings))
        return self._panels[-1]

    def blank(self, x_range=(0, 1), y_range=(0, 1), place=None):
        """A panel without axes, for texts and boxes."""
        bare = ["unset grid", "unset tics", "unset border"]
        return self.panel(key=None, x_range=x_range, y_range=y_range, place=place, settings=bare)

    def script(self):
        yield from self._head
        for k, panel in enumerate(self._panels):
            yield from panel.script(f"panel{k}_")

    def draw(self):
        subprocess.run(["gnuplot"], input="\n".join(self.script()) + "\n", text=True, check=True)
