#!/usr/bin/python3
"""page_saving_test.py BIN: files saved by the page of `peclet report`, and hostile names in it."""

import json
import shutil
import sqlite3
import xml.etree.ElementTree

from campaign_page import choose, open_folds, rows, saved
from page_case import PageTest, Stage, main

HOSTILE = "</script><img src=x onerror=\"window.hacked=1\">'''\\\"\n=1+1"


def drawn_by(script):
    """Returns the axes on which a saved script draws."""
    import matplotlib

    matplotlib.use("Agg")
    module = {"__name__": "a module"}
    exec(compile(script, "script.py", "exec"), module)
    return module["draw"](module["FIGURE"])[1]


class Saved(PageTest):
    def test_every_chart_can_be_saved_in_three_forms(self):
        page = self.open()
        figures = page.evaluate("document.querySelectorAll('figure').length")
        self.assertEqual(figures, 6)  # with the course within the window, and the workers
        links = page.evaluate(
            "[...document.querySelectorAll('figure .saves a')].map(link => [link.textContent, link.download])"
        )
        for what, ending in (("CSV", ".csv"), ("SVG", ".svg"), ("matplotlib", ".py")):
            self.assertEqual(len([name for text, name in links if text == what and name.endswith(ending)]), 6)

    def test_an_svg_stands_alone(self):
        page = self.open()
        text = saved(page, "#sweep", "SVG")
        root = xml.etree.ElementTree.fromstring(text)
        self.assertEqual(root.tag, "{http://www.w3.org/2000/svg}svg")
        self.assertNotIn("var(", text)
        self.assertIn("#0072b2", text.lower().replace("rgb(0, 114, 178)", "#0072b2"))
        marks = [one for one in root.iter() if "mark" in one.get("class", "").split()]
        self.assertEqual(len(marks), 9 + 3)  # three in the legend
        self.assertNotIn("target", text)
        # A page of its own gives the figure a size.
        path = Stage.folder.file("alone.svg")
        with open(path, "w", encoding="utf-8") as file:
            file.write(text)
        alone = Stage.browser.open(path)
        self.assertGreater(alone.evaluate("document.documentElement.getBoundingClientRect().width"), 500)

    def test_a_script_draws_the_same_numbers(self):
        page, exported = self.open(), self.exported()
        (axes,) = drawn_by(saved(page, "#sweep", "matplotlib"))
        segments = [segment for bars in axes.containers for segment in bars.lines[2][0].get_segments()]
        found = sorted((low, high) for (_, low), (_, high) in segments)
        expected = sorted(
            (float(row["mean"]) - float(row["half_width"]), float(row["mean"]) + float(row["half_width"]))
            for row in exported.values()
        )
        self.assertEqual(len(found), 9)
        for one, other in zip(found, expected):
            self.assertAlmostEqual(one[0], other[0], places=9)
            self.assertAlmostEqual(one[1], other[1], places=9)
        self.assertEqual(axes.get_xscale(), "log")
        self.assertEqual(axes.get_ylabel(), "relative viscosity η$_{\\mathrm{r}}$")
        for figure in (1, 2, 3):
            drawn_by(saved(page, f"#point figure:nth-child({figure})", "matplotlib"))


class Hostile(PageTest):
    """A database with names that no campaign file may contain."""

    @classmethod
    def setUpClass(cls):
        shutil.copytree(Stage.folder.file("curve.peclet"), Stage.folder.file("hostile.peclet"))
        database = sqlite3.connect(Stage.folder.file("hostile.peclet/campaign.db"))
        with database:
            database.execute("UPDATE campaign SET name = ?", (HOSTILE,))
            database.execute("UPDATE point SET label = ? || place", (HOSTILE,))
            settings = json.dumps({f"/{HOSTILE}": HOSTILE})
            database.execute(
                "UPDATE point SET settings = json_patch(?, json_object('/peclet', place + 1))", (settings,)
            )
            database.execute("UPDATE attempt SET host = ?", (HOSTILE,))
        database.close()
        Stage.folder.report("hostile.peclet")

    def test_names_are_text_wherever_they_are(self):
        page = self.open("hostile.peclet.html")
        open_folds(page)
        choose(page, "#quantity", "stress by term, xy")
        for axis in page.evaluate("[...document.getElementById('axis').options].map(one => one.text)"):
            choose(page, "#axis", axis)
        self.assertIsNone(page.evaluate("window.hacked || null"))
        self.assertEqual(page.evaluate("document.images.length + document.scripts.length"), 2)
        self.assertEqual(page.evaluate("document.querySelector('h1').textContent"), HOSTILE)
        self.assertEqual(page.evaluate("document.title"), " ".join(HOSTILE.split()))
        self.assertTrue(
            page.evaluate("document.querySelector('#point select').selectedOptions[0].text").startswith("</script>")
        )

    def test_what_is_saved_is_harmless_too(self):
        page = self.open("hostile.peclet.html")
        choose(page, "#axis", "script>")
        text = saved(page, "#sweep", "SVG")
        for element in xml.etree.ElementTree.fromstring(text).iter():
            self.assertIn(
                element.tag.split("}")[1],
                {"svg", "style", "rect", "g", "line", "path", "circle", "text", "tspan", "title"},
            )
        drawn_by(saved(page, "#sweep", "matplotlib"))
        for row in rows(saved(page, "#results", "CSV")):
            self.assertTrue(row["label"].startswith(HOSTILE))
        names = page.evaluate("[...document.querySelectorAll('a[download]')].map(link => link.download)")
        for name in names:
            self.assertRegex(name, r"^[A-Za-z0-9][A-Za-z0-9._-]*\.(csv|svg|py|json)$")

    def test_no_script_but_the_page_s_own_runs(self):
        page = self.open("hostile.peclet.html")
        page.evaluate(
            """(() => { const made = document.createElement('script'); made.textContent = 'window.hacked = 1';
            document.body.append(made); })()"""
        )
        self.assertIsNone(page.evaluate("window.hacked || null"))
        self.assertTrue(any("Content Security Policy" in one for one in page.complaints), page.complaints)
        page.complaints.clear()


if __name__ == "__main__":
    main()
