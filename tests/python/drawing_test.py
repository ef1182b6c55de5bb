#!/usr/bin/python3
"""Names, axes, marks, bars and crosses of a figure, compared with tables written by hand."""
import json
import os
import sys
import unittest

import matplotlib

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.path.insert(0, os.path.join(ROOT, "python"))
from peclet import drawing

matplotlib.use("Agg")
import matplotlib.pyplot as plt

# tests/pages/page_rules_test.py tests the page with this table, too.
with open(os.path.join(ROOT, "tests", "pages", "symbols.json"), encoding="utf-8") as file:
    SYMBOLS = json.load(file)
KEYS = {
    name: {"pointer": "/" + name, "words": words, "symbol": symbol, "unit": "", "meaning": ""}
    for name, words, symbol in (("peclet", "Péclet number", "Pe"), ("phi", "", "φ"), ("form", "", ""))
}


def point(settings, mean, half=0.5, state="converged", jammed=False, good_enough=None):
    return {
        "label": str(settings),
        "settings": settings,
        "mean": mean,
        "standard_error": half,
        "half_width": half,
        "good_enough": good_enough,
        "count": 8,
        "state": state,
        "jammed": jammed,
    }


def data(points, keys=("peclet",), over="/peclet", **more):
    quantity = {"path": "pressure", "name": "pressure", "element": "", "symbol": "P", "unit": "η γ̇"}
    figure = {"campaign": "c", "quantity": quantity, "over": over, "confidence": 0.95, "log": None, "tolerance": False}
    return figure | {"parameters": [KEYS[key] for key in keys], "points": points} | more


def text_of(parts):
    return "".join(part["text"] for part in parts)


class Names(unittest.TestCase):
    def test_of_symbols_have_what_is_lowered_and_raised(self):
        for symbol, element, expected in SYMBOLS:
            parts = [[part["text"], part["level"]] for part in drawing.parts_of(symbol, element)]
            self.assertEqual(parts, expected, symbol)

    def test_of_an_axis_have_words_symbol_and_unit(self):
        for symbol, element, unit, expected in (
            ("P", "", "η γ̇", "stress, total P [η γ̇]"),
            ("σ", "xy", "1", "stress, total, xy σxy"),
            ("", "", "1 / time", "stress, total [1 / time]"),
        ):
            about = {"name": "stress/total", "element": element, "symbol": symbol, "unit": unit}
            self.assertEqual(text_of(drawing.title_of(drawing.about_quantity(about))), expected)

    def test_of_an_axis_that_is_too_long_have_two_lines(self):
        for symbol, unit, expected in (
            ("σ", "stress", "contact normal\nσ [stress]"),
            ("", "stress", "contact normal\n[stress]"),
            ("", "1", "contact normal"),
        ):
            about = drawing.about_quantity({"name": "contact_normal", "element": "", "symbol": symbol, "unit": unit})
            self.assertEqual(text_of(drawing.title_of(about, 14)), expected)
            self.assertEqual(text_of(drawing.title_of(about, 25)), expected.replace("\n", " "))

    def test_of_a_key_without_words_are_its_last_steps(self):
        for pointer, words in (("/particles/species/1/radius", "radius"), ("/flow/wave_vector/2", "wave vector 2")):
            key = {"pointer": pointer, "words": "", "symbol": "", "unit": ""}
            self.assertEqual(drawing.about_key(key)["words"], words)

    def test_are_text_whatever_they_are(self):
        parts = drawing.parts_of("N_1^{a b}")
        self.assertEqual(drawing.mathtext(parts), r"N$_{\mathrm{1}}^{\mathrm{a\ b}}$")
        self.assertEqual(drawing.mathtext([{"text": r"$x\$", "level": 1}]), r"$^{\mathrm{x}}$")
        self.assertEqual(drawing.mathtext([{"text": "$x$", "level": 0}]), r"\$x\$")

    def test_of_numbers_have_four_digits_at_most(self):
        for value, text in (
            (0.01, "0.01"),
            (2000, "2000"),
            (99999, "100000"),
            (12346, "12350"),
            (5e6, "5·10⁶"),
            (1e-4, "10⁻⁴"),
            (-2.5e7, "-2.5·10⁷"),
            (0, "0"),
        ):
            self.assertEqual(drawing.plain_number(value), text)


class OverASweep(unittest.TestCase):
    def test_axes_are_logarithmic_where_numbers_lie_more_evenly_then(self):
        for numbers, expected in (
            ([2.2, 2.9, 4.1, 7.0, 21], True),  # a viscosity near jamming
            ([1000, 1, 10, 100], True),
            ([0.1, 0.2, 0.3, 0.4, 0.5, 0.6], False),
            ([0.01, 1, 2, 3, 4], False),
            ([5.7, 7.2, 7.8], False),  # less than a factor of five
            ([0, 1, 10, 100, 1000], False),
            ([-1, 1, 10, 100, 1000], False),
            ([3], False),
            ([], False),
        ):
            self.assertEqual(drawing.is_logarithmic(numbers), expected, numbers)

    def test_what_is_set_in_step_makes_no_curve(self):
        points = [point({"/peclet": pe, "/phi": pe / 2, "/form": form}, 1) for pe in (1, 2, 3) for form in ("a", "b")]
        figure = drawing.over_sweep(data(points, ("peclet", "phi", "form")))
        self.assertEqual([text_of(one["name"]) for one in figure["legend"]], ["form = a", "form = b"])

    def test_words_stand_side_by_side(self):
        points = [point({"/form": form}, mean) for form, mean in (("b", 1), ("a", 2), ("b" * 30, 3), (None, 4))]
        figure = drawing.over_sweep(data(points, ("form",), "/form"))
        self.assertEqual(figure["x"]["categories"], ["b", "a", "#3", "–"])
        self.assertEqual(
            [(mark["x"], mark["y"]) for mark in figure["panels"][0]["marks"]], [(0, 1), (1, 2), (2, 3), (3, 4)]
        )

    def test_without_a_sweep_points_stand_side_by_side(self):
        points = [point({}, 1) | {"label": "first"}, point({}, 2) | {"label": "second"}]
        figure = drawing.over_sweep(data(points, (), ""))
        self.assertEqual((figure["x"]["categories"], figure["x"]["about"]["words"]), (["first", "second"], "point"))

    def test_what_has_no_number_or_no_place_is_said_to_be_left_out(self):
        points = [point({"/peclet": x}, y) for x, y in ((0, 1), (1, 2), (2, None), (3, None))]
        figure = drawing.over_sweep(data(points, log="x"))
        self.assertEqual([mark["x"] for mark in figure["panels"][0]["marks"]], [1])
        self.assertEqual(
            figure["notes"],
            [
                "left out: 2 points without a number of pressure yet",
                "left out: 1 number that is not positive, for which a logarithmic axis has no place",
            ],
        )


class Drawn(unittest.TestCase):
    def tearDown(self):
        plt.close("all")

    def axes_of(self, points, **more):
        _, (axes,) = drawing.draw(drawing.over_sweep(data(points, **more)))
        return axes

    def test_bars_are_as_wide_as_they_are_and_open_marks_have_not_converged(self):
        states = ("converged", "undecided", "provisional")
        axes = self.axes_of([point({"/peclet": k}, 10 + k, 0.5 + k, word) for k, word in enumerate(states)])
        bars = [segment for bars in axes.containers for segment in bars.lines[2][0].get_segments()]
        self.assertEqual(
            [(x, low, high) for (x, low), (_, high) in bars], [(0, 9.5, 10.5), (1, 9.5, 12.5), (2, 9.5, 14.5)]
        )
        dashes = [bars.lines[2][0].get_linestyle()[0][1] for bars in axes.containers]
        self.assertEqual([one is None for one in dashes], [True, True, False])
        marks = [line for line in axes.lines if line.get_marker() == "o"]
        self.assertEqual([list(line.get_xdata()) for line in marks], [[0], [1], [2]])
        self.assertEqual([line.get_markerfacecolor() == "white" for line in marks], [False, True, True])
        legend = [text.get_text() for text in axes.get_legend().get_texts()]
        self.assertEqual(legend, ["not converged", "provisional"])

    def test_a_band_is_as_wide_as_the_tolerance(self):
        points = [point({"/peclet": k}, 10, good_enough=2) for k in (1, 2)]
        self.assertEqual(len(self.axes_of(points).collections), 1)  # the bars
        axes = self.axes_of(points, tolerance=True)
        heights = axes.collections[0].get_paths()[0].vertices[:, 1]
        self.assertEqual((heights.min(), heights.max()), (8, 12))

    def test_a_jam_is_a_cross_at_its_number_or_at_the_edge_and_no_line_leads_to_it(self):
        for mean, log, height in ((None, "none", 1), (None, "y", 1), (0, "y", 0), (0, "none", None)):
            points = [point({"/peclet": x}, 10 + x) for x in (0, 2)] + [point({"/peclet": 1}, mean, 0, jammed=True)]
            axes = self.axes_of(points, log=log)
            (cross,) = (line for line in axes.lines if line.get_marker() == "x")
            at = axes.transAxes.inverted().transform(cross.get_transform().transform(cross.get_xydata()))[0][1]
            expected = (
                axes.transAxes.inverted().transform(axes.transData.transform((1, 0)))[1] if height is None else height
            )
            self.assertAlmostEqual(at, expected)
            self.assertIn("jammed", [text.get_text() for text in axes.get_legend().get_texts()])
            (guide,) = (line for line in axes.lines if line.get_linestyle() == "-")
            self.assertEqual(list(guide.get_xdata()), [0, 2])

    # 10 ± 26 and 1000 ± 1: the bar ends below zero, but its mean must be drawn.
    def test_every_positive_mean_lies_within_a_logarithmic_axis(self):
        axes = self.axes_of([point({"/peclet": 1}, 10, 26), point({"/peclet": 2}, 1000, 1)], log="y")
        low, high = axes.get_ylim()
        self.assertTrue(3 < low * 1.5 and low < 10 < 1001 < high, (low, high))

    def test_ticks_are_a_few_plain_numbers_within_the_axis(self):
        for ratio in (1, 1.0001, 1.5, 3, 9.5, 21, 1e3, 1e5, 1e9):
            for log in ("none", "x"):
                axes = self.axes_of([point({"/peclet": 0.3}, 1), point({"/peclet": 0.3 * ratio}, 2)], log=log)
                low, high = axes.get_xlim()
                ticks = [tick for tick in axes.get_xticks() if low <= tick <= high]
                self.assertTrue(2 <= len(ticks) <= 10, (ratio, log, ticks))

    def test_a_legend_covers_nothing(self):
        points = [point({"/peclet": x, "/phi": k}, 1 + k + x * k % 7) for x in range(8) for k in range(12)]
        _, (axes,) = drawing.draw(drawing.over_sweep(data(points, ("peclet", "phi"))))
        box = axes.get_legend().get_window_extent()
        self.assertGreaterEqual(box.x0, axes.get_window_extent().x1 - 1)
        self.assertLessEqual(box.x1, axes.figure.bbox.x1 + 1)


if __name__ == "__main__":
    unittest.main()
