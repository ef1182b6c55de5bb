"""Campaigns and access to their pages, for the tests and for pictures."""

import csv
import http.client
import io
import json
import os
import signal
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


class Server:
    """`peclet serve` of a campaign; `address` ends with a slash."""

    def __init__(self, folder, name, words=()):
        command = ["peclet", "serve", name, "--port", "0", *words]
        self.process = subprocess.Popen(
            command,
            cwd=folder.path,
            env=folder.environment,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
        )
        self.address = self.process.stdout.readline().strip()
        if not self.address.startswith("http://127.0.0.1:"):
            raise AssertionError(f"{' '.join(command)}: {self.address}{self.process.communicate()[1]}")
        self.port = int(self.address.rstrip("/").rsplit(":", 1)[1])

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.end()

    def end(self, signal_number=signal.SIGTERM):
        """Sends a signal and returns the exit code."""
        self.process.send_signal(signal_number)
        self.process.communicate(timeout=60)
        return self.process.returncode

    def ask(self, path="", method="GET", body=None, **headers):
        """Returns status, headers and text of an answer."""
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=60)
        connection.request(method, "/" + path, body, {name.replace("_", "-"): value for name, value in headers.items()})
        answer = connection.getresponse()
        text = answer.read().decode()
        connection.close()
        return answer.status, answer.headers, text

    def seconds(self):
        """Returns the processor time of the server [s]."""
        with open(f"/proc/{self.process.pid}/stat", encoding="ascii") as file:
            fields = file.read().rsplit(")", 1)[1].split()
        return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")

    def memory(self):
        """Returns the resident memory of the server [bytes]."""
        with open(f"/proc/{self.process.pid}/statm", encoding="ascii") as file:
            return int(file.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")


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

    def serve(self, name, *words):
        """Starts a server of the campaign's live page."""
        return Server(self, name, words)

    def report(self, name):
        """Writes the campaign's page and returns its path."""
        self.peclet("report", name, "--output", name + ".html", "--quiet")
        return self.file(name + ".html")


def rows(text):
    return list(csv.DictReader(io.StringIO(text)))


def saved(page, place, what):
    """Returns the content behind a saving link; `place` is a selector, `what` the text of the link."""
    links = f"[...document.querySelectorAll({json.dumps(place + ' .saves a')})]"
    address = page.evaluate(f"({links}.find(a => a.textContent === {json.dumps(what)}) || {{}}).href")
    assert address and address.startswith("data:"), f"{place}: nothing to save as {what}"
    return urllib.parse.unquote(address.split(",", 1)[1])


def choose(page, select, text):
    """Chooses the entry of a list whose text begins with `text`."""
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
