#!/usr/bin/python3
"""page_rules_test.py BIN: functions of the page of `peclet report`, compared with tables written by hand."""

import json
import os

from page_case import PageTest, main


class Rules(PageTest):
    def test_axes_are_logarithmic_where_numbers_lie_more_evenly_then(self):
        page = self.open()
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
            self.assertEqual(page.evaluate(f"isLogarithmic({json.dumps(numbers)})"), expected, numbers)

    def test_ticks_are_a_few_round_numbers_within_the_axis(self):
        page = self.open()
        make = "new Axis({{log: {log}, low: {low}, high: {high}, begin: 0, end: 100, mostTicks: {most}}})"
        for log, low, high, expected in (
            ("false", 0, 1, "0 0.2 0.4 0.6 0.8 1"),
            ("false", -1, 1, "-1 -0.5 0 0.5 1"),
            ("false", 2e6, 4e6, "2·10⁶ 2.5·10⁶ 3·10⁶ 3.5·10⁶ 4·10⁶"),
            ("true", 0.1, 10000, "0.1 1 10 100 1000 10⁴"),
            ("true", 2.2, 21, "2 5 10 20"),
            ("true", 12, 60, "20 30 40 50 60"),
        ):
            axis = make.format(log=log, low=low, high=high, most=9)
            text = page.evaluate(f"{axis}.ticks().map(tick => tick.text).join(' ')")
            self.assertEqual(text.replace("10000", "10⁴"), expected)
        for low in (1e-9, 0.1, 0.3, 1, 7.7, 9.99, 1e6):
            for ratio in (1, 1.0001, 1.5, 3, 5, 9.5, 19, 21, 60, 1e3, 1e5, 1e9, 1e12, 1e15):
                for log in ("false", "true"):
                    for most in (9, 5):
                        axis = make.format(log=log, low=low, high=low * ratio, most=most)
                        places = page.evaluate(f"(a => a.ticks().map(tick => a.place(tick.value)))({axis})")
                        self.assertTrue(all(0 <= place <= 100 for place in places), (low, ratio, log, places))
                        self.assertTrue(2 <= len(places) <= most, (low, ratio, log, most, places))

    def test_numbers_have_as_many_digits_as_their_errors_justify(self):
        page = self.open()
        for value, error, expected in (
            (8.9311, 0.1234, "8.93 ± 0.12"),
            (8.9311, 0.0996, "8.93 ± 0.10"),
            (1234.4, 67.8, "1234 ± 68"),
            (1234.5, 678, "1230 ± 680"),
            (-0.5, 0.25, "-0.50 ± 0.25"),
            (5, 0, "5 ± 0"),
            (1.234e9, 5.6e7, "(1.234 ± 0.056)·10⁹"),
        ):
            self.assertEqual(page.evaluate(f"Format.withError({value}, {error})"), expected)
        self.assertEqual(page.evaluate("Format.withError(null, 1) + Format.withError(2, null)"), "–2 ± –")

    def test_symbols_have_parts(self):
        page = self.open()
        # tests/python/drawing_test.py tests figures with this table, too.
        with open(os.path.join(os.path.dirname(os.path.abspath(__file__)), "symbols.json"), encoding="utf-8") as file:
            symbols = json.load(file)
        for symbol, element, expected in symbols:
            call = f"Format.symbol({json.dumps(symbol)}, {json.dumps(element)}).map(part => [part.text, part.level])"
            self.assertEqual(page.evaluate(call), expected, symbol)

    def test_what_is_set_in_step_makes_no_curve(self):
        page = self.open()
        points = [
            {"settings": {"/phi": phi, "/count": count, "/form": form}}
            for phi, count in ((0.4, 500), (0.5, 1000), (0.6, 2000))
            for form in ("a", "b")
        ]
        key = {"meaning": "", "words": "", "symbol": "", "unit": ""}
        parameters = [{"pointer": p, **key} for p in ("/phi", "/count", "/form")]
        data = {"points": points, "parameters": parameters, "derived": []}
        names = page.evaluate(
            f"""(sweep => [sweep.usual.pointer, sweep.others(sweep.usual).map(one => one.pointer),
            sweep.parameters[2].numeric])(new Sweep({json.dumps(data)}))"""
        )
        self.assertEqual(names, ["/phi", ["/form"], False])

    def test_spans_of_time_are_in_words(self):
        page = self.open()
        for seconds, expected in (
            (0.123, "0.12 s"),
            (45, "45 s"),
            (720, "12 min"),
            (12000, "3 h 20 min"),
            (187200, "2 d 4 h"),
        ):
            self.assertEqual(page.evaluate(f"Format.duration({seconds})"), expected)


if __name__ == "__main__":
    main()
