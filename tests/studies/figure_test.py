#!/usr/bin/python3
"""Content of the figures of studies."""
import math
import os
import struct
import sys
import tempfile
import unittest

import matplotlib

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.path.insert(0, os.path.join(ROOT, "results"))
from studies.figure import BLUE, RED, Figure, shade


class Drawn(unittest.TestCase):
    def panel(self, **settings):
        self.figure = Figure("unused.png", columns=1)
        return self.figure.panel("x", "y", **settings)

    def tearDown(self):
        matplotlib.pyplot.close("all")

    def test_points_have_the_bars_that_their_columns_say(self):
        for row, bars in (((1, 2), []), ((1, 2, 3), [(-1, 5)]), ((1, 2, 0, 4), [(0, 4)])):
            panel = self.panel()
            panel.points([row], "title", RED)
            (drawn,) = panel.axes.containers
            found = [tuple(end[1] for end in bar) for lines in drawn.lines[2] for bar in lines.get_segments()]
            self.assertEqual(found, bars)
            self.assertEqual(drawn.lines[0].get_xydata().tolist(), [[1, 2]])

    def test_points_without_a_number_are_left_out(self):
        panel = self.panel()
        panel.points([(1, 2, 0.5), (2, 3, math.nan), (3, math.nan, 1)], "title", RED, joined=True)
        panel.points([], "nothing", BLUE)
        panel.finish()
        self.assertEqual([text.get_text() for text in panel.axes.get_legend().get_texts()], ["title"])

    def test_a_curve_reaches_from_end_to_end_in_steps_of_the_axis(self):
        for log, middle in (("", 50.5), ("x", 10)):
            panel = self.panel(log=log, x_range=(1, 100))
            panel.curve(lambda x: 2 * x, None, samples=3)
            panel.finish()
            found = panel.axes.lines[0].get_xydata()
            for (x, y), expected in zip(found, (1, middle, 100)):
                self.assertAlmostEqual(x, expected)
                self.assertAlmostEqual(y, 2 * expected)
            self.assertIsNone(panel.axes.get_legend())

    def test_ends_of_an_axis_are_those_given_and_else_those_of_the_data(self):
        panel = self.panel(log="y", x_range=(-1, None))
        panel.points([(1, 2), (3, 50)], None, RED)
        panel.finish()
        left, right = panel.axes.get_xlim()
        self.assertEqual(left, -1)
        self.assertTrue(3 < right < 4, right)
        low, high = panel.axes.get_ylim()
        self.assertTrue(1 < low < 2 and 50 < high < 100, (low, high))

    def test_an_image_has_each_value_at_its_place(self):
        panel = self.panel()
        panel.image([(x, y, x + 10 * y) for y in (0, 1) for x in (0, 1, 2)], {0: "#ffffff", 12: "#000000"})
        self.assertEqual(panel.axes.collections[0].get_array().ravel().tolist(), [0, 1, 2, 10, 11, 12])

    def test_panels_never_lie_on_each_other(self):
        figure = Figure("unused.png", columns=2, rows=1)
        figure.panel("Pe")
        figure.panel("phi")
        with self.assertRaises(ValueError):
            figure.panel("mu")

    def test_a_misspelt_setting_is_no_setting(self):
        with self.assertRaises(TypeError):
            self.panel(x_rang=(0, 1))

    def test_shades_become_brighter_and_stay_darker_than_the_paper(self):
        channels = [[int(shade(p)[k : k + 2], 16) for k in (1, 3, 5)] for p in (0, 0.25, 0.5, 0.75, 1)]
        brightness = [0.3 * red + 0.59 * green + 0.11 * blue for red, green, blue in channels]
        self.assertEqual(brightness, sorted(set(brightness)))
        self.assertLess(brightness[-1], 200)


class Picture(unittest.TestCase):
    def test_is_a_png_of_the_size_that_was_asked_for(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "it's a picture.png")
            figure = Figure(path, columns=3, size=(900, 300))
            panel = figure.panel("x", "y", "title", log="xy", powers="xy", x_range=(1, 10), y_range=(1, None))
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
