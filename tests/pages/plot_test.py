#!/usr/bin/python3
"""plot_test.py BIN: figures of `peclet plot`, compared with the export, the page and matplotlib."""

import json
import math
import os
import re
import runpy
import subprocess

from campaign_page import SCENE, choose, rows, saved
from page_case import PageTest, Stage, main

QUANTITIES = ["relative_viscosity", "pressure", "first_normal_difference", "stress/total/xy"]
NUMBERS = ("mean", "standard_error", "half_width")


def peclet(*words, path="/usr/bin:/bin"):
    """Runs the program with Debian's python3 and returns its result."""
    binaries = Stage.folder.environment["PATH"].partition(":")[0]
    environment = dict(os.environ, PATH=f"{binaries}:{path}")
    command = ["peclet", *words]
    return subprocess.run(command, cwd=Stage.folder.path, env=environment, capture_output=True, text=True)


def figure_of(name):
    """Returns the numbers in a script; reading them draws nothing."""
    return runpy.run_path(Stage.folder.file(name))["FIGURE"]


def drawn_by(name):
    """Returns the figure that a script makes of its numbers, and its axes."""
    import matplotlib

    matplotlib.use("Agg")
    script = runpy.run_path(Stage.folder.file(name))
    figure = script["figure_of"](script["FIGURE"])
    (axes,) = script["draw"](figure)[1]
    return figure, axes


def points_of(figure):
    return {point["label"]: point for point in figure["points"]}


def text_of(parts):
    return "".join(part["text"] for part in parts)


class Figures(PageTest):
    def draw(self, *words, output="figure.svg"):
        drawn = peclet("plot", "curve.json", "--output", output, *words)
        self.assertEqual(drawn.returncode, 0, drawn.stderr)
        return figure_of(output.rpartition(".")[0] + ".py")

    def test_have_the_numbers_of_the_export(self):
        export = json.loads(Stage.folder.peclet("export", "curve.json"))
        long = rows(Stage.folder.peclet("export", "curve.json", "--long"))
        for quantity in QUANTITIES:
            figure = self.draw("--quantity", quantity)
            marks = points_of(figure)
            self.assertEqual(len(marks), len(export["points"]))
            for point in export["points"]:
                mark = marks[point["label"]]
                name, _, element = quantity.rpartition("/")
                (row,) = [
                    row
                    for row in long
                    if row["label"] == point["label"]
                    and (row["quantity"], row["axis_1_value"]) == (name or quantity, element if name else "")
                ]
                # The target has the stop test's numbers: sums in another order, and a wider interval.
                expected = (
                    point["stop_test"] if quantity == QUANTITIES[0] else {key: float(row[key]) for key in NUMBERS}
                )
                self.assertEqual({key: mark[key] for key in NUMBERS}, {key: expected[key] for key in NUMBERS})
                self.assertEqual(mark["count"], int(row["count"]))
                self.assertAlmostEqual(mark["mean"], float(row["mean"]), delta=1e-12 * abs(mark["mean"]))
                self.assertEqual(mark["settings"], point["settings"])

    def test_have_a_curve_for_each_value_of_what_else_is_swept(self):
        for over, curves in (("peclet", 3), ("/volume_fraction", 3)):
            self.assertEqual(self.draw("--over", over)["over"].rpartition("/")[2], over.rpartition("/")[2])
            figure, _ = drawn_by("figure.py")
            self.assertEqual(len(figure["legend"]), curves)
            for place in range(curves):
                x = [mark["x"] for mark in figure["panels"][0]["marks"] if mark["series"] == place]
                self.assertEqual((len(x), x), (3, sorted(x)))

    def test_have_the_page_s_scales_and_titles(self):
        page = self.open()
        for quantity in QUANTITIES[:3]:
            choose(page, "#quantity", quantity.replace("_", " "))
            for over, words in (("peclet", "Péclet number"), ("volume_fraction", "volume fraction")):
                choose(page, "#axis", words)
                self.draw("--quantity", quantity, "--over", over)
                figure, axes = drawn_by("figure.py")
                label = page.evaluate("document.querySelector('#sweep svg').getAttribute('aria-label')")
                titles = [
                    text_of(runpy.run_path(Stage.folder.file("figure.py"))["title_of"](figure[axis]["about"]))
                    for axis in "yx"
                ]
                self.assertEqual(" over ".join(titles), label.partition(";")[0])
                for axis, scale in (("x", axes.get_xscale()), ("y", axes.get_yscale())):
                    checked = page.evaluate(f"document.getElementById('log-{axis}').checked")
                    self.assertEqual(scale == "log", checked, (quantity, over, axis))

    def test_of_open_points_are_provisional(self):
        drawn = peclet("plot", "young.json", "--output", "young.svg")
        self.assertEqual(drawn.returncode, 0, drawn.stderr)
        marks = points_of(figure_of("young.py"))
        exported = {row["label"]: row for row in rows(Stage.folder.peclet("export", "young.json", "--csv"))}
        for label, row in exported.items():
            self.assertEqual(marks[label]["state"], "provisional")
            self.assertAlmostEqual(marks[label]["mean"], float(row["all_seeds_mean"]), places=12)
            self.assertIsNone(marks[label]["good_enough"])


START = {
    "name": "start",
    "scene": {
        **SCENE,
        "observables": ["stress", "transient", "pair_distribution"],
        "transient": {"bins": 12},
        "pair_distribution": {"range": 2.4, "bin": 0.2},
    },
    "sweep": [{"set": "/volume_fraction", "values": [0.1, 0.3]}, {"set": "/peclet", "values": [10, 100]}],
    "realisations": 5,
    "show": ["relative_viscosity"],
}


class TwoCampaigns(PageTest):
    def test_are_in_one_figure_with_their_names_and_numbers(self):
        own = {name: json.loads(peclet("plot", name + ".json", "--json").stdout) for name in ("curve", "young")}
        drawn = peclet("plot", "curve.json", "--with", "young.json", "--output", "two.svg")
        self.assertEqual(drawn.returncode, 0, drawn.stderr)
        both = figure_of("two.py")
        for name, figure in own.items():
            for point in figure["points"]:
                point["settings"]["campaign"] = name
        self.assertEqual(both["points"], own["curve"]["points"] + own["young"]["points"])


class Curves(PageTest):
    @classmethod
    def setUpClass(cls):
        Stage.folder.peclet("run", Stage.folder.write(START), "--quiet")
        Stage.folder.report("start.json")

    def draw(self, *words):
        drawn = peclet("plot", "start.json", "--output", "start.png", *words)
        self.assertEqual(drawn.returncode, 0, drawn.stderr)
        return figure_of("start.py")

    def exported(self, quantity, number):
        """Returns a number of the long export by label, in the order of the axis; None where it is empty."""
        found = {}
        for row in rows(Stage.folder.peclet("export", "start.json", "--long")):
            if row["quantity"] == quantity:
                found.setdefault(row["label"], []).append(float(row[number]) if row[number] else None)
        return found

    def test_have_the_numbers_of_the_export(self):
        for quantity in ("transient/shear_stress", "pair_distribution/radial"):
            drawn = points_of(self.draw("--quantity", quantity))
            for name, column in (("x", "axis_1_value"), *((number, number) for number in NUMBERS)):
                exported = self.exported(quantity, column)
                self.assertEqual({label: point[name] for label, point in drawn.items()}, exported, (quantity, name))

    # Student's t of five seeds at 95 %: 2.776445.
    def test_are_means_over_the_seeds_with_student_s_interval(self):
        drawn = points_of(self.draw("--quantity", "transient/shear_stress"))
        for point in self.export()["points"]:
            seeds = [one["mean"]["transient"]["shear_stress"] for one in point["realisations"]]
            for place, values in enumerate(zip(*seeds)):
                mean = sum(values) / 5
                error = (sum((value - mean) ** 2 for value in values) / 4 / 5) ** 0.5
                self.assertAlmostEqual(drawn[point["label"]]["mean"][place], mean, delta=1e-9 * abs(mean))
                half = drawn[point["label"]]["half_width"][place]
                self.assertAlmostEqual(half, 2.776445105 * error, delta=1e-6 * error)

    def test_are_scaled_by_the_formulas(self):
        plain = points_of(self.draw("--quantity", "transient/shear_stress", "--where", "peclet=10"))
        scaled = points_of(
            self.draw("--quantity", "transient/shear_stress", "--where", "peclet=10", "--scale-y", "thermal_stress")
        )
        self.assertEqual((set(scaled), len(scaled)), (set(plain), 2))
        for label, point in scaled.items():
            # Pe = 6 pi eta a^3 rate / kT, so that eta rate a^3 / kT = Pe / 6 pi.
            for ours, given in zip(point["mean"], plain[label]["mean"]):
                self.assertAlmostEqual(ours, given * 10 / (6 * math.pi), delta=1e-9 * abs(ours))

    # Pe = 6 pi eta a^3 rate / kT, so that rate tau_B = Pe / 6 pi.
    def test_over_a_derived_number_have_its_value(self):
        figure = self.draw("--quantity", "pressure", "--over", "brownian_time")
        rates = {point["label"]: point["derived"]["shear_time"] ** -1 for point in self.export()["points"]}
        for point in figure["points"]:
            expected = point["settings"]["/peclet"] / (6 * math.pi) / rates[point["label"]]
            self.assertAlmostEqual(point["settings"]["brownian_time"], expected, delta=1e-9 * expected)

    def export(self):
        return json.loads(Stage.folder.peclet("export", "start.json"))

    def on_page(self, quantity, *choices):
        """Returns the rows of the page's figure after these choices (list, beginning of its entry)."""
        page = self.open("start.json.html")
        choose(page, "#quantity", quantity)
        for select, text in choices:
            choose(page, select, text)
        return rows(saved(page, "#sweep", "CSV"))

    def test_are_scaled_on_the_page_as_by_plot(self):
        drawn = self.draw("--quantity", "pressure", "--scale-y", "thermal_stress", "--over", "brownian_time")
        page = self.on_page("pressure", ("#scale-y", "/ thermal stress"), ("#axis", "Brownian time"))
        expected = {point["label"]: point for point in drawn["points"]}
        self.assertEqual({row["label"] for row in page}, set(expected))
        for row in page:
            self.assertEqual(row["quantity"], "pressure / (k_B T / a^3)")
            for name in ("mean", "standard_error", "half_width"):
                self.assertAlmostEqual(float(row[name]) / expected[row["label"]][name], 1, places=9)

    def test_along_an_axis_are_scaled_on_the_page_as_by_plot(self):
        words = ["--quantity", "transient/shear_stress", "--scale-y", "thermal_stress"]
        drawn = points_of(self.draw(*words))
        found = {}
        for row in self.on_page("transient, shear stress", ("#scale-y", "/ thermal stress")):
            found.setdefault(row["label"], []).append(float(row["mean"]))
        self.assertEqual(set(found), set(drawn))
        for label, numbers in found.items():
            for ours, given in zip(numbers, drawn[label]["mean"], strict=True):
                self.assertAlmostEqual(ours / given, 1, places=9)

    def test_stacked_parts_of_a_scaled_sum_add_up_to_it(self):
        page = self.open("start.json.html")
        choose(page, "#quantity", "stress by term, xy")
        choose(page, "#scale-y", "/ thermal stress")
        self.assertTrue(page.evaluate("document.getElementById('stacked').checked"))
        panels = json.loads(page.evaluate("JSON.stringify(campaign.sweep.chart.figure.panels)"))
        sums = [(panel, mark) for panel in panels for mark in panel["marks"]]
        self.assertEqual(len(sums), 4)
        for panel, mark in sums:
            parts = [one for one in panel["columns"] if one["from"] < mark["x"] < one["to"]]
            total = sum(one["high"] - one["low"] if one["high"] > 0 else one["low"] - one["high"] for one in parts)
            self.assertAlmostEqual(total / mark["y"], 1, places=6)

    def test_of_two_quantities_are_in_one_frame_of_the_page(self):
        page = self.on_page("first normal difference", ("#second", "second normal difference"))
        drawn = self.draw("--quantity", "first_normal_difference", "--quantity", "second_normal_difference")
        expected = {(point["label"], point["quantity"]): point["mean"] for point in drawn["points"]}
        found = {(row["label"], row["quantity"]): float(row["mean"]) for row in page}
        self.assertEqual(found, expected)

    def test_are_those_of_the_page(self):
        page = self.open("start.json.html")
        choose(page, "#quantity", "transient, shear stress")
        table = rows(saved(page, "#sweep", "CSV"))
        exported = self.exported("transient/shear_stress", "mean")
        found = {}
        for row in table:
            found.setdefault(row["label"], []).append(float(row["mean"]))
        self.assertEqual(found, exported)
        self.draw("--quantity", "transient/shear_stress")
        figure, _ = drawn_by("start.py")
        shown = page.evaluate("JSON.stringify(campaign.sweep.chart.figure)")
        on_page = json.loads(shown)
        for part in ("lines", "bands"):
            self.assertEqual(
                [one["places"] for one in on_page["panels"][0][part]],
                [one["places"] for one in figure["panels"][0][part]],
            )
        self.assertEqual(
            [text_of(one["name"]) for one in on_page["legend"]], [text_of(one["name"]) for one in figure["legend"]]
        )
        for axis in "xy":
            self.assertEqual(on_page[axis]["log"], figure[axis]["log"])
        self.assertEqual(page.evaluate("document.querySelectorAll('#sweep path.line').length"), 4)


class Scripts(PageTest):
    def test_draw_the_figure_again_by_themselves(self):
        for ending, magic in (("png", b"\x89PNG"), ("pdf", b"%PDF"), ("svg", b"<?xml")):
            output = Stage.folder.file(f"drawn.{ending}")
            done = peclet("plot", "curve.json", "--band", "--output", output)
            self.assertEqual(done.returncode, 0, done.stderr)
            with open(output, "rb") as file:
                picture = file.read()
            self.assertTrue(picture.startswith(magic))
            script = Stage.folder.file(f"alone-{ending}.py")
            os.rename(Stage.folder.file("drawn.py"), script)
            again = Stage.folder.file(f"again.{ending}")
            subprocess.run(["/usr/bin/python3", script, again], check=True, cwd="/")
            with open(again, "rb") as file:
                self.assertEqual(file.read(), picture)

    def test_draw_every_bar_as_wide_as_it_is(self):
        peclet("plot", "curve.json", "--output", "bars.py")
        _, axes = drawn_by("bars.py")
        segments = [segment for bars in axes.containers for segment in bars.lines[2][0].get_segments()]
        found = sorted((low, high) for (_, low), (_, high) in segments)
        expected = [(float(row["mean"]), float(row["half_width"])) for row in self.exported().values()]
        self.assertEqual(len(found), 9)
        for (low, high), (mean, half) in zip(found, sorted((mean - half, half) for mean, half in expected)):
            self.assertAlmostEqual(low, mean, places=9)
            self.assertAlmostEqual(high - low, 2 * half, places=9)
        self.assertEqual(axes.get_xscale(), "log")

    def test_have_the_numbers_that_json_has(self):
        peclet("plot", "curve.json", "--band", "--log", "none", "--output", "same.py")
        self.assertEqual(
            json.loads(peclet("plot", "curve.json", "--band", "--log", "none", "--json").stdout), figure_of("same.py")
        )

    def test_of_others_are_not_replaced(self):
        with open(Stage.folder.file("mine.py"), "w", encoding="utf-8") as file:
            file.write("print('mine')\n")
        done = peclet("plot", "curve.json", "--output", "mine.svg")
        self.assertEqual(done.returncode, 2)
        self.assertRegex(done.stderr, r"^peclet: mine\.py: is there already, .*\n$")
        self.assertFalse(os.path.exists(Stage.folder.file("mine.svg")))
        # Its own files may be overwritten.
        for _ in range(2):
            self.assertEqual(peclet("plot", "curve.json", "--output", "own.svg").returncode, 0)


class Faults(PageTest):
    def refusal(self, code, *words, path="/usr/bin:/bin"):
        """Returns the message; nothing may be written."""
        before = sorted(os.listdir(Stage.folder.path))
        done = peclet("plot", *words, path=path)
        self.assertEqual((done.returncode, done.stdout), (code, ""), done.stderr)
        self.assertEqual(sorted(os.listdir(Stage.folder.path)), before)
        self.assertEqual(done.stderr.count("\n"), 1)
        return done.stderr

    def test_of_words_name_what_is_allowed(self):
        self.assertIn("must end in .svg, .png, .pdf or .py", self.refusal(2, "curve.json", "--output", "a.jpg"))
        self.assertIn("did you mean pressure?", self.refusal(2, "curve.json", "--quantity", "presure"))
        self.assertIn("/peclet, /volume_fraction", self.refusal(2, "curve.json", "--over", "friction"))
        self.assertIn("--log", self.refusal(2, "curve.json", "--log", "z"))
        self.assertIn("no such file", self.refusal(2, "absent.json"))
        self.assertIn("must be a campaign of another name", self.refusal(2, "curve.json", "--with", "curve.peclet"))
        self.assertIn(
            "campaign curve: --where", self.refusal(2, "curve.json", "--with", "young.json", "--where", "x=1")
        )

    def test_of_the_machine_name_the_cure(self):
        debian, without, pip, conda = (Stage.folder.file(name) for name in ("debian", "without", "pip", "conda"))
        for place in (debian, without):
            os.makedirs(place, exist_ok=True)
        script = os.path.join(debian, "python3")
        with open(script, "w", encoding="utf-8") as file:
            file.write('#!/bin/sh\nexec /usr/bin/python3 -S "$@"\n')
        os.chmod(script, 0o755)
        for place in (pip, conda):
            subprocess.run(["/usr/bin/python3", "-m", "venv", "--without-pip", place], check=True)
        os.makedirs(os.path.join(conda, "conda-meta"))
        for path, why, cure in (
            (debian, "cannot import matplotlib", "install it with apt install python3-matplotlib;"),
            (f"{pip}/bin", "cannot import matplotlib", f"install it with {pip}/bin/python3 -m pip install matplotlib;"),
            (f"{conda}/bin", "cannot import matplotlib", "install it with conda install -c conda-forge matplotlib;"),
            (without, "cannot be run", "python3 in PATH"),
        ):
            for ending in ("svg", "png", "pdf"):
                done = peclet("plot", "curve.json", "--quiet", "--output", f"absent.{ending}", path=path)
                self.assertEqual((done.returncode, done.stdout), (1, ""), done.stderr)
                self.assertEqual(done.stderr.count("\n"), 1)
                for words in (why, cure, f"python3 absent.py absent.{ending}"):
                    self.assertEqual(done.stderr.count(words), 1, done.stderr)
                self.assertFalse(os.path.exists(Stage.folder.file(f"absent.{ending}")))
                # The files written draw the figure where matplotlib exists.
                script, picture = Stage.folder.file("absent.py"), Stage.folder.file(f"present.{ending}")
                subprocess.run(["/usr/bin/python3", script, picture], check=True)
                os.remove(script)
            self.assertEqual(peclet("plot", "curve.json", "--output", "absent.py", path=path).returncode, 0)
            self.assertIn("; --json prints the numbers", self.refusal(1, "curve.json", path=path))


class TheSupplement(PageTest):
    def unpacked(self, name):
        done = peclet("export", "curve.json", "--bundle", f"{name}.tar.gz")
        self.assertEqual(done.returncode, 0, done.stderr)
        folder = Stage.folder.file(name)
        os.makedirs(folder)
        subprocess.run(["tar", "-xzf", f"../{name}.tar.gz"], cwd=folder, check=True)
        return os.path.join(folder, "curve")

    def test_says_one_number_in_all_its_files(self):
        folder = self.unpacked("numbers")

        def content(name):
            with open(os.path.join(folder, name), encoding="utf-8") as file:
                return file.read()

        page = self.open(os.path.join(folder, "report.html"))
        on_page = {row["label"]: row for row in rows(saved(page, "#results", "CSV"))}
        in_chart = {row["label"]: row for row in rows(saved(page, "#sweep", "CSV"))}
        in_json = {point["label"]: point for point in json.loads(content("results.json"))["points"]}
        in_long = {row["label"]: row for row in rows(content("numbers.csv")) if row["quantity"] == QUANTITIES[0]}
        in_status = {
            point["label"]: point
            for point in json.loads(Stage.folder.peclet("status", "curve.json", "--json"))["points"]
        }
        in_figure = points_of(runpy.run_path(os.path.join(folder, "figure.py"))["FIGURE"])
        table = rows(content("results.csv"))
        self.assertEqual(len(table), 9)
        for row in table:
            label, mean, half = row["label"], float(row["mean"]), float(row["half_width"])
            for other in (on_page[label], in_chart[label], in_figure[label]):
                self.assertEqual((float(other["mean"]), float(other["half_width"])), (mean, half))
            for tested in (in_json[label]["stop_test"], in_status[label]["stop_test"]):
                self.assertEqual((tested["mean"], tested["half_width"]), (mean, half))
            # These sum in another order.
            for other in (float(in_long[label]["mean"]), in_json[label]["quantities"][QUANTITIES[0]]["mean"]):
                self.assertAlmostEqual(other, mean, delta=1e-12 * abs(mean))
            # The text has the same digits: "5.73 ± 0.40".
            self.assertRegex(content("README.md"), rf"(?m)^ +{row['/volume_fraction']} +{row['/peclet']} .* {half:.2g}")

    def test_is_made_again_from_its_own_campaign_file(self):
        folder = self.unpacked("again")
        subprocess.run(["sha256sum", "--quiet", "--strict", "--check", "SHA256SUMS"], cwd=folder, check=True)
        work = Stage.folder.file("redone")
        os.makedirs(work)
        with open(os.path.join(folder, "README.md"), encoding="utf-8") as file:
            commands = re.search(r"## Make it again\n\n```\n(.*?)```", file.read(), re.DOTALL)[1]
        os.rename(os.path.join(folder, "curve.json"), os.path.join(work, "curve.json"))
        for name in ("results.json", "results.csv"):
            os.link(os.path.join(folder, name), os.path.join(work, name))
        script = "set -o pipefail\n" + commands.replace(
            "peclet run curve.json", "peclet run curve.json --quiet > /dev/null"
        )
        environment = Stage.folder.environment
        done = subprocess.run(["bash", "-c", script], cwd=work, env=environment, capture_output=True, text=True)
        self.assertEqual((done.returncode, done.stdout), (0, ""), done.stderr)
        with open(os.path.join(folder, "figure.py"), "rb") as one, open(os.path.join(work, "figure.py"), "rb") as other:
            self.assertEqual(one.read(), other.read())

    def test_is_the_same_bytes_at_any_time(self):
        for name in ("one", "two"):
            self.assertEqual(peclet("export", "curve.json", "--bundle", f"{name}.tgz").returncode, 0)
        with open(Stage.folder.file("one.tgz"), "rb") as one, open(Stage.folder.file("two.tgz"), "rb") as two:
            self.assertEqual(one.read(), two.read())
        refused = peclet("export", "curve.json", "--csv", "--bundle", "three.tgz")
        self.assertEqual(refused.returncode, 2)
        self.assertFalse(os.path.exists(Stage.folder.file("three.tgz")))


if __name__ == "__main__":
    main()
