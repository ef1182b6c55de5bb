#!/usr/bin/python3
"""page_speed.py BIN [--points 100] [--seeds 800]

Measures for a large campaign how long `peclet report` takes and how long a browser takes to open the page.
Measures the same for the live page of `peclet serve`: opening it, and an update after a seed of each of
eight points has ended, from the request until it is drawn. The campaign is real but for its seeds: two per
point are run and copied in the database with other numbers, and `peclet run` takes these in. Five
repetitions: the median, and all of them.
"""

import argparse
import json
import os
import random
import shutil
import sqlite3
import statistics
import subprocess
import sys
import tempfile
import time
import zlib


sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "pages"))
from browser import Browser  # noqa: E402
from campaign_page import Folder  # noqa: E402

SCENE = {
    "particles": {"count": 20, "density": 0.1, "species": [{"radius": 1.0}]},
    "volume_fraction": 0.3,
    "peclet": 10,
    "limits": {"shear_rate": 0.045, "thermal_energy": 0.01},
    "fluid": {"viscosity": 0.1},
    "contact": {"normal_stiffness": 1e4},
    "lubrication": {"form": "kim-karrila", "inner_gap": 1e-3, "outer_gap": 0.05},
    "duration": {"equilibration": {"strain": 0.02}, "production": {"strain": 0.02}},
}
REPETITIONS = 5


def campaign(points, seeds):
    fractions = [round(0.1 + 0.03 * i, 2) for i in range(10)]
    numbers = [round(10 ** (i / 3), 3) for i in range(-(-points // len(fractions)))]
    sweep = [{"set": "/volume_fraction", "values": fractions}, {"set": "/peclet", "values": numbers}]
    target = {"observable": "relative_viscosity", "relative_tolerance": 1e-5, "confidence": 0.95}
    return {
        "name": "large",
        "scene": SCENE,
        "sweep": sweep,
        "target": target,
        "realisations": {"minimum": min(8, seeds), "maximum": seeds},
        "engine": ["peclet-engine", "serve"],
    }


def deflated(text, dictionary):
    stream = zlib.compressobj(5, zlib.DEFLATED, zlib.MAX_WBITS, 8, zlib.Z_FILTERED, dictionary)
    return stream.compress(text) + stream.flush()


def copies(database, point, seeds, columns):
    """Yields rows of the seeds that the point lacks, each a copy of its first one with other numbers."""
    row = dict(database.execute("SELECT * FROM realisation WHERE point_id = ? AND seed = 0", (point,)).fetchone())
    layout, stored = database.execute(
        "SELECT layout_id, numbers FROM numbers WHERE point_id = ? AND seed = 0", (point,)
    ).fetchone()
    (text,) = database.execute("SELECT text FROM dictionary WHERE point_id = ?", (point,)).fetchone()
    dictionary, numbers = text.encode(), json.loads(stored)
    known = {seed for (seed,) in database.execute("SELECT seed FROM result WHERE point_id = ?", (point,))}
    for seed in range(seeds):
        if seed in known:
            continue
        factor = 1 + 0.1 * random.gauss(0, 1)
        row.update(seed=seed, state="done", cause="completed")
        result = json.loads(text)
        result["seed"] = seed
        yield (
            [row[column] for column in columns],
            (point, seed, deflated(json.dumps(result, separators=(",", ":")).encode(), dictionary)),
            (
                point,
                seed,
                layout,
                json.dumps([number and number * factor for number in numbers], separators=(",", ":")),
            ),
        )


def fill(path, seeds, most_points=None):
    database = sqlite3.connect(path)
    database.row_factory = sqlite3.Row
    columns = [name for (_, name, *_) in database.execute("PRAGMA table_info(realisation)")]
    marks = ", ".join("?" for _ in columns)
    with database:
        for (point,) in database.execute("SELECT point_id FROM point ORDER BY point_id").fetchall()[:most_points]:
            for realisation, result, numbers in copies(database, point, seeds, columns):
                database.execute(f"INSERT OR REPLACE INTO realisation VALUES ({marks})", realisation)
                database.execute("INSERT INTO result VALUES (?, ?, ?)", result)
                database.execute("INSERT INTO numbers VALUES (?, ?, ?, ?)", numbers)
    database.close()


def timed(command, folder, environment):
    begun = time.monotonic()
    subprocess.run(command, cwd=folder, env=environment, check=True, capture_output=True)
    return time.monotonic() - begun


def said(what, seconds):
    middle = statistics.median(seconds)
    print(f"{what}: {middle:.2f} s ({', '.join(f'{one:.2f}' for one in sorted(seconds))})", flush=True)


# Asks, takes the answer and waits until it is drawn; null if there is no news yet or it is not readable yet.
UPDATE = """(async () => { const live = Live.current, begun = performance.now();
    const response = await Live.fetch('state?since=' + live.token);
    if (response.status !== 200) return null;
    live.take(await response.json());
    await new Promise(done => requestAnimationFrame(() => setTimeout(done, 0)));
    return (performance.now() - begun) / 1000; })()"""


def live_page(folder, browser, seeds):
    """Returns the seconds to open the live page, and to update it."""
    with folder.serve("large.json") as server:
        opened = [browser.open(server.address) for _ in range(REPETITIONS)]
        page, updates = opened[-1], []
        for one in opened:
            one.evaluate("Live.prototype.ask = async () => {}")  # asks only when told to
        time.sleep(2)
        for more in range(1, REPETITIONS + 1):
            fill(folder.file("large.peclet/campaign.db"), seeds + more, most_points=8)
            until = time.monotonic() + 60
            while (took := page.evaluate(UPDATE)) is None:
                if time.monotonic() > until:
                    raise SystemExit("the live page has no news")
                time.sleep(0.2)
            updates.append(took)
        if page.complaints:
            raise SystemExit(page.complaints)
    return [page.seconds for page in opened], updates


def measure(binaries, points, seeds, folder):
    environment = dict(os.environ, PATH=f"{os.path.abspath(binaries)}:{os.environ['PATH']}")
    file = os.path.join(folder, "large.json")
    few, many = campaign(points, 2), campaign(points, seeds)
    for document in (few, many):
        if document is many:
            fill(os.path.join(folder, "large.peclet", "campaign.db"), seeds)
        with open(file, "w") as out:
            json.dump(document, out)
        done = subprocess.run(
            ["peclet", "run", "large.json", "--quiet"], cwd=folder, env=environment, stdout=subprocess.DEVNULL
        )
        if done.returncode not in (0, 3):
            raise SystemExit(f"peclet run: exit code {done.returncode}")
    size = os.path.getsize(os.path.join(folder, "large.peclet", "campaign.db"))
    print(f"{points} points x {seeds} seeds, a database of {size / 1e6:.0f} MB")
    command = ["peclet", "report", "large.json", "--output", "large.html", "--quiet"]
    said("peclet report", [timed(command, folder, environment) for _ in range(REPETITIONS)])
    page = os.path.join(folder, "large.html")
    print(f"the page has {os.path.getsize(page) / 1e6:.2f} MB")
    with Browser() as browser:
        said("opening the page", [browser.open(page).seconds for _ in range(REPETITIONS)])
        live, updates = live_page(Folder(binaries, folder), browser, seeds)
    said("opening the live page", live)
    said("an update of the live page", updates)
    csv = ["peclet", "export", "large.json", "--csv", "--output", "large.csv", "--quiet"]
    said("peclet export --csv", [timed(csv, folder, environment) for _ in range(REPETITIONS)])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("binaries", metavar="BIN")
    parser.add_argument("--points", type=int, default=100)
    parser.add_argument("--seeds", type=int, default=800)
    options = parser.parse_args()
    random.seed(1)
    folder = tempfile.mkdtemp(prefix="peclet-page-")
    try:
        measure(options.binaries, options.points, options.seeds, folder)
    finally:
        shutil.rmtree(folder)


if __name__ == "__main__":
    main()
