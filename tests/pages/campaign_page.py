"""Campaigns whose pages are looked at, and what is on a page, for the tests and for pictures."""

import csv
import io
import json
import os
import subprocess
import urllib.parse

SCENE = {
    "particles": {"count": 20, "density": 0.1, "species": [{"radius": 1.0}]},
    "volume_fraction": 0.3,
    "peclet": 10,
    "limits": {"shear_rate": 0.045, "thermal_energy": 0.01},
    "fluid": {"viscosity": 0.1},
    "contact": {"normal_stiffness": 1e4},
    "lubrication": {"form": "kim-karrila", "inner_gap": 1e-3, "outer_gap": 0.05},
    "duration": {"equilibration": {"strain": 0.05}, "production": {"strain": 0.1}},
}


def campaign(name, sweep, tolerance=0.3, minimum=8, maximum=30, scene=SCENE):
    return {
        "name": name,
        "scene": scene,
        "sweep": [{"set": pointer, "values": values} for pointer, values in sweep.items()],
        "target": {"observable": "relative_viscosity", "relative_tolerance": tolerance, "confidence": 0.95},
        "realisations": {"minimum": minimum, "maximum": maximum},
        "engine": ["peclet-engine", "serve"],
    }


class Folder:
    """A folder of campaigns, and the programs of a build."""

    def __init__(self, binaries, path):
        self.path = path
        self.environment = dict(os.environ, PATH=f"{os.path.abspath(binaries)}:{os.environ['PATH']}")

    def file(self, name):
        return os.path.join(self.path, name)

    def peclet(self, *words, allowed=(0,)):
        command = ["peclet", *words]
        done = subprocess.run(command, cwd=self.path, env=self.environment, capture_output=True, text=True)
        if done.returncode not in allowed:
            raise AssertionError(f"{' '.join(command)}: exit code {done.returncode}\n{done.stderr}")
        return done.stdout

    def write(self, document):
        with open(self.file(document["name"] + ".json"), "w", encoding="utf-8") as out:
            json.dump(document, out)
        return document["name"] + ".json"

    def report(self, name):
        """The path of the campaign's page."""
        self.peclet("report", name, "--output", name + ".html", "--quiet")
        return self.file(name + ".html")


def rows(text):
    return list(csv.DictReader(io.StringIO(text)))


def saved(page, place, what):
    """The content of a link of the page that saves something; `place` is a selector, `what` the link's text."""
    links = f"[...document.querySelectorAll({json.dumps(place + ' .saves a')})]"
    address = page.evaluate(f"({links}.find(a => a.textContent === {json.dumps(what)}) || {{}}).href")
    assert address and address.startswith("data:"), f"{place}: nothing to save as {what}"
    return urllib.parse.unquote(address.split(",", 1)[1])


def choose(page, select, text):
    """Chooses the entry of a list whose text begins so."""
    found = page.evaluate(
        f"""(() => {{ const list = document.querySelector({json.dumps(select)});
        const entry = [...list.options].find(one => one.text.startsWith({json.dumps(text)}));
        if (!entry) return false;
        list.value = entry.value; list.dispatchEvent(new Event('change')); return true; }})()"""
    )
    assert found, f"{select} has no {text}"


def switch(page, box, on):
    page.evaluate(
        f"(box => {{ if (box.checked !== {str(on).lower()}) box.click(); }})(document.querySelector('{box}'))"
    )


def open_folds(page):
    page.evaluate("for (const details of document.querySelectorAll('details')) details.open = true")
