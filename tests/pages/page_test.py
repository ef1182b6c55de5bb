#!/usr/bin/python3
"""page_test.py BIN: the page of `peclet report` in a real browser, compared with `peclet export`."""

import json

from scipy.stats import t as student

from campaign_page import choose, open_folds, rows, saved, switch
from page_case import PageTest, Stage, main


class Numbers(PageTest):
    def test_the_table_has_the_export_s_numbers(self):
        page, exported = self.open(), self.exported()
        table = rows(saved(page, "#results", "CSV"))
        self.assertEqual([row["label"] for row in table], list(exported))
        for row in table:
            expected = exported[row["label"]]
            for key in ("hash", "/peclet", "/volume_fraction", "verdict"):
                self.assertEqual(row[key], expected[key])
            for key in ("seeds", "count", "lost", "mean", "standard_error", "half_width", "plain_mean"):
                self.assertEqual(float(row[key]), float(expected[key]), key)
            self.assertEqual(float(row["plain_half_width"]), float(expected["plain_half_width"]))

    def test_what_is_read_is_what_is_saved(self):
        page, exported = self.open(), self.exported()
        cells = page.evaluate(
            """[...document.querySelectorAll('#results tbody tr')]
            .map(row => [...row.cells].map(cell => cell.textContent))"""
        )
        self.assertEqual(len(cells), 9)
        for line, row in zip(cells, exported.values()):
            self.assertEqual([float(line[0]), float(line[1])], [float(row["/peclet"]), float(row["/volume_fraction"])])
            mean, half = map(float, line[3].split(" ± "))
            # The half-width has two digits, and the mean an equal number of decimals.
            self.assertLessEqual(abs(half / float(row["half_width"]) - 1), 0.05)
            decimals = len(line[3].split(" ± ")[1].partition(".")[2])
            self.assertLessEqual(abs(mean - float(row["mean"])), 0.5001 * 10**-decimals)

    def test_every_scalar_is_drawn_with_its_mean_and_interval(self):
        page, exported = self.open(), self.exported()
        columns = [
            key for key in next(iter(exported.values())) if f"{key} standard_error" in next(iter(exported.values()))
        ]
        self.assertGreaterEqual(len(columns), 9)
        for column in columns:
            name = column.split(" [")[0]
            if name == "relative_viscosity":
                continue
            choose(page, "#quantity", name.replace("/", ", ").replace("_", " "))
            for row in rows(saved(page, "#sweep", "CSV")):
                if row["quantity"] != name:  # a name with this prefix
                    self.assertTrue(row["quantity"].startswith(name))
                    continue
                expected = exported[row["label"]]
                self.assertEqual(float(row["mean"]), float(expected[column]))
                error, count = float(expected[f"{column} standard_error"]), int(expected[f"{column} count"])
                self.assertEqual(int(row["count"]), count)
                self.assertEqual(float(row["standard_error"]), error)
                if error == 0:
                    self.assertEqual(row["half_width"], "")
                    continue
                level = 1 - 0.05 * (1 - 1.4 / 8)  # several stop tests, from 8 seeds on
                expected = student.ppf((1 + level) / 2, count - 1) * error
                # SciPy's quantile has nine digits.
                self.assertAlmostEqual(float(row["half_width"]), expected, delta=1e-8 * error)

    def test_the_target_s_chart_has_the_deciding_interval(self):
        page, exported = self.open(), self.exported()
        for row in rows(saved(page, "#sweep", "CSV")):
            for key in ("mean", "standard_error", "half_width"):
                self.assertEqual(float(row[key]), float(exported[row["label"]][key]))

    def test_marks_and_bars_lie_where_the_axis_says(self):
        page, exported = self.open(), self.exported()
        switch(page, "#log-y", False)
        drawn = page.evaluate(
            """[...document.querySelectorAll('#sweep svg g')].filter(g => g.querySelector(':scope > title'))
            .map(g => [g.querySelector('title').textContent.split(':')[0],
                Number(g.querySelector('.target').getAttribute('cy')),
                ...[...g.querySelectorAll('.bar')].map(bar => Number(bar.getAttribute('y2')))])"""
        )
        self.assertEqual(len(drawn), 9)
        points = [(float(exported[label]["mean"]), float(exported[label]["half_width"]), ys) for label, *ys in drawn]
        low, high = min(points), max(points)
        scale = (high[2][0] - low[2][0]) / (high[0] - low[0])
        for mean, half, (centre, *ends) in points:
            self.assertAlmostEqual(centre, low[2][0] + scale * (mean - low[0]), delta=0.2)
            for end in (mean - half, mean + half):
                self.assertLess(min(abs(y - (low[2][0] + scale * (end - low[0]))) for y in ends), 0.2)

    def test_the_point_shows_how_its_mean_came_about(self):
        page, exported = self.open(), self.exported()
        for label, row in exported.items():
            choose(page, "#point select", label)
            running = rows(saved(page, "#point figure:nth-child(1)", "CSV"))
            tests = [one for one in running if one["kind"] == "stop test"]
            self.assertEqual(float(tests[-1]["mean"]), float(row["mean"]))
            self.assertAlmostEqual(float(tests[-1]["good_enough"]), 0.3 * abs(float(row["mean"])), places=12)
            values = [float(one["value"]) for one in rows(saved(page, "#point figure:nth-child(3)", "CSV"))]
            self.assertEqual(len(values), int(row["count"]))
            for line in (one for one in running if one["kind"] == "running"):
                n = int(line["seeds"])
                self.assertAlmostEqual(float(line["mean"]), sum(values[:n]) / n, delta=2e-5 * abs(float(line["mean"])))

    def test_provisional_numbers_are_marked(self):
        page = self.open("young.json.html")
        self.assertIn("0 of 9 points decided", page.evaluate("document.getElementById('headline').textContent"))
        self.assertRegex(page.evaluate("document.getElementById('headline').textContent"), r"spent · .* to go \(")
        self.assertEqual(page.evaluate("document.querySelectorAll('#sweep svg g.provisional .target').length"), 9)
        self.assertEqual(
            page.evaluate("document.querySelectorAll('#sweep svg .mark.solid').length"), 3
        )  # in the legend
        cells = page.evaluate(
            "[...document.querySelectorAll('#results tbody tr')].map(row => row.cells[3].textContent)"
        )
        self.assertTrue(all(cell.endswith(" *") for cell in cells), cells)


class Controls(PageTest):
    def test_nothing_that_can_be_chosen_fails(self):
        page = self.open()
        quantities = page.evaluate("[...document.getElementById('quantity').options].map(one => one.value)")
        # One call a quantity: all of them together take longer than the browser's patience on a busy machine.
        for script in (
            """quantity => { const lists = ['quantity', 'axis', 'panels'].map(id => document.getElementById(id));
            let drawn = 0;
            for (const axis of [...lists[1].options].slice(0, 2)) for (const panels of lists[2].options) {
                [quantity, axis.value, panels.value].forEach((value, i) => { lists[i].value = value; });
                lists[0].dispatchEvent(new Event('change'));
                for (const box of ['log-x', 'log-y', 'log-x', 'log-y']) document.getElementById(box).click();
                drawn += document.querySelectorAll('#sweep svg .mark').length > 0;
            } return drawn; }""",
            """quantity => { let drawn = 0;
            const choose = (id, value) => {
                const list = document.getElementById(id);
                list.value = value;
                list.dispatchEvent(new Event('change'));
                drawn += document.querySelectorAll('#sweep svg .mark').length > 0;
            };
            const values = id => [...document.getElementById(id).options].map(one => one.value);
            choose('quantity', quantity);
            for (const id of ['second', 'scale-y', 'scale-x', 'axis'])
                for (const value of values(id)) choose(id, value);
            for (const id of ['second', 'scale-y', 'scale-x', 'axis']) choose(id, values(id)[0]);
            return drawn; }""",
        ):
            drawn = sum(page.evaluate(f"({script})({json.dumps(quantity)})") for quantity in quantities)
            self.assertGreater(drawn, 200)

    def test_log_scales_are_chosen_by_themselves_and_by_a_switch(self):
        page = self.open()
        choose(page, "#axis", "Péclet number")
        across = """[...new Set([...document.querySelectorAll('#sweep svg .target')]
            .map(one => Number(one.getAttribute('cx'))))].sort((a, b) => a - b)"""
        self.assertTrue(page.evaluate("document.getElementById('log-x').checked"))
        x = page.evaluate(across)
        self.assertAlmostEqual(x[1] - x[0], x[2] - x[1], delta=0.3)
        switch(page, "#log-x", False)
        x = page.evaluate(across)
        self.assertAlmostEqual((x[2] - x[1]) / (x[1] - x[0]), 90 / 9, delta=0.2)
        choose(page, "#axis", "volume fraction")
        self.assertFalse(page.evaluate("document.getElementById('log-x').checked"))

    def test_tables_sort_by_a_click(self):
        page = self.open()
        column = "[...document.querySelectorAll('#results tbody tr')].map(row => row.cells[3].textContent)"
        for turn, state in ((1, "ascending"), (-1, "descending")):
            page.evaluate("document.querySelectorAll('#results th button')[3].click()")
            means = [turn * float(text.split(" ")[0]) for text in page.evaluate(column)]
            self.assertEqual(means, sorted(means))
            self.assertEqual(
                page.evaluate("document.querySelectorAll('#results th')[3].getAttribute('aria-sort')"), state
            )

    def test_the_keyboard_is_enough(self):
        page = self.open()
        chosen = "document.querySelector('#point select').value"
        page.evaluate("document.querySelector('#sweep svg').focus()")
        page.press("ArrowRight")
        page.press("ArrowRight")
        self.assertEqual(page.evaluate(chosen), "2")
        self.assertEqual(page.evaluate("document.querySelector('#results tr[aria-selected=true]').rowIndex"), 3)
        page.evaluate("document.querySelector('#results tbody tr:nth-child(6) button').focus()")
        page.press("Enter")
        self.assertEqual(page.evaluate(chosen), "5")
        page.evaluate("document.querySelector('#results th button').focus()")
        page.press(" ")
        self.assertEqual(page.evaluate("document.querySelector('#results th').getAttribute('aria-sort')"), "ascending")

    def test_nothing_is_wider_than_a_telephone(self):
        for name in ("curve.json.html", "young.json.html"):
            for dark in (False, True):
                page = self.open(name, width=360, dark=dark, touch=True)
                open_folds(page)
                choose(page, "#quantity", "stress by term, xy")
                self.assertEqual(page.evaluate("document.documentElement.scrollWidth"), 360)

    def test_print_unfolds_what_is_folded(self):
        page = self.open()
        folded = "document.querySelectorAll('details:not([open])').length"
        page.evaluate("window.seen = null; addEventListener('beforeprint', () => { window.seen = " + folded + "; })")
        self.assertGreater(page.evaluate(folded), 3)
        page.print(Stage.folder.file("page.pdf"))
        with open(Stage.folder.file("page.pdf"), "rb") as file:
            self.assertTrue(file.read().startswith(b"%PDF"))
        self.assertEqual(page.evaluate("window.seen"), 0)
        self.assertGreater(page.evaluate(folded), 3)

    def test_colours_are_legible_in_both_modes(self):
        for dark in (False, True):
            page = self.open(dark=dark)
            names = ["--page", "--ink", "--faint", *(f"--c{i}" for i in range(8))]
            style = "getComputedStyle(document.documentElement)"
            page_colour, *colours = (page.evaluate(f"{style}.getPropertyValue('{name}').trim()") for name in names)
            for name, colour in zip(names[1:], colours):
                self.assertGreaterEqual(
                    contrast(colour, page_colour), 3 if name.startswith("--c") else 4.5, (dark, name)
                )
            self.assertEqual(luminance(page_colour) < 0.1, dark)


def luminance(colour):
    """Returns the luminance of #rrggbb by the Web Content Accessibility Guidelines."""
    parts = [int(colour[i : i + 2], 16) / 255 for i in (1, 3, 5)]
    linear = [part / 12.92 if part <= 0.04045 else ((part + 0.055) / 1.055) ** 2.4 for part in parts]
    return sum(weight * part for weight, part in zip((0.2126, 0.7152, 0.0722), linear))


def contrast(one, other):
    darker, lighter = sorted((luminance(one), luminance(other)))
    return (lighter + 0.05) / (darker + 0.05)


if __name__ == "__main__":
    main()
