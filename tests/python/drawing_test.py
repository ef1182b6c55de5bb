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

PRESSURE = {"path": "pressure", "name": "pressure", "element": "", "symbol": "P", "unit": "η γ̇", "scale": ""}
MODULI = [
    {
        **PRESSURE,
        "path": f"linear_response/{name}",
        "name": f"linear_response/{name}",
        "symbol": symbol,
        "unit": "stress",
    }
    for name, symbol in (("storage", "G'"), ("loss", "G''"))
]


def point(settings, mean, half=0.5, state="converged", jammed=False, good_enough=None):
    return {
        "label": str(settings),
        "settings": settings,
        "quantity": "pressure",
        "mean": mean,
        "standard_error": half,
        "half_width": half,
        "good_enough": good_enough,
        "count": 8,
        "state": state,
        "jammed": jammed,
    }


def data(points, keys=("peclet",), over="/peclet", **more):
    figure = {"campaign": "c", "quantities": [PRESSURE], "over": over, "confidence": 0.95, "log": None, "absent": 0}
    return figure | {"tolerance": False, "parameters": [KEYS[key] for key in keys], "points": points} | more


def curve(settings, mean, half=None, x=(1, 2, 4), quantity="pressure", state="converged", jammed=False):
    half = [0.1] * len(mean) if half is None else half
    known = {"label": str(settings), "settings": settings, "quantity": quantity, "state": state, "jammed": jammed}
    return known | {"x": list(x), "mean": mean, "standard_error": half, "half_width": half, "count": [8] * len(mean)}


def along(points, keys=("peclet",), **more):
    """Returns the data of a quantity along the strain."""
    axis = {"name": "strain", "scale": "", "unit": "1"}
    return {name: value for name, value in data(points, keys, axis=axis, **more).items() if name != "over"}


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

    def test_campaigns_are_told_apart_even_where_the_axis_does(self):
        parameters = [{"pointer": "campaign", "words": "campaign", "symbol": "", "unit": "", "meaning": ""}]
        values = (("rough", 1), ("rough", 10), ("smooth", 30), ("smooth", 100))
        points = [point({"campaign": name, "/peclet": pe}, 5) for name, pe in values]
        figure = drawing.figure_of(data(points, parameters=parameters + [KEYS["peclet"]]))
        self.assertEqual([text_of(one["name"]) for one in figure["legend"]], ["rough", "smooth"])
        lines = [[place[0] for place in line["places"]] for line in figure["panels"][0]["lines"]]
        self.assertEqual(lines, [[1, 10], [30, 100]])
        curves = [curve({"campaign": name, "/peclet": pe}, [1, 2, 3]) for name, pe in values[:3]]
        figure = drawing.figure_of(along(curves, parameters=parameters + [KEYS["peclet"]]))
        names = [text_of(one["name"]) for one in figure["legend"]]
        self.assertEqual(names, ["rough, Pe = 1", "rough, Pe = 10", "smooth, Pe = 30"])

    def test_curves_over_a_measured_number_follow_the_parameter_that_was_swept(self):
        rate = {"pointer": "shear_rate", "words": "", "symbol": "γ̇", "unit": "1 / time", "meaning": ""}
        measured = ((1, 0.3, 5), (10, 1.0, 9), (100, 0.4, 40))  # the rate falls as the stress grows
        points = [
            point({"/peclet": pe, "/phi": phi, "shear_rate": rate * phi}, mean) | {"x_half_width": 0.1}
            for phi in (0.4, 0.5)
            for pe, rate, mean in measured
        ]
        figure = drawing.figure_of(
            data(points, over="shear_rate", parameters=[KEYS["peclet"], KEYS["phi"], rate], along="/peclet")
        )
        self.assertEqual([text_of(one["name"]) for one in figure["legend"]], ["φ = 0.4", "φ = 0.5"])
        lines = [[place[1] for place in line["places"]] for line in figure["panels"][0]["lines"]]
        self.assertEqual(lines, [[5, 9, 40], [5, 9, 40]])
        _, (axes,) = drawing.draw(figure)
        bars = [segment for bars in axes.containers for segment in bars.lines[2][0].get_segments()]
        wide = [(low[0], high[0]) for low, high in bars if low[1] == high[1]]
        self.assertEqual(len(wide), 6)
        for low, high in wide:
            self.assertAlmostEqual(high - low, 0.2)
        plt.close("all")

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

    def test_several_quantities_are_named_by_their_symbols(self):
        points = [point({"/peclet": pe}, 1) | {"quantity": one["path"]} for pe in (1, 2) for one in MODULI]
        figure = drawing.over_sweep(data(points, quantities=MODULI))
        self.assertEqual([text_of(one["name"]) for one in figure["legend"]], ["G'", "G''"])
        self.assertEqual(text_of(drawing.title_of(figure["y"]["about"])), "linear response G', G'' [stress]")
        marks = [(mark["series"], mark["x"]) for mark in figure["panels"][0]["marks"]]
        self.assertEqual(sorted(marks), [(0, 1), (0, 2), (1, 1), (1, 2)])

    def test_symbols_alone_name_an_axis_of_names_that_begin_differently(self):
        normal = [PRESSURE | {"name": name, "symbol": symbol} for name, symbol in (("first", "N_1"), ("second", "N_2"))]
        about, _ = drawing.about_quantities(normal)
        self.assertEqual(text_of(drawing.title_of(about)), "N1, N2 [η γ̇]")
        about, names = drawing.about_quantities([one | {"symbol": ""} for one in normal])
        self.assertEqual(text_of(drawing.title_of(about)), "first and second [η γ̇]")
        self.assertEqual([text_of(name) for name in names], ["first", "second"])

    def test_a_scale_follows_the_symbol(self):
        for unit, scale, expected in (
            ("1", " / (k_B T / a^3)", "linear response (G', G'') / (kB T / a3)"),
            ("stress", " / 2", "linear response (G', G'') / 2 [stress]"),
        ):
            scaled = [one | {"scale": scale, "unit": unit} for one in MODULI]
            about, _ = drawing.about_quantities(scaled)
            self.assertEqual(text_of(drawing.title_of(about)), expected)
        shear = {
            **PRESSURE,
            "name": "stress/total",
            "element": "xy",
            "symbol": "σ",
            "scale": " / (F_CL / a^2)",
            "unit": "1",
        }
        about, _ = drawing.about_quantities([shear])
        self.assertEqual(text_of(drawing.title_of(about)), "stress, total, xy σxy / (FCL / a2)")
        key = KEYS["phi"] | {"scale": " / 0.64"}
        self.assertEqual(text_of(drawing.title_of(drawing.about_key(key))), "phi φ / 0.64")
        key = KEYS["form"] | {"scale": " / 0.64"}
        self.assertEqual(text_of(drawing.title_of(drawing.about_key(key))), "form / 0.64")


class OverAnAxis(unittest.TestCase):
    def test_each_point_is_a_curve_with_its_interval_as_a_band(self):
        points = [curve({"/peclet": pe}, [pe, 2 * pe, 3 * pe], [0.1, 0.2, None]) for pe in (1, 10)]
        figure = drawing.over_axis(along(points))
        (panel,) = figure["panels"]
        self.assertEqual(
            [line["places"] for line in panel["lines"]], [[[1, k], [2, 2 * k], [4, 3 * k]] for k in (1, 10)]
        )
        self.assertEqual(panel["bands"][1]["places"], [[1, 9.9, 10.1], [2, 19.8, 20.2]])
        self.assertEqual([text_of(one["name"]) for one in figure["legend"]], ["Pe = 1", "Pe = 10"])
        self.assertEqual(text_of(drawing.title_of(figure["x"]["about"])), "strain")

    def test_places_without_a_mean_are_gaps_and_points_without_any_are_said_to_be_left_out(self):
        points = [curve({"/peclet": 1}, [1, None, 3]), curve({"/peclet": 2}, [], x=())]
        figure = drawing.over_axis(along(points))
        self.assertEqual([line["places"] for line in figure["panels"][0]["lines"]], [[[1, 1], [4, 3]]])
        self.assertEqual(figure["notes"], ["left out: 1 point without a number of pressure yet"])

    def test_more_curves_than_colours_have_shades_in_the_order_of_the_values(self):
        values = [5, 1, 9, 2, 3, 4, 6, 7, 8, 10]
        points = [curve({"/peclet": pe}, [pe, pe, pe]) for pe in values]
        figure = drawing.over_axis(along(points))
        shades = {line["places"][0][1]: line["shade"] for line in figure["panels"][0]["lines"]}
        self.assertEqual(shades, {pe: (pe - 1) / 9 for pe in values})
        self.assertLessEqual(len(figure["legend"]), 10)

    def test_more_curves_of_two_parameters_have_panels(self):
        points = [curve({"/peclet": pe, "/phi": phi}, [1, 2, 3]) for pe in (1, 2, 3, 4, 5) for phi in (0.3, 0.5)]
        figure = drawing.over_axis(along(points, ("peclet", "phi")))
        self.assertEqual([text_of(panel["title"]) for panel in figure["panels"]], ["φ = 0.3", "φ = 0.5"])
        self.assertEqual(len(figure["legend"]), 5)

    def test_a_jammed_point_is_a_cross_at_the_upper_edge_and_in_the_legend(self):
        points = [curve({"/peclet": 1}, [1, 2, 3]), curve({"/peclet": 2}, [None] * 3, jammed=True)]
        _, (axes,) = drawing.draw(drawing.over_axis(along(points)))
        (cross,) = (line for line in axes.lines if line.get_marker() == "x")
        at = axes.transAxes.inverted().transform(cross.get_transform().transform(cross.get_xydata()))[0]
        self.assertAlmostEqual(at[1], 1)
        self.assertEqual(cross.get_color(), drawing.COLOURS[1])
        self.assertEqual(
            [text.get_text() for text in axes.get_legend().get_texts()][-2:], ["jammed", "interval of the mean"]
        )
        plt.close("all")

    def test_a_provisional_curve_is_dashed(self):
        _, (axes,) = drawing.draw(drawing.over_axis(along([curve({}, [1, 2, 3], state="provisional")])))
        (line,) = (line for line in axes.lines if len(line.get_xdata()) == 3)
        self.assertTrue(line.is_dashed())
        self.assertIn("provisional", [text.get_text() for text in axes.get_legend().get_texts()])
        plt.close("all")


# 10 and 20 are certain, so that uncertain numbers stretch the axis up to 200.
class Uncertain(unittest.TestCase):
    def drawn(self, mean, half, **more):
        points = [point({"/peclet": 1}, 10, 1), point({"/peclet": 2}, 19, 1), point({"/peclet": 3}, mean, half, **more)]
        _, (axes,) = drawing.draw(drawing.over_sweep(data(points, log="none")))
        self.addCleanup(plt.close, "all")
        return axes

    def at_edge(self, axes, marker):
        """Returns the heights, as a share of the frame, of marks with this marker."""
        heights = []
        for line in axes.lines:
            if line.get_marker() == marker and len(line.get_xdata()):
                places = axes.transAxes.inverted().transform(line.get_transform().transform(line.get_xydata()))
                heights += [round(height, 6) for height in places[:, 1]]
        return heights

    def test_numbers_far_beyond_the_others_are_arrows_at_the_edge(self):
        axes = self.drawn(1e8, 2e8)
        self.assertEqual(self.at_edge(axes, "^"), [1])
        self.assertLess(axes.get_ylim()[1], 30)
        self.assertIn("beyond the frame", [text.get_text() for text in axes.get_legend().get_texts()])
        self.assertEqual(self.at_edge(self.drawn(-1e8, 2e8), "v"), [0])

    def test_signs_at_one_place_of_the_edge_stand_beside_each_other(self):
        points = [point({"/peclet": 1, "/phi": 1}, 10)]
        points += [point({"/peclet": 1, "/phi": phi}, None, jammed=True) for phi in (2, 3, 4)]
        _, (axes,) = drawing.draw(drawing.over_sweep(data(points, ("peclet", "phi"))))
        self.assertEqual(self.at_edge(axes, "x"), [1, 0.965, 0.93])
        plt.close("all")

    def test_numbers_within_ten_times_the_others_are_in_the_frame(self):
        axes = self.drawn(199, 200)
        self.assertGreater(axes.get_ylim()[1], 199)
        self.assertEqual(self.at_edge(axes, "^"), [])

    def test_numbers_narrower_than_themselves_stretch_any_axis(self):
        self.assertGreater(self.drawn(1e8, 1e7).get_ylim()[1], 1e8)

    def test_jammed_numbers_are_crosses_at_the_edge(self):
        self.assertEqual(self.at_edge(self.drawn(1e8, 1, jammed=True), "x"), [1])
        self.assertLess(self.at_edge(self.drawn(100, 1, jammed=True), "x")[0], 1)

    def test_without_a_certain_number_all_are_in_the_frame(self):
        points = [point({"/peclet": x}, y, 2 * y) for x, y in ((1, 1), (2, 1e6))]
        _, (axes,) = drawing.draw(drawing.over_sweep(data(points, log="none")))
        self.assertGreater(axes.get_ylim()[1], 1e6)
        plt.close("all")

    def test_bands_far_beyond_are_cut(self):
        axes = drawing.draw(drawing.over_axis(along([curve({}, [5000, 2, 3], [9000, 0.1, 0.1])])))[1][0]
        self.assertLess(axes.get_ylim()[1], 40)
        plt.close("all")


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

    # Ten values from 1 to 10 leave the upper left corner free, unless a cross is there.
    def test_a_legend_covers_no_cross_at_the_edge(self):
        points = [point({"/peclet": x}, x, 0.01, "undecided") for x in range(1, 11)]
        free = drawing.draw(drawing.over_sweep(data(points, log="none")))[1][0].get_legend().get_window_extent()
        points += [point({"/peclet": x}, None, jammed=True) for x in (1, 2)]
        _, (axes,) = drawing.draw(drawing.over_sweep(data(points, log="none")))
        box = axes.get_legend().get_window_extent()
        crosses = [line for line in axes.lines if line.get_marker() == "x" and len(line.get_xdata())]
        places = [place for line in crosses for place in line.get_transform().transform(line.get_xydata())]
        self.assertEqual(len(places), 2)
        self.assertGreater(free.y0, axes.get_window_extent().y0 + axes.get_window_extent().height / 2)
        self.assertFalse(any(box.contains(x, y) for x, y in places))


if __name__ == "__main__":
    unittest.main()
