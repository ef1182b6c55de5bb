#!/usr/bin/python3
"""What the pictures of studies are drawn from, and that gnuplot draws it."""
import math
import os
import struct
import sys
import tempfile
import unittest

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.path.insert(0, os.path.join(ROOT, "results"))
from studies.figure import BLUE, RED, Figure, Panel, cell, quoted, shade


def data_of(panel):
    """The first data block and the plot command."""
    lines = [*panel.script("d")]
    return lines[lines.index("$d0 << EOD") + 1 : lines.index("EOD")], lines[-1]


class Script(unittest.TestCase):
    def test_missing_numbers_are_not_a_number(self):
        self.assertEqual([cell(v) for v in (1.5, math.nan, math.inf, "a")], ["1.5", "NaN", "NaN", '"a"'])

    def test_quotes_end_no_text(self):
        self.assertEqual(quoted('a "b"'), "\"a 'b'\"")

    def test_points_have_the_bars_that_their_columns_say(self):
        for row, using in (
            ((1, 2), "1:2 with points"),
            ((1, 2, 3), "1:2:3 with yerrorbars"),
            ((1, 2, 0, 4), "1:2:3:4 with yerrorbars"),
        ):
            panel = Panel()
            panel.points([row], "title", RED)
            data, plot = data_of(panel)
            self.assertEqual(data, [" ".join(map(str, row))])
            self.assertIn(f"$d0 using {using} pt 7", plot)
            self.assertIn('title "title"', plot)

    def test_a_curve_reaches_from_end_to_end_in_steps_of_the_axis(self):
        for log, middle in (("", 50.5), ("x", 10)):
            panel = Panel(log=log, x_range=(1, 100))
            panel.curve(lambda x: 2 * x, None, samples=3)
            data, plot = data_of(panel)
            rows = [[float(v) for v in line.split()] for line in data]
            self.assertEqual(rows, [[1, 2], [middle, 2 * middle], [100, 200]])
            self.assertTrue(plot.endswith("notitle"))

    def test_axes_are_set_anew_in_every_panel(self):
        figure = Figure("unused.png", columns=2)
        figure.panel("Pe", log="xy", powers="x", x_range=(0.1, None)).level(1, span=(1, 2))
        figure.panel("phi").level(1, span=(1, 2))
        lines = [*figure.script()]
        second = lines[lines.index("reset", lines.index("reset") + 1) :]
        self.assertIn("set logscale xy", lines)
        self.assertIn("set xrange [0.1:*]", lines)
        self.assertFalse([line for line in second if "logscale" in line or "xrange" in line])

    def test_panels_never_lie_on_each_other(self):
        figure = Figure("unused.png", columns=2, rows=1)
        figure.panel("Pe")
        figure.panel("phi")
        with self.assertRaises(ValueError):
            figure.panel("mu")

    def test_a_misspelt_setting_is_no_setting(self):
        with self.assertRaises(TypeError):
            Panel(x_rang=(0, 1))

    def test_shades_lie_between_their_colours(self):
        self.assertEqual(shade(("#000000", "#ff8000"), 0), "#000000")
        self.assertEqual(shade(("#000000", "#ff8000", "#000000"), 0.5), "#ff8000")
        self.assertEqual(shade(("#000000", "#646464"), 0.5), "#323232")


class Picture(unittest.TestCase):
    def test_is_a_png_of_the_size_that_was_asked_for(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "it's a picture.png")
            figure = Figure(path, columns=3, size=(900, 300))
            panel = figure.panel("x", "y", "title", log="xy", powers="xy", x_range=(1, 10), y_ticks=(1, 5))
            panel.points([(1, 2, 0.5), (2, 3, math.nan)], "points", BLUE, joined=True)
            panel.curve(lambda x: x**2, "curve", RED, dash=2, width=2)
            panel.upright(3)
            panel.text("text", 2, 2, "right")
            figure.panel(x_range=(0, 2), y_range=(0, 2)).image(
                [(x, y, x + y) for y in (0, 1, 2) for x in (0, 1, 2)], {0: "#ffffff", 4: "#000000"}, "scale"
            )
            figure.blank().box(0, 1, 0, 1, "#ff0000", border="white")
            figure.draw()
            with open(path, "rb") as f:
                head = f.read(24)
        self.assertEqual(head[:8], b"\x89PNG\r\n\x1a\n")
        self.assertEqual(struct.unpack(">II", head[16:24]), (900, 300))


if __name__ == "__main__":
    unittest.main()
