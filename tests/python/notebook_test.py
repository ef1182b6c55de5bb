#!/usr/bin/python3
"""notebook_test.py PECLET ENGINE [CLASS]: runs campaigns in Jupyter kernels, among them docs/notebook.ipynb.

With --write in the place of CLASS it runs this notebook and keeps its first figure in the file.
"""
import copy
import html.parser
import json
import os
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import nbclient
import nbformat
from jupyter_client import KernelManager

ROOT = Path(__file__).resolve().parents[2]
PECLET, ENGINE = (os.path.abspath(path) for path in sys.argv[1:3])
SCENE = {
    "particles": {"count": 50, "density": 0.1, "species": [{"radius": 1}]},
    "volume_fraction": 0.3,
    "fluid": {"viscosity": 0.1},
    "flow": {"shear_rate": 0.05},
    "contact": {"normal_stiffness": 1e4},
    "duration": {"equilibration": {"strain": 0.5}, "production": {"strain": 1}},
}


class Notebook(nbclient.NotebookClient):
    """Runs cells in a kernel that has the package of this checkout; `shown` has each state of an output."""

    def __init__(self, cells, folder):
        super().__init__(
            cells, km=KernelManager(kernel_name="python3"), resources={"metadata": {"path": str(folder)}}, timeout=600
        )
        self.shown = []

    def run(self):
        try:
            self.execute(env={**os.environ, "PYTHONPATH": str(ROOT / "python"), "PECLET": PECLET})
        finally:
            self.kc.stop_channels()
            self.km.shutdown_kernel(now=True)

    def process_message(self, message, cell, index):
        if message["msg_type"] in ("display_data", "update_display_data"):
            self.shown.append((message["msg_type"], copy.deepcopy(message["content"]["data"])))
        return super().process_message(message, cell, index)


class Rows(html.parser.HTMLParser):
    """The texts of the cells of a table."""

    def __init__(self, text):
        super().__init__()
        self.rows, self.is_cell = [], False
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        self.is_cell = tag in ("td", "th")
        if tag == "tr":
            self.rows.append([])
        elif self.is_cell:
            self.rows[-1].append("")

    def handle_data(self, text):
        if self.is_cell:
            self.rows[-1][-1] += text


class OfACampaign(unittest.TestCase):
    def run_cells(self, *sources):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        cells = [nbformat.v4.new_code_cell(source) for source in sources]
        client = Notebook(nbformat.v4.new_notebook(cells=cells), folder.name)
        return client

    def campaign(self, **more):
        given = {"sweep": {"/volume_fraction": [0.2, 0.3]}, "tolerance": 1e-3, "minimum": 8, "maximum": 8, **more}
        arguments = {"name": "flow", "scene": SCENE, "engine": [ENGINE, "serve"], **given}
        return f"import peclet\ncampaign = peclet.Campaign(**{arguments!r})\n"

    def test_a_table_is_kept_up_to_date_in_one_output(self):
        client = self.run_cells(self.campaign() + "results = campaign.run()", "campaign.status()", "results")
        client.run()
        run, state, table = (cell.outputs for cell in client.nb.cells)
        self.assertEqual([output.output_type for output in run], ["display_data"])
        kinds = [kind for kind, _ in client.shown]
        self.assertEqual((kinds[0], set(kinds[1:])), ("display_data", {"update_display_data"}))

        said = subprocess.run([PECLET, "status", "--json", "flow.json"], cwd=self.folder, capture_output=True).stdout
        status = json.loads(said)
        last = run[0].data["text/html"]
        self.assertEqual(re.search('<progress value="(.*?)" max="(.*?)"', last).groups(), ("16", "16"))
        self.assertIn("2 of 2 points decided, 16 of 16 seeds", last)
        rows = Rows(last).rows
        self.assertEqual(rows[0][:3], ["volume_fraction", "seeds", "relative_viscosity ± standard error"])
        self.assertEqual([row[:2] for row in rows[1:]], [["0.2", "8/8"], ["0.3", "8/8"]])
        for row, point in zip(rows[1:], status["points"]):
            self.assertIn("capped", row[4])
            estimates = (row[2], "all_seeds", "standard_error"), (row[3], "stop_test", "half_width")
            for text, kind, error in estimates:
                mean, half = map(float, text.split(" ± "))
                self.assertAlmostEqual(half, point[kind][error], delta=0.06 * half)
                self.assertAlmostEqual(mean, point[kind]["mean"], delta=0.06 * half)

        of_state = Rows(state[0].data["text/html"]).rows
        ended = of_state[0].index("ended")
        self.assertEqual([float(row[ended]) for row in of_state[1:]], [8, 8])
        self.assertIn("flow: relative_viscosity", table[0].data["text/html"])
        self.assertEqual(len(Rows(table[0].data["text/html"]).rows), 3)

    def test_a_faulty_scene_says_where_and_an_unwritten_state_too(self):
        faulty = self.campaign(sweep={"/volume_fraction": [0.2, 2]}) + "campaign.run()"
        client = self.run_cells(faulty, "campaign.status()")
        client.allow_errors = True
        client.run()
        errors = [output for cell in client.nb.cells for output in cell.outputs if output.output_type == "error"]
        self.assertEqual([error.ename for error in errors], ["PecletError", "PecletError"])
        self.assertRegex(errors[0].evalue, "flow.json: .*volume_fraction: 2: must be")
        self.assertIn("has not been run yet", errors[1].evalue)

    def test_the_stop_button_stops_and_a_second_run_goes_on(self):
        long = self.campaign(minimum=3000, maximum=3000)
        client = self.run_cells(long + "campaign.run()", "campaign.status()['ended'].sum()")
        client.allow_errors = True
        is_asked = []

        def process(message, cell, index):
            if client.shown and "points decided" in client.shown[-1][1]["text/plain"] and not is_asked:
                is_asked.append(True)
                client.km.interrupt_kernel()
            return Notebook.process_message(client, message, cell, index)

        client.process_message = process
        client.run()
        (error,) = (output for output in client.nb.cells[0].outputs if output.output_type == "error")
        self.assertEqual(
            (error.ename, error.evalue), ("KeyboardInterrupt", "flow.json: stopped; run it again to go on")
        )
        self.assertLess(float(client.nb.cells[1].outputs[0].data["text/plain"]), 6000)


class OfTheDocs(unittest.TestCase):
    PAGE = ROOT / "docs" / "notebook.ipynb"

    def test_runs_and_finds_what_its_text_says(self):
        notebook = nbformat.read(self.PAGE, 4)
        kept = [output for cell in notebook.cells for output in cell.get("outputs", [])]
        self.assertEqual([list(output.data) for output in kept], [["image/png"]], "must keep its first figure only")
        with tempfile.TemporaryDirectory() as folder:
            client = Notebook(notebook, folder)
            client.run()
            export = subprocess.run([PECLET, "export", "notebook.json"], cwd=folder, check=True, capture_output=True)
        figures = [output for cell in notebook.cells for output in cell.get("outputs", []) if is_figure(output)]
        self.assertEqual(len(figures), 3)
        points = {tuple(point["settings"].values()): point for point in json.loads(export.stdout)["points"]}
        viscosity = {place: point["stop_test"]["mean"] for place, point in points.items()}
        for fraction in (0.3, 0.4):
            self.assertLess(viscosity[10, fraction], viscosity[1, fraction])
            self.assertLess(viscosity[10, fraction], viscosity[1000, fraction])

        def part(name, pe):
            return points[pe, 0.4]["quantities"][name]["mean"][3]

        self.assertLess(part("brownian_structural", 1000), 0.05 * part("brownian_structural", 1))
        self.assertGreater(part("stress/lubrication", 1000), 2 * part("stress/lubrication", 1))


def is_figure(output):
    return "image/png" in output.get("data", {})


def write_page():
    """Runs the notebook of docs/ and keeps its first figure only."""
    notebook = nbformat.read(OfTheDocs.PAGE, 4)
    about = copy.deepcopy(notebook.metadata)
    with tempfile.TemporaryDirectory() as folder:
        Notebook(notebook, folder).run()
    notebook.metadata = about
    figures = [output for cell in notebook.cells for output in cell.get("outputs", []) if is_figure(output)]
    picture = nbformat.v4.new_output("display_data", {"image/png": figures[0].data["image/png"]})
    for cell in notebook.cells:
        cell.metadata = {}
        if cell.cell_type == "code":
            cell.outputs, cell.execution_count = [picture] if figures[0] in cell.outputs else [], None
    nbformat.write(notebook, OfTheDocs.PAGE)


if __name__ == "__main__":
    if sys.argv[3:] == ["--write"]:
        write_page()
    else:
        unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
