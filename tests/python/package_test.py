#!/usr/bin/python3
"""package_test.py PECLET ENGINE: compares the Python package with `peclet export`, and tests figures."""
import json
import os
import signal
import subprocess
import sys
import tempfile
import time
import unittest
import unittest.mock
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "python"))
import matplotlib
import numpy as np
import peclet
from peclet.dataset import dataset_of
from peclet.drawing import cure_for
from peclet.results import short_names

matplotlib.use("Agg")
PECLET, ENGINE = (os.path.abspath(path) for path in sys.argv[1:3])
SCENE = {
    "particles": {
        "count": 20,
        "density": 0.1,
        "species": [{"radius": 1.0, "volume_share": 0.5}, {"radius": 1.4, "volume_share": 0.5}],
    },
    "volume_fraction": 0.3,
    "fluid": {"viscosity": 0.1},
    "limits": {"shear_rate": 0.045, "thermal_energy": 0.01},
    "peclet": 10,
    "contact": {"normal_stiffness": 1e4},
    "lubrication": {"form": "kim-karrila", "inner_gap": 1e-3, "outer_gap": 0.05},
    "duration": {"equilibration": {"strain": 0.1}, "production": {"strain": 0.2}},
    "observables": ["stress", "trajectory"],
    "trajectory": {"interval": {"strain": 0.05}},
    "files": {"final_configuration": True},
}
SWEEP = {"/peclet": [10, 1000], "/volume_fraction": [0.2, 0.3]}


def export_of(path):
    return json.loads(subprocess.run([PECLET, "export", path], check=True, capture_output=True).stdout)


# Relative viscosities exceed 1 + 2.5 phi, so the first jammed viscosity, 1.5, makes the first point jam.
UNDER_STRESS = SCENE | {
    "fluid": {"viscosity": 1},
    "particles": SCENE["particles"] | {"density": 0.001},
    "flow": {"stress": 5},
    "duration": {"equilibration": {"stress_times": 0.5}, "production": {"stress_times": 12}},
    "observables": ["stress"],
}
UNDER_STRESS = {
    key: value for key, value in UNDER_STRESS.items() if key not in ("peclet", "limits", "trajectory", "files")
}


class OfWhatHasJammed(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scratch = tempfile.TemporaryDirectory()
        path = os.path.join(cls.scratch.name, "still.json")
        sweep = {"/flow/jammed_viscosity": [1.5, 200, 1000]}
        target = {"observable": "shear_rate", "tolerance": 0.5, "minimum": 4, "maximum": 4}
        campaign = peclet.Campaign("still", UNDER_STRESS, sweep, **target, engine=[ENGINE, "serve"])
        cls.results = campaign.run(path, PECLET, ["--quiet"])

    @classmethod
    def tearDownClass(cls):
        cls.scratch.cleanup()

    def test_the_table_says_so_and_has_no_viscosity(self):
        rates = self.results.estimates()
        self.assertEqual(rates["jammed"].tolist(), [True, False, False])
        self.assertEqual(rates["mean"][0], 0)
        self.assertEqual(np.isnan(self.results.estimates("apparent_viscosity")["mean"]).tolist(), [True, False, False])

    def test_a_plot_has_a_cross_at_the_edge_and_no_line_to_it(self):
        for quantity, log, height in (
            ("apparent_viscosity", "", 1),
            ("apparent_viscosity", "y", 1),
            ("shear_rate", "y", 0),
            ("shear_rate", "", None),
        ):
            axes = self.results.plot(quantity, log=log)
            (cross,) = (line for line in axes.lines if line.get_marker() == "x" and len(line.get_xdata()))
            self.assertEqual(cross.get_xdata().tolist(), [1.5])
            if height is not None:
                self.assertEqual(cross.get_ydata().tolist(), [height])
                inside = axes.transAxes.inverted().transform(cross.get_transform().transform(cross.get_xydata()))
                self.assertAlmostEqual(inside[0][1], height)
            self.assertIn("jammed", [text.get_text() for text in axes.get_legend().get_texts()])
            for line in axes.lines:
                if line is not cross:
                    self.assertNotIn(1.5, line.get_xdata())


class BeforeTheFirstStopTest(unittest.TestCase):
    def test_estimates_are_those_of_all_seeds_without_an_interval(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "pilot.json")
            campaign = peclet.Campaign("pilot", SCENE, {"/volume_fraction": [0.2, 0.3]}, engine=[ENGINE, "serve"])
            campaign.write(path)
            subprocess.run([PECLET, "plan", path, "--pilot", "4"], check=True, capture_output=True)
            status = subprocess.run([PECLET, "status", path, "--json"], check=True, capture_output=True)
            rows = list(peclet.open(path, PECLET).estimates())
            self.assertEqual(len(rows), 2)
            for row, point in zip(rows, json.loads(status.stdout)["points"]):
                self.assertTrue(row["provisional"])
                self.assertEqual(row["count"], 4)
                for name in ("mean", "standard_error"):
                    self.assertAlmostEqual(row[name], point["all_seeds"][name], delta=1e-12 * point["all_seeds"][name])
                self.assertTrue(np.isnan(row["half_width"]))


class OfACampaign(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scratch = tempfile.TemporaryDirectory()
        cls.path = os.path.join(cls.scratch.name, "small.json")
        campaign = peclet.Campaign(
            "small", SCENE, SWEEP, tolerance=1e-3, minimum=8, maximum=8, engine=[ENGINE, "serve"]
        )
        cls.results = campaign.run(cls.path, PECLET, ["--quiet"])
        cls.export = export_of(cls.path)

    @classmethod
    def tearDownClass(cls):
        cls.scratch.cleanup()

    def test_estimates_are_the_stop_tests_of_the_export(self):
        table = self.results.estimates()
        self.assertEqual(list(table.columns)[:3], ["peclet", "volume_fraction", "label"])
        self.assertEqual(len(table), 4)
        for row, point in zip(table, self.export["points"]):
            look = point["stop_test"]
            for name in ("mean", "standard_error", "half_width", "count", "lost"):
                self.assertAlmostEqual(row[name], look[name], delta=1e-12 * abs(look[name]), msg=name)
            self.assertEqual((row["label"], row["verdict"]), (point["label"], point["verdict"]))
            self.assertEqual(row["peclet"], point["settings"]["/peclet"])
            self.assertFalse(row["provisional"])

    def test_estimates_of_another_quantity_are_its_means(self):
        for row, point in zip(self.results.estimates("pressure"), self.export["points"]):
            self.assertAlmostEqual(row["mean"], point["quantities"]["pressure"]["mean"], delta=1e-9)
            self.assertEqual(row["verdict"], point["verdict"])

    def test_a_stress_has_a_row_for_each_component(self):
        table = self.results.profile("stress/total", peclet=1000, volume_fraction=0.3)
        self.assertEqual(table["component"].tolist(), ["xx", "yy", "zz", "xy", "xz", "yz"])
        (point,) = (p for p in self.export["points"] if set(p["settings"].values()) == {1000, 0.3})
        np.testing.assert_allclose(table["mean"], point["quantities"]["stress/total"]["mean"])
        self.assertIn("stress/total", self.results.quantities()["quantity"])

    def test_realisations_have_every_seed(self):
        table = self.results.realisations(peclet=10)
        points = [p for p in self.export["points"] if p["settings"]["/peclet"] == 10]
        expected = [(p["label"], r["seed"], r["mean"]["relative_viscosity"]) for p in points for r in p["realisations"]]
        deciding = table.take(table["deciding"])
        self.assertEqual(list(zip(*(deciding[n].tolist() for n in ("label", "seed", "relative_viscosity")))), expected)

    def test_files_are_where_it_says(self):
        paths = self.results.files()
        self.assertGreaterEqual(len(paths), 2 * 32)
        for path in paths:
            self.assertTrue(os.path.exists(path), path)
        label = self.export["points"][0]["label"]
        self.assertLess(len(self.results.files(label)), len(paths))

    def test_a_trajectory_has_the_frames_of_its_seed(self):
        label = self.results.estimates()["label"][0]
        frames = self.results.trajectory(label, 1)
        self.assertGreaterEqual(len(frames), 4)  # a strain of 0.2 in steps of a twentieth
        self.assertEqual(frames[0].particles.N, 20)
        with self.assertRaisesRegex(peclet.PecletError, f"nowhere: must be the label of one point.*{label}"):
            self.results.trajectory("nowhere")
        with self.assertRaisesRegex(peclet.PecletError, "seed 0 of {'peclet': 10}: several points; there are"):
            self.results.trajectory(peclet=10)
        with self.assertRaisesRegex(peclet.PecletError, "seed 99 of .*: no trajectory; there are: .*seed 7"):
            self.results.trajectory(label, 99)

    def test_a_point_is_named_by_its_values_too(self):
        label = "peclet=10 volume_fraction=0.3"
        whole = self.results.files(label)
        self.assertEqual(len(whole), 2 * 8)
        self.assertEqual(self.results.files("10 0.3"), whole)
        self.assertEqual(self.results.files(volume_fraction=0.3, peclet=10), whole)
        frames = self.results.trajectory(seed=2, volume_fraction=0.3, peclet=10)
        np.testing.assert_array_equal(
            frames[1].particles.position, self.results.trajectory(label, 2)[1].particles.position
        )

    def test_one_element_of_a_list_is_a_number(self):
        expected = [point["quantities"]["stress/total"]["mean"][3] for point in self.export["points"]]
        for name in ("stress/total/xy", "stress/total/3", "/stress/total/xy"):
            np.testing.assert_allclose(self.results.estimates(name)["mean"], expected, err_msg=name)
        axes = self.results.plot("stress/total/xy", x="peclet", where={"volume_fraction": 0.3})
        self.assertEqual(axes.get_ylabel(), r"stress, total, xy σ$_{\mathrm{xy}}$ [η γ̇]")
        with self.assertRaisesRegex(
            peclet.PecletError, "is a list by component; name one element, such as stress/total/xx"
        ):
            self.results.estimates("stress/total")
        with self.assertRaisesRegex(peclet.PecletError, r"did you mean relative_viscosity\?"):
            self.results.estimates("relative_viscocity")
        with self.assertRaisesRegex(peclet.PecletError, "stress/total/tt: not measured"):
            self.results.estimates("stress/total/tt")

    def test_a_plot_has_a_series_for_each_value_and_the_intervals_as_bars(self):
        axes = self.results.plot(x="peclet", log="x")
        self.assertEqual(axes.get_xscale(), "log")
        self.assertEqual(axes.get_xlabel(), "Péclet number Pe")
        labels = [text.get_text() for text in axes.get_legend().get_texts()]
        self.assertEqual(labels, ["φ = 0.2", "φ = 0.3", "not converged"])
        table = self.results.estimates().where(volume_fraction=0.2).sorted_by("peclet")
        bars = axes.containers[0].lines[2][0].get_segments()
        for bar, row in zip(bars, table):
            np.testing.assert_allclose(bar[:, 1], [row["mean"] - row["half_width"], row["mean"] + row["half_width"]])

    def test_a_plot_may_have_some_of_the_points(self):
        axes = self.results.plot(x="volume_fraction", where={"peclet": 10}, label="slow")
        self.assertEqual([text.get_text() for text in axes.get_legend().get_texts()], ["slow", "not converged"])
        table = self.results.estimates().where(peclet=10).sorted_by("volume_fraction")
        np.testing.assert_allclose(
            axes.lines[0].get_xydata(), np.column_stack([table["volume_fraction"], table["mean"]])
        )

    def test_plots_in_the_same_axes_have_other_colours_and_marks(self):
        axes = None
        for peclet_number, name in ((10, "slow"), (1000, "fast")):
            axes = self.results.plot(x="volume_fraction", where={"peclet": peclet_number}, label=name, axes=axes)
        self.assertEqual([text.get_text() for text in axes.get_legend().get_texts()], ["slow", "not converged", "fast"])
        slow, _, fast = axes.get_legend().get_lines()
        self.assertNotEqual(slow.get_color(), fast.get_color())
        self.assertNotEqual(slow.get_marker(), fast.get_marker())

    def test_tables_go_to_pandas(self):
        frame = self.results.estimates().to_pandas()
        self.assertEqual(list(frame["label"]), [p["label"] for p in self.export["points"]])

    def test_a_data_set_has_every_quantity_on_the_grid(self):
        data = self.results.to_xarray()
        self.assertEqual(dict(data.sizes), {"peclet": 2, "volume_fraction": 2, "component": 6})
        for point in self.export["points"]:
            one = data.sel(peclet=point["settings"]["/peclet"], volume_fraction=point["settings"]["/volume_fraction"])
            self.assertEqual((one["label"], one["verdict"]), (point["label"], point["verdict"]))
            self.assertEqual((one["seeds"], one["lost"], one["jammed"].item()), (8, 0, False))
            for name, there in point["quantities"].items():
                known = point["stop_test"] if name == "relative_viscosity" else there
                name = name.replace("/", "_")
                for number, ending in (("mean", ""), ("standard_error", "_standard_error"), ("count", "_count")):
                    np.testing.assert_allclose(one[name + ending], known[number], rtol=1e-12, err_msg=name + ending)
                self.assertEqual(one[name].attrs["units"], there["unit"])
            half_width = one["relative_viscosity_half_width"].item()
            self.assertAlmostEqual(half_width, point["stop_test"]["half_width"], delta=1e-12)
        self.assertEqual(data["component"].values.tolist(), ["xx", "yy", "zz", "xy", "xz", "yz"])
        self.assertEqual(data.attrs, {"campaign": "small", "target": "relative_viscosity", "confidence": 0.95})

    def test_a_data_set_without_xarray_says_how_to_install_it(self):
        with unittest.mock.patch.dict(sys.modules, xarray=None):
            with self.assertRaisesRegex(peclet.PecletError, "^data sets need xarray: .*xarray$"):
                self.results.to_xarray()

    def test_jamming_points_are_asked_of_the_program_by_this_python(self):
        found = self.results.jamming("--by=law")
        self.assertEqual(found["over"], "/volume_fraction")
        self.assertEqual([curve["settings"] for curve in found["curves"]], [{"/peclet": 10}, {"/peclet": 1000}])
        self.assertRegex(found["curves"][0]["law"]["obstacle"], "^0 of the 4 flowing points")

    def test_laws_are_asked_of_the_program_by_this_python(self):
        found = self.results.fit("divergence", "--fix=exponent=2")
        self.assertEqual((found["over"], found["given"]["fixed"]), ("/volume_fraction", {"exponent": 2}))
        self.assertEqual([curve["settings"] for curve in found["curves"]], [{"/peclet": 10}, {"/peclet": 1000}])
        self.assertRegex(found["curves"][0]["law"]["obstacle"], " points with an error for 2 parameters: at least 3 ")

    def test_what_is_not_there_is_said(self):
        with self.assertRaisesRegex(peclet.PecletError, "viscosty: not measured; there are .*relative_viscosity"):
            self.results.profile("viscosty")
        with self.assertRaisesRegex(peclet.PecletError, "absent.peclet: no such file or folder"):
            peclet.open("absent.peclet")
        for kind in (KeyError, peclet.PecletError):
            with self.assertRaisesRegex(kind, "^colour: no such column; there are peclet"):
                self.results.estimates().where(colour=1)
        with self.assertRaisesRegex(peclet.PecletError, "no-such-peclet: no such program"):
            peclet.open(self.path, program="no-such-peclet").estimates()

    def test_faulty_input_is_said_as_the_program_says_it(self):
        campaign = peclet.Campaign("faulty", {**SCENE, "volume_fraction": 2}, engine=[ENGINE, "serve"])
        path = os.path.join(self.scratch.name, "faulty.json")
        with self.assertRaisesRegex(peclet.PecletError, "volume_fraction"):
            campaign.validate(path, PECLET)
        with self.assertRaisesRegex(peclet.PecletError, "^peclet: .*faulty.json: /scene/volume_fraction: 2: must be"):
            campaign.run(path, PECLET)


class Files(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.path = os.path.join(scratch.name, "flow.json")

    def test_a_fixed_number_of_realisations_is_in_the_place_of_the_target(self):
        document = peclet.Campaign("flow", SCENE, SWEEP, observable="pressure", realisations=16).document
        self.assertEqual((document["realisations"], document["show"]), (16, ["pressure"]))
        self.assertNotIn("target", document)

    def test_may_have_comments_and_ranges(self):
        scene = os.path.join(os.path.dirname(self.path), "scene.json")
        with open(scene, "w", encoding="utf-8") as file:
            file.write('// "a"\n{"note": "// \\" /* kept */", /* gone */ "peclet": 1}')
        pe = {"from": 1, "to": 100, "points": 3, "spaced": "log"}
        document = peclet.Campaign("flow", scene, {"/peclet": pe}).document
        self.assertEqual(document["scene"], {"note": '// " /* kept */', "peclet": 1})
        self.assertEqual(document["sweep"], [{"set": "/peclet", "values": pe}])

    def test_only_a_campaign_of_the_same_name_is_overwritten(self):
        peclet.Campaign("flow", SCENE).write(self.path)
        written = Path(self.path).read_bytes()
        peclet.Campaign("flow", SCENE, tolerance=0.01).write(self.path)
        self.assertNotEqual(Path(self.path).read_bytes(), written)
        self.assertEqual(os.listdir(os.path.dirname(self.path)), ["flow.json"])
        of_another_name = json.loads(written) | {"name": "other"}
        for earlier in (json.dumps(SCENE), json.dumps(of_another_name), "not JSON", "[1]", "3", ""):
            Path(self.path).write_text(earlier)
            with self.assertRaisesRegex(
                peclet.PecletError, "flow.json: is there already and not a campaign of the name flow"
            ):
                peclet.Campaign("flow", SCENE).validate(self.path, PECLET)
            self.assertEqual(Path(self.path).read_text(), earlier)

    def test_the_file_that_the_scene_was_read_from_is_not_overwritten(self):
        peclet.Campaign("flow", SCENE).write(self.path)
        with self.assertRaises(peclet.PecletError):
            peclet.Campaign("flow", self.path).write(self.path)
        self.assertEqual(json.loads(Path(self.path).read_text())["scene"], SCENE)

    def test_what_cannot_be_read_or_written_is_said(self):
        with self.assertRaisesRegex(peclet.PecletError, "flow.json: cannot be read as a scene: No such file"):
            peclet.Campaign("flow", self.path)
        Path(self.path).write_text("{")
        with self.assertRaisesRegex(peclet.PecletError, "flow.json: cannot be read as a scene: Expecting"):
            peclet.Campaign("flow", self.path)
        with self.assertRaisesRegex(peclet.PecletError, "absent/flow.json: cannot be written: No such file"):
            peclet.Campaign("flow", SCENE).write(os.path.join(os.path.dirname(self.path), "absent", "flow.json"))
        with self.assertRaisesRegex(peclet.PecletError, "must be something that a JSON file may hold"):
            peclet.Campaign("other", {"key": {1}}).write(os.path.join(os.path.dirname(self.path), "other.json"))

    def test_numbers_of_numpy_are_numbers(self):
        scene = SCENE | {"peclet": np.float32(2), "volume_fraction": np.float64(0.25)}
        campaign = peclet.Campaign("numbers", scene, {"/particles/count": np.arange(20, 40, 10)})
        document = json.loads(Path(campaign.write(self.path)).read_text())
        self.assertEqual(document["sweep"], [{"set": "/particles/count", "values": [20, 30]}])
        self.assertEqual((document["scene"]["peclet"], document["scene"]["volume_fraction"]), (2, 0.25))


# Replaces peclet: reports that it runs, and after a signal the signals of the next second.
PROGRAM = f"""#!{sys.executable}
import signal, sys, time
came = []
for number in (signal.SIGINT, signal.SIGTERM):
    signal.signal(number, lambda number, _: came.append(signal.Signals(number).name))
open("ready", "w").close()
deadline = time.monotonic() + 60
while not came and time.monotonic() < deadline:
    time.sleep(0.01)
time.sleep(1)
with open("came", "w") as file:
    file.write(" ".join(came))
sys.exit(75)
"""


class Interrupted(unittest.TestCase):
    def came(self, send):
        """Returns the signals that reach the program when `send` acts on Python, which calls run()."""
        with tempfile.TemporaryDirectory() as folder:
            program = Path(folder, "program")
            program.write_text(PROGRAM)
            program.chmod(0o755)
            script = (
                "import peclet, signal; signal.signal(signal.SIGINT, signal.default_int_handler);"
                "peclet.Campaign('slow', {}).run(program='./program')"
            )
            environment = {**os.environ, "PYTHONPATH": str(ROOT / "python")}
            python = subprocess.Popen(
                [sys.executable, "-c", script],
                cwd=folder,
                env=environment,
                start_new_session=True,
                stderr=subprocess.PIPE,
                text=True,
            )
            self.wait_for(Path(folder, "ready"))
            send(python.pid)
            said = python.communicate()[1]
            came = Path(folder, "came")
            self.wait_for(came)
            return came.read_text(), said

    def wait_for(self, path):
        deadline = time.monotonic() + 30
        while not path.exists():
            self.assertLess(time.monotonic(), deadline, path)
            time.sleep(0.01)

    def test_the_program_may_write_its_checkpoints(self):
        for send in (os.kill, os.killpg):
            came, said = self.came(lambda process: send(process, signal.SIGINT))
            self.assertEqual(came, "SIGINT")
            self.assertIn("KeyboardInterrupt: slow.json: stopped; run it again to go on", said)

    def test_the_program_does_not_outlive_python(self):
        self.assertEqual(self.came(lambda process: os.kill(process, signal.SIGKILL))[0], "SIGTERM")


class Words(unittest.TestCase):
    """Swept values that are words and numbers."""

    @classmethod
    def setUpClass(cls):
        cls.scratch = tempfile.TemporaryDirectory()
        sweep = {"/integrator/timestep": ["auto", 0.01, 0.005], "/contact/friction": [0, 1]}
        scene = {key: value for key, value in SCENE.items() if key not in ("observables", "trajectory", "files")}
        campaign = peclet.Campaign("2024", scene, sweep, minimum=2, maximum=2, engine=[ENGINE, "serve"])
        cls.results = campaign.run(os.path.join(cls.scratch.name, "words.json"), PECLET, ["--quiet"])

    @classmethod
    def tearDownClass(cls):
        cls.scratch.cleanup()

    def test_are_chosen_as_what_they_are(self):
        for table in (self.results.estimates(), self.results.realisations()):
            for value in ("auto", 0.01, 0.005):
                chosen = table.where(timestep=value)
                self.assertEqual(len(chosen), len(table) / 3)
                self.assertEqual(set(chosen["timestep"].tolist()), {value})

    def test_are_ordered_after_numbers(self):
        ordered = self.results.estimates().sorted_by("friction", "timestep")["timestep"]
        self.assertEqual(ordered.tolist(), 2 * [0.005, 0.01, "auto"])

    def test_are_ticks_of_an_axis_and_names_of_series(self):
        axes = self.results.plot(x="timestep")
        self.assertEqual([tick.get_text() for tick in axes.get_xticklabels()], ["auto", "0.01", "0.005"])
        table = self.results.estimates().where(friction=1)
        expected = [table.where(timestep=value)["mean"][0] for value in ("auto", 0.01, 0.005)]
        np.testing.assert_allclose(axes.lines[1].get_xydata(), np.column_stack([[0, 1, 2], expected]))
        series = self.results.plot(x="friction").get_legend().get_texts()
        names = [f"timestep = {value}" for value in ("auto", "0.01", "0.005")]
        self.assertEqual([text.get_text() for text in series], [*names, "not converged"])
        with self.assertRaisesRegex(peclet.PecletError, "timestep: has words, and no logarithmic axis"):
            self.results.plot(x="timestep", log="xy")

    def test_a_swept_number_is_told_from_a_column_of_the_same_name(self):
        campaign = peclet.Campaign(
            "sizes", SCENE, {"/particles/count": [20, 30]}, minimum=2, maximum=2, engine=[ENGINE, "serve"]
        )
        results = campaign.run(os.path.join(self.scratch.name, "sizes.json"), PECLET, ["--quiet"])
        for table in (results.estimates(), results.estimates("pressure")):
            self.assertEqual((table["particles_count"].tolist(), table["count"].tolist()), ([20, 30], [2, 2]))
        self.assertEqual(set(results.realisations(particles_count=30)["label"].tolist()), {"count=30"})
        axes = results.plot()
        self.assertEqual((axes.get_xlabel(), axes.lines[0].get_xdata().tolist()), ("number of particles N", [20, 30]))

    def test_a_measured_number_or_an_axis_is_told_from_what_is_swept(self):
        class Same(peclet.Results):
            def export(self):
                result = {"seed": 0, "mean": {"rate": 7, "eta": 2}, "cost": {"cpu_seconds": 1}}
                point = {"label": "rate=1", "settings": {"/flow/rate": 1}, "realisations": [result], "extra": []}
                return {"points": [point]}

            def _rows(self, form):
                return [{"label": "rate=1", "/flow/rate": "1", "quantity": "G", "axis_1": "rate", "axis_1_value": "5"}]

        table = Same("nowhere").realisations(rate=1)
        self.assertEqual(
            (table["rate"].tolist(), table["measured_rate"].tolist(), table["eta"].tolist()), ([1], [7], [2])
        )
        profile = Same("nowhere").profile("G", rate=1)
        self.assertEqual((profile["rate"].tolist(), profile["axis_rate"].tolist()), ([1], [5]))

    def test_a_label_is_text_whatever_it_looks_like(self):
        campaign = peclet.Campaign("2024", SCENE, minimum=2, maximum=2, engine=[ENGINE, "serve"])
        results = campaign.run(os.path.join(self.scratch.name, "2024.json"), PECLET, ["--quiet"])
        self.assertEqual(results.estimates()["label"].tolist(), ["2024"])
        self.assertEqual(len(results.estimates("pressure").where(label="2024")), 1)


class DataSets(unittest.TestCase):
    """Data sets of points and quantities that are given here."""

    @staticmethod
    def of(swept, values, quantities=()):
        points = [{"label": str(k), **dict(zip(swept, own)), "seeds": float(k)} for k, own in enumerate(values)]
        return dataset_of(swept, points, dict(quantities), {})

    @staticmethod
    def along(axis, values):
        """Returns a quantity whose value at each place of point k is k plus the place."""
        rows = [{"label": str(k), "at": (one,), "": k + one} for k, own in enumerate(values) for one in own]
        return {"attributes": {}, "axes": [(axis, "1")], "rows": rows}

    def test_a_parameter_that_follows_from_others_is_a_coordinate(self):
        swept = {"strain": "/duration/production/strain", "phi": "/phi", "pe": "/pe", "count": "/particles/count"}
        data = self.of(swept, [(5 if pe == 1 else 7, phi, pe, 40) for phi in (0.3, 0.2) for pe in (100, 1)])
        self.assertEqual(dict(data.sizes), {"phi": 2, "pe": 2})
        self.assertEqual((data["strain"].dims, data["strain"].values.tolist()), (("pe",), [5, 7]))
        self.assertEqual((data["count"].dims, data["count"].item()), ((), 40))
        self.assertEqual(data["seeds"].values.tolist(), [[3, 2], [1, 0]])
        tied = self.of({"strain": "/duration/strain", "phi": "/phi"}, [(9, 0.2), (8, 0.3)])
        self.assertEqual((dict(tied.sizes), tied["strain"].values.tolist()), ({"phi": 2}, [9, 8]))

    def test_places_that_are_no_points_are_blank(self):
        data = self.of({"a": "/a", "b": "/b"}, [(1, 1), (1, "auto"), (2, 1)])
        self.assertEqual(data["b"].values.tolist(), [1, "auto"])
        self.assertEqual(data["label"].values.tolist(), [["0", "1"], ["2", ""]])
        np.testing.assert_array_equal(data["seeds"], [[0, 1], [2, np.nan]])

    def test_a_single_point_has_no_dimensions(self):
        self.assertEqual(self.of({}, [()])["seeds"].item(), 0)

    def test_an_axis_that_begins_alike_at_all_points_is_a_dimension(self):
        long, short = self.along("time", [[1.0, 2.0], [1.0, 2.0, 3.0]]), self.along("time", [[1.0], [1.0]])
        data = self.of({"a": "/a"}, [(5,), (6,)], {"G/storage": long})
        np.testing.assert_array_equal(data["G_storage"].sel(a=5), [1, 2, np.nan])
        self.assertEqual(data["G_storage"].sel(a=6, time=3), 4)
        both = self.of({"a": "/a"}, [(5,), (6,)], {"G/storage": long, "G/loss": long, "C": short})
        self.assertEqual(both["G_loss"].dims, ("a", "G_storage_time"))
        self.assertEqual(both["C"].dims, ("a", "C_time"))

    def test_an_axis_that_depends_on_the_point_is_a_coordinate_along_its_elements(self):
        data = self.of({"a": "/a"}, [(5,), (6,)], {"G": self.along("a", [[1.0, 2.0], [0.5]])})
        self.assertEqual(data["G"].dims, ("a", "axis_a_element"))
        np.testing.assert_array_equal(data["axis_a"], [[1, 2], [0.5, np.nan]])
        np.testing.assert_array_equal(data["G"], [[1, 2], [1.5, np.nan]])

    def test_a_quantity_is_told_from_what_is_swept(self):
        number = {"attributes": {}, "axes": [], "rows": [{"label": "0", "at": (), "": 7}]}
        data = self.of({"phi": "/phi"}, [(0.3,)], {"phi": number})
        self.assertEqual((data["phi"].item(), data["measured_phi"].item()), (0.3, 7))


class Tables(unittest.TestCase):
    TABLE = peclet.Table({"a": [1.0, 2.0, 0.1 + 0.2], "b": ["x", "<y>", "x"]})

    def test_rows_are_chosen_by_value(self):
        self.assertEqual(self.TABLE.where(b="x")["a"].tolist(), [1.0, 0.1 + 0.2])
        self.assertEqual(len(self.TABLE.where(a=0.3, b="x")), 1)

    def test_rows_are_shown_in_columns_and_escaped_in_html(self):
        self.assertEqual(repr(self.TABLE).split("\n")[1].split(), ["1", "x"])
        self.assertIn("<td>&lt;y&gt;</td>", self.TABLE._repr_html_())

    def test_columns_have_one_length(self):
        with self.assertRaises(ValueError):
            peclet.Table({"a": [1], "b": [1, 2]})


class Names(unittest.TestCase):
    def test_of_what_is_swept_are_as_short_as_they_can_be(self):
        names = short_names(["/contact/friction", "/rolling/friction", "/peclet"])
        self.assertEqual(list(names.values()), ["contact_friction", "rolling_friction", "peclet"])

    def test_of_what_is_swept_are_not_those_of_other_columns(self):
        names = short_names(["/particles/count", "/variables/mean"])
        self.assertEqual(list(names.values()), ["particles_count", "variables_mean"])

    def test_of_cures_are_those_of_this_python(self):
        for prefix, there, cure in (
            ("/usr", ["/etc/debian_version"], "apt install python3-gsd"),
            ("/opt/conda", ["/opt/conda/conda-meta"], "conda install -c conda-forge gsd"),
            ("/home/a b/.pyenv", ["/etc/debian_version"], f"{sys.executable} -m pip install gsd"),
        ):
            with unittest.mock.patch.object(sys, "prefix", prefix), unittest.mock.patch(
                "os.path.exists", there.__contains__
            ):
                self.assertEqual(cure_for("gsd", "python3-gsd"), cure)


class Installed(unittest.TestCase):
    def test_by_pip_from_the_checkout_it_imports_with_the_version_of_the_project(self):
        with tempfile.TemporaryDirectory() as folder:
            pip = [sys.executable, "-m", "pip", "install", "--quiet", "--no-deps", "--no-build-isolation"]
            # pip builds in the source folder, so it gets a copy and leaves the checkout clean.
            subprocess.run(["cp", "-r", ROOT / "python", os.path.join(folder, "source")], check=True)
            target = os.path.join(folder, "target")
            subprocess.run([*pip, "--target", target, os.path.join(folder, "source")], check=True, capture_output=True)
            said = subprocess.run(
                [sys.executable, "-c", "import importlib.metadata as m, peclet; print(m.version('peclet'))"],
                env={**os.environ, "PYTHONPATH": target},
                check=True,
                capture_output=True,
                text=True,
                cwd=folder,
            ).stdout
        version = subprocess.run([PECLET, "--version"], check=True, capture_output=True, text=True).stdout
        self.assertEqual(said.strip(), version.split()[1])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
