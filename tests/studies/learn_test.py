#!/usr/bin/python3
"""Tests of learn.py with exports, tables and models, and its refusals."""
import csv
import json
import os
import stat
import subprocess
import tempfile
import unittest
from pathlib import Path

import numpy as np

SOURCE = Path(__file__).resolve().parent.parent.parent
LEARN = SOURCE / "results" / "learned-rheology" / "learn.py"

SCENE = {
    "particles": {"count": 10, "species": [{"radius": 1.0}]},
    "volume_fraction": 0.5,
    "box": {"height": 8},
    "fluid": {"viscosity": 0.1},
    "flow": {"shear_rate": 0, "waves": [{"periods": 1, "sine": 0.2}], "faxen": False},
    "profiles": {"bins": 4},
}


def realisation(pressure):
    profiles = {
        "volume_fraction": [0.5] * 4,
        "volume_fraction_by_radius": [[0.2] * 4, [0.3] * 4],
        "velocity": {"flux": [0.05, 0.05, -0.05, -0.05], "volume_fraction": [0.5] * 4},
        "velocity_variance": [[0.01] * 4] * 3,
        "stress": {"pairs": [[-pressure] * 4] * 3 + [[0.5, -0.5, -0.5, 0.5]]},
    }
    return {"mean": {"profiles": profiles}}


class Learn(unittest.TestCase):
    def setUp(self):
        self._folder = tempfile.TemporaryDirectory()
        self.addCleanup(self._folder.cleanup)
        self.folder = Path(self._folder.name)

    def learn(self, *words):
        """Returns exit code, output and errors."""
        environment = {**os.environ, "PECLET": str(self.folder / "peclet")}
        done = subprocess.run(
            [LEARN, *map(str, words)], cwd=self.folder, env=environment, capture_output=True, text=True
        )
        return done.returncode, done.stdout, done.stderr

    def exporting(self, points, quarters=()):
        """Writes a peclet that exports these points, with volume fractions by seed and quarter."""
        (self.folder / "export").write_text(json.dumps({"campaign": "waves", "points": points}))
        blocks = ({"blocks": {"profiles": {"volume_fraction": one}}} for one in quarters)
        lines = [json.dumps({"deciding": True, "label": "one", "result": result}) for result in blocks]
        (self.folder / "results").write_text("\n".join(lines))
        program = self.folder / "peclet"
        program.write_text(f'#!/bin/sh\ncat "{self.folder}/$1"\n')
        program.chmod(program.stat().st_mode | stat.S_IXUSR)

    def table(self, flows=("a", "b", "c")):
        """Writes bins with mu = 100 J, known to a tenth."""
        path = self.folder / "bins.csv"
        with open(path, "w", newline="") as f:
            writer = csv.writer(f)
            writer.writerow(["flow", "mean", "J", "fraction", "mu", "mu_error"])
            for flow in flows:
                for j in np.geomspace(1e-3, 1e-2, 12):
                    writer.writerow([flow, 0.5, j, 0.5 + j, 100 * j, 10 * j])
        return path

    def test_bins_of_an_export_have_errors_over_the_seeds(self):
        self.exporting([{"label": "height=8", "scene": SCENE, "realisations": [realisation(2), realisation(4)]}])
        code, text, _ = self.learn("bins", "waves.json")
        self.assertEqual(code, 0)
        rows = list(csv.DictReader(text.splitlines()))
        self.assertEqual([row["flow"] for row in rows], ["waves height=8"] * 4)
        self.assertAlmostEqual(float(rows[0]["pressure"]), 3)
        self.assertAlmostEqual(float(rows[0]["pressure_error"]), 1)
        self.assertAlmostEqual(float(rows[0]["rate"]), (0.1 - -0.1) / 4)
        self.assertAlmostEqual(float(rows[0]["mu"]), 0.5 / 3, places=5)
        self.assertAlmostEqual(float(rows[0]["largest share"]), 0.6)
        # A sine of four bins: every bin is an image of the first.
        code, text, _ = self.learn("bins", "--symmetric", "waves.json")
        self.assertEqual(code, 0)
        (one,) = csv.DictReader(text.splitlines())
        self.assertAlmostEqual(float(one["shear stress"]), 0.5)

    def test_a_profile_that_still_grows_is_told(self):
        points = [{"label": "one", "scene": SCENE, "realisations": [realisation(2), realisation(4)]}]
        steady = [[0.4, 0.5, 0.6, 0.5]] * 2
        grown = [[0.35, 0.5, 0.65, 0.5]] * 2
        for later, told in ((steady, False), (grown, True)):
            self.exporting(points, [steady + later] * 3)
            code, _, errors = self.learn("bins", "waves.json")
            self.assertEqual(code, 0)
            self.assertEqual("stands out +40 ± 0 % more" in errors, told, errors)

    def test_campaigns_of_other_kinds_are_refused_with_the_pointer(self):
        sheared = {**SCENE, "flow": {"shear_rate": 1}}
        cube = {name: block for name, block in SCENE.items() if name != "box"}
        two = [realisation(2), realisation(4)]
        for scene, seeds, words in (
            (sheared, two, "/flow/shear_rate: must be 0"),
            (cube, two, "/box/height: missing"),
            (SCENE, two[:1], "1 seeds with means"),
            (SCENE, [{"mean": {}}, {"mean": {"profiles": {}}}] + two[:0], "must have two or more"),
            (SCENE, [{"mean": {"profiles": {"volume_fraction": []}}}] * 2, "/observables must list profiles"),
        ):
            self.exporting([{"label": "one", "scene": scene, "realisations": seeds}])
            code, text, errors = self.learn("bins", "waves.json")
            self.assertEqual((code, text), (2, ""), errors)
            self.assertIn(words, errors)

    def test_a_model_is_opened_again_and_warns_beyond_its_training(self):
        self.table()
        inputs = ("--inputs", "J", "mean", "--output", "mu")
        self.assertEqual(self.learn("train", "bins.csv", *inputs, "--model", "mu.json")[0], 0)
        model = json.loads((self.folder / "mu.json").read_text())
        self.assertEqual(model["provenance"]["flows"], ["a", "b", "c"])
        code, text, errors = self.learn("predict", "mu.json", "bins.csv")
        self.assertEqual((code, errors), (0, ""))
        for row in csv.DictReader(text.splitlines()):
            self.assertAlmostEqual(float(row["mu foretold"]) / (100 * float(row["J"])), 1, delta=0.05)
        (self.folder / "new.csv").write_text("flow,mean,J\nx,0.5,1e-1\n")
        code, text, errors = self.learn("predict", "mu.json", "new.csv")
        self.assertEqual(code, 0)
        self.assertIn("1 of 1 rows lie beyond what the model was trained on", errors)
        # The training range of ln J is 1e-3 to 1e-2, so another decade is beyond by one range.
        self.assertAlmostEqual(float(list(csv.DictReader(text.splitlines()))[0]["beyond"]), 1, places=2)

    def test_errors_are_of_flows_that_were_left_out(self):
        self.table()
        code, text, _ = self.learn("errors", "bins.csv", "--inputs", "J", "mean", "--output", "mu")
        self.assertEqual(code, 0)
        errors = {line[:28].strip(): float(line[28:]) for line in text.splitlines()[1:]}
        self.assertLess(errors["J alone"], 1e-6)
        mu = np.geomspace(0.1, 1, 12)
        floor = 0.1 * np.linalg.norm(mu) / np.linalg.norm(mu - 0.1)  # both scaled by 0.9
        self.assertAlmostEqual(errors["noise of the bins"], floor, places=4)
        self.assertLess(errors["gaussian process"], 0.05)
        self.table(["a"])
        code, _, words = self.learn("errors", "bins.csv", "--inputs", "J", "mean", "--output", "mu")
        self.assertEqual(code, 2)
        self.assertIn("bins of 1 flow", words)

    def test_rows_that_lack_a_number_are_told(self):
        table = self.table()
        table.write_text(table.read_text() + "c,0.5,,0.5,1,1\n")
        code, _, errors = self.learn("train", "bins.csv", "--inputs", "J", "--output", "mu", "--model", "m")
        self.assertEqual(code, 0)
        self.assertIn("1 of 37 rows are left out", errors)

    def test_what_is_not_there_is_refused(self):
        self.table()
        (self.folder / "words.csv").write_text("flow,mean,J,mu\na,0.5,often,1\n")
        for words, said in (
            (("train", "bins.csv", "--inputs", "J", "--output", "nu", "--model", "m"), "nu: must be one of"),
            (("train", "bins.csv", "--inputs", "J", "Theta", "--output", "mu", "--model", "m"), "no column Theta"),
            (("train", "no.csv", "--inputs", "J", "--output", "mu", "--model", "m"), "no.csv: No such file"),
            (("train", "words.csv", "--inputs", "J", "--output", "mu", "--model", "m"), "often: must be a number"),
            (("predict", "bins.csv", "bins.csv"), "bins.csv: Expecting value"),
            (("predict", "no.json", "bins.csv"), "no.json: No such file"),
        ):
            code, _, errors = self.learn(*words)
            self.assertEqual(code, 2, errors)
            self.assertIn(said, errors)
            self.assertNotIn("Traceback", errors)
            self.assertFalse((self.folder / "m").exists())


if __name__ == "__main__":
    unittest.main()
