#!/usr/bin/python3
"""jam_test.py BIN: a point jammed under its stress, in tables, files, figures and on the page."""

import json

from campaign_page import choose, rows
from page_case import PageTest, Stage, main

# Relative viscosities exceed 1 + 2.5 phi, so the first jammed viscosity, 1.5, makes the first point jam.
CAMPAIGN = {
    "name": "still",
    "scene": {
        "particles": {"count": 20, "density": 0.001, "species": [{"radius": 1}]},
        "volume_fraction": 0.3,
        "fluid": {"viscosity": 1},
        "flow": {"stress": 5},
        "contact": {"normal_stiffness": 2e4},
        "lubrication": {"form": "kim-karrila", "inner_gap": 0.001, "outer_gap": 0.05},
        "duration": {"equilibration": {"stress_times": 0.5}, "production": {"stress_times": 12}},
    },
    "sweep": [{"set": "/flow/jammed_viscosity", "values": [1.5, 200, 1000]}],
    "target": {"observable": "shear_rate", "absolute_tolerance": 1e9},
    "realisations": {"minimum": 4, "maximum": 4},
    "engine": ["peclet-engine", "serve"],
}


class Jams(PageTest):
    @classmethod
    def setUpClass(cls):
        Stage.folder.peclet("run", Stage.folder.write(CAMPAIGN), "--quiet", allowed=(0, 3))
        Stage.folder.report("still.json")

    def test_have_the_rate_zero_and_no_viscosity(self):
        still, *flowing = rows(Stage.folder.peclet("export", "still.json", "--csv"))
        self.assertEqual([row["jammed"] for row in (still, *flowing)], ["1", "0", "0"])
        self.assertEqual((float(still["mean"]), still["apparent_viscosity"]), (0, ""))
        for row in flowing:
            self.assertGreater(float(row["apparent_viscosity"]), 1 + 2.5 * 0.3)
        point = json.loads(Stage.folder.peclet("export", "still.json"))["points"][0]
        self.assertEqual(point["endings"], {"ended": 4, "jammed": 4, "lost": 0, "has_jammed": True})
        self.assertIsNone(point["quantities"]["apparent_viscosity"]["mean"])
        status = json.loads(Stage.folder.peclet("status", "still.json", "--json"))["points"]
        self.assertEqual([one["endings"]["has_jammed"] for one in status], [True, False, False])
        self.assertIn("jammed", Stage.folder.peclet("status", "still.json").split("\n")[3])
        self.assertIn("jammed", Stage.folder.peclet("explain", "still.json", point["label"]).split("\n")[1])

    # tests/python/drawing_test.py tests where crosses are drawn.
    def test_have_the_rate_zero_and_no_viscosity_in_a_figure(self):
        for quantity, mean in (("apparent_viscosity", None), ("shear_rate", 0)):
            figure = json.loads(Stage.folder.peclet("plot", "still.json", "--json", "--quantity", quantity))
            self.assertEqual([point["jammed"] for point in figure["points"]], [True, False, False])
            self.assertEqual(figure["points"][0]["mean"], mean)

    def test_stand_at_the_edge_on_the_page(self):
        page = self.open("still.json.html")
        choose(page, "#quantity", "apparent viscosity")
        marks = page.evaluate("document.querySelectorAll('#sweep path.jammed').length")
        self.assertEqual(marks, 2)  # one in the legend
        at = page.evaluate(
            "document.querySelector('#sweep path.jammed').getAttribute('d').match(/M[-.0-9]+ ([-.0-9]+)L[-.0-9]+ "
            "([-.0-9]+)/).slice(1).map(Number).reduce((a, b) => a + b) / 2"
        )
        top = page.evaluate("Number(document.querySelector('#sweep rect.frame').getAttribute('y'))")
        self.assertAlmostEqual(at, top, delta=0.2)
        guide = page.evaluate("document.querySelector('#sweep path.guide').getAttribute('d')")
        self.assertEqual(guide.count("L"), 1)
        table = page.evaluate("document.querySelector('#results').innerText")
        self.assertIn("jammed", table)
        choose(page, "#quantity", "shear rate")
        self.assertEqual(page.evaluate("document.querySelectorAll('#sweep path.jammed').length"), 2)


if __name__ == "__main__":
    main()
