"""Draws figures of studies with matplotlib as png: panels with axes, points with error bars, and curves."""
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib import ticker
from matplotlib.colors import LinearSegmentedColormap, to_hex
from peclet.drawing import mathtext, parts_of, set_ticks

from studies.tables import number

BLUE, GREEN, ORANGE, RED, PURPLE = "#2060b0", "#308030", "#d08020", "#c03028", "#8040a0"
BLACK, GREY, LIGHT_GREY = "#000000", "#a0a0a0", "#d8d8d8"
# Markers by number: matplotlib's marker, and True if it is filled.
MARKS = {1: ("+", True), 2: ("x", True), 4: ("s", False), 5: ("s", True), 6: ("o", False), 7: ("o", True)}
MARKS |= {8: ("^", False), 9: ("^", True), 10: ("v", False), 11: ("v", True), 12: ("D", False), 13: ("D", True)}
DASHES = {1: "-", 2: "--", 3: ":", 4: "-."}
POINTS, DPI = 10, 100  # size of the text [points]; dots per inch
STYLE = {"font.size": POINTS, "axes.labelsize": POINTS, "axes.titlesize": POINTS, "legend.fontsize": POINTS - 1}


def formatted(text):
    """Returns a text for matplotlib; _ and ^ begin sub- and superscripts, as in symbols of engines."""
    return mathtext(parts_of(str(text)))


def shade(position):
    """Returns the colour at a position in [0, 1] of a scale from dark blue to an orange that is legible on white."""
    return to_hex(matplotlib.colormaps["plasma"](0.8 * position))


class Panel:
    """A panel of a figure. Its content is drawn in the order of the calls.

    axes         matplotlib's Axes
    x, y, title  texts
    log          logarithmic axes: "", "x", "y" or "xy"
    powers       axes with powers of ten as numbers: "", "x", "y" or "xy"
    x_range, y_range    (from, to); None: from the data
    y_step       distance of the numbers on the y axis
    key          place of the legend, such as "top right", or its upper right corner (x, y) in [0, 1]; None: no legend
    grid         True: lines at the numbers
    """

    def __init__(
        self,
        axes,
        x="",
        y="",
        title="",
        *,
        log="",
        powers="",
        key="top right",
        x_range=(None, None),
        y_range=(None, None),
        y_step=None,
        grid=True,
    ):
        self.axes, self._key, self._powers = axes, key, powers
        axes.set(xlabel=formatted(x), ylabel=formatted(y), title=formatted(title))
        axes.set_xscale("log" if "x" in log else "linear")
        axes.set_yscale("log" if "y" in log else "linear")
        axes.set_axisbelow(True)
        axes.tick_params(which="both", direction="in", top=True, right=True)
        if grid:
            axes.grid(color=LIGHT_GREY, linewidth=0.6)
        self._ranges, self._step, self._titled = {"x": x_range, "y": y_range}, y_step, []
        self._words = {}

    def points(self, rows, title, colour, mark=7, size=1.0, joined=False, width=1.0):
        """Draws points from rows of (x, y), (x, y, half-width of the bar) or (x, y, lower end, upper end)."""
        columns = np.array(list(rows), float).T
        if not columns.size:
            return
        x, y, *bars = columns
        bars = bars[0] if len(bars) == 1 else np.array([y - bars[0], bars[1] - y]) if bars else None
        marker, filled = MARKS[mark]
        drawn = self.axes.errorbar(
            x,
            y,
            bars,
            fmt=marker + ("-" if joined else ""),
            color=colour,
            markerfacecolor=colour if filled else "white",
            markersize=5.5 * size,
            linewidth=width,
            capsize=2,
        )
        self._say(drawn, title)

    def rows(self, rows, x, name, title, colour, *how, **more):
        """Draws points from rows of a table: the number `name` with its standard error over the column x."""
        self.points([(row[x], *number(row, name)) for row in rows], title, colour, *how, **more)

    def _say(self, drawn, title):
        if title:
            self._titled.append((drawn, formatted(title)))

    def texts(self, rows, colour, above=1.0, size=POINTS):
        """Draws texts from rows of (x, y, text), `above` text heights above the point."""
        for x, y, text in rows:
            style = {"color": colour, "fontsize": size, "ha": "center", "va": "center"}
            shift = (0, 1.25 * size * above)
            self.axes.annotate(formatted(text), (x, y), shift, textcoords="offset points", **style)

    def words(self, axis, words):
        """Has words at 0, 1, 2 ... of the axis "x" or "y" in the place of numbers."""
        self._words[axis] = words

    def line(self, rows, title, colour=BLACK, dash=1, width=1.0):
        """Draws straight lines between rows of (x, y)."""
        x, y = np.array(list(rows), float).T
        (drawn,) = self.axes.plot(x, y, DASHES[dash], color=colour, linewidth=width)
        self._say(drawn, title)

    def band(self, rows, colour):
        """Shades the band of rows of (x, lower end, upper end)."""
        self.axes.fill_between(*np.array(list(rows), float).T, color=colour, alpha=0.15, linewidth=0)

    def curve(self, function, title, colour=BLACK, span=None, samples=600, **style):
        """Draws y = function(x) over `span`, by default the range of x."""
        spaced = np.geomspace if self.axes.get_xscale() == "log" else np.linspace
        places = spaced(*(span or self._ranges["x"]), samples)
        self.line([(x, function(x)) for x in places], title, colour, **style)

    def level(self, y, title=None, colour=BLACK, span=None, **style):
        """Draws a horizontal line over `span`, by default the range of x."""
        self.line([(x, y) for x in span or self._ranges["x"]], title, colour, **style)

    def upright(self, x, low=None, high=None):
        """Draws a dotted vertical line, by default over the whole height."""
        if low is None:
            self.axes.axvline(x, linestyle=":", color=BLACK, linewidth=1)
        else:
            self.axes.vlines(x, low, high, linestyles=":", color=BLACK, linewidth=1)

    def text(self, text, x, y, side="left", colour=BLACK, **style):
        """Draws a text whose `side` is at (x, y); `style` are matplotlib's properties."""
        self.axes.text(x, y, formatted(text), color=colour, **{"ha": side, "va": "center", **style})

    def box(self, left, right, bottom, top, colour, border=None):
        """Draws a filled rectangle behind everything else; as wide as the panel if `left` is None."""
        if left is None:
            self.axes.axhspan(bottom, top, color=colour, linewidth=0, zorder=0)
            return
        corner = (min(left, right), min(bottom, top))
        size = abs(right - left), abs(top - bottom)
        self.axes.add_patch(plt.Rectangle(corner, *size, facecolor=colour, edgecolor=border, zorder=0))

    def image(self, rows, colours, label=None):
        """Draws values on a regular grid, rows of (x, y, value); `colours` by value. `label` adds a colour scale."""
        x, y = (np.unique([row[k] for row in rows]) for k in (0, 1))
        values = np.full((len(y), len(x)), np.nan)
        for row in rows:
            values[np.searchsorted(y, row[1]), np.searchsorted(x, row[0])] = row[2]
        low, high = min(colours), max(colours)
        scale = LinearSegmentedColormap.from_list("", [((at - low) / (high - low), c) for at, c in colours.items()])
        drawn = self.axes.pcolormesh(x, y, values, cmap=scale, vmin=low, vmax=high, rasterized=True)
        self.axes.set_aspect("equal")
        if label:
            beside = self.axes.inset_axes((1.05, 0, 0.05, 1))
            self.axes.figure.colorbar(drawn, cax=beside, label=formatted(label))

    def finish(self):
        """Sets the ranges, the numbers at the axes, and the legend."""
        self.axes.set(xlim=self._ranges["x"], ylim=self._ranges["y"])
        for name, axis in (("x", self.axes.xaxis), ("y", self.axes.yaxis)):
            if name in self._words:
                axis.set_ticks(range(len(self._words[name])), self._words[name])
                axis.set_tick_params(which="both", length=0)
                continue
            ends = tuple(axis.get_view_interval())
            set_ticks(axis, axis.get_scale() == "log", ends)
            if name in self._powers:
                axis.set_major_locator(ticker.LogLocator())
                axis.set_major_formatter(ticker.LogFormatterMathtext())
        if self._step:
            self.axes.yaxis.set_major_locator(ticker.MultipleLocator(self._step))
        if self._key is None or not self._titled:
            return
        place = {"loc": "upper right", "bbox_to_anchor": self._key}
        if isinstance(self._key, str):
            place = {"loc": self._key.replace("top", "upper").replace("bottom", "lower")}
        self.axes.legend(*zip(*self._titled), frameon=False, **place)


class Figure:
    """A figure that is written to `path`: panels in rows of `columns`, in the order of the calls; size in pixels."""

    def __init__(self, path, columns, rows=1, size=(1100, 480)):
        self._path, self._rows, self._columns, self._panels = path, rows, columns, []
        plt.rcParams.update(STYLE)
        self._figure = plt.figure(figsize=(size[0] / DPI, size[1] / DPI), dpi=DPI)

    def panel(self, *labels, place=None, **settings):
        """Returns a Panel in the next cell, or at a place (left, right, bottom, top) in [0, 1]. Arguments as of Panel.

        Raises ValueError if all cells are taken.
        """
        if len(self._panels) == self._rows * self._columns and not place:
            raise ValueError(f"a figure of {len(self._panels)} panels has no room for another")
        if place:
            left, right, bottom, top = place
            axes = self._figure.add_axes((left, bottom, right - left, top - bottom))
        else:
            self._figure.set_layout_engine("constrained")
            axes = self._figure.add_subplot(self._rows, self._columns, len(self._panels) + 1)
        self._panels.append(Panel(axes, *labels, **settings))
        return self._panels[-1]

    def blank(self, x_range=(0, 1), y_range=(0, 1), place=None):
        """Returns a Panel without axes, for texts and boxes."""
        panel = self.panel(key=None, x_range=x_range, y_range=y_range, place=place)
        panel.axes.set_axis_off()
        return panel

    def draw(self):
        for panel in self._panels:
            panel.finish()
        self._figure.savefig(self._path, dpi=DPI, metadata={"Software": None})
        plt.close(self._figure)
