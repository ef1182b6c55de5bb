#!/usr/bin/python3
"""screenshots.py BIN FOLDER [NAME...]

Runs a small campaign and takes all pictures, or those named. Takes three minutes on two cores; --list names
them. Some are those of the pages (docs/pictures). New ones are functions with @picture("NAME") below.
"""

import contextlib
import functools
import os
import shutil
import subprocess
import sys
import tempfile

from browser import Browser
from campaign_page import SCENE, Folder, campaign, choose, open_folds
from terminal import watched

FLOW_CURVE = dict(
    SCENE,
    particles={
        "count": 100,
        "density": 0.1,
        "species": [{"radius": 1.0, "volume_share": 0.5}, {"radius": 1.4, "volume_share": 0.5}],
    },
    duration={"equilibration": {"strain": 0.75}, "production": {"strain": 0.5}},
)
SWEEP = {"/volume_fraction": [0.3, 0.4, 0.45, 0.5], "/peclet": [1, 10, 100, 1000]}
# Seeds that take long enough to be watched.
SLOW_CURVE = dict(
    FLOW_CURVE,
    volume_fraction=0.45,
    particles=dict(FLOW_CURVE["particles"], count=400),
    duration={key: {"strain": 3} for key in FLOW_CURVE["duration"]},
)
SLOW_SWEEP = {"/peclet": [1, 4.6, 22, 100, 1000, 10000]}
PAGES = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "docs")
PICTURES = {}


def picture(name):
    """Registers a function as the picture `name`; it takes a Studio and a path."""

    def entered(function):
        PICTURES[name] = function
        return function

    return entered


class Studio:
    """A browser, and campaigns that run when the first picture needs them."""

    def __init__(self, binaries, place, browser):
        self.binaries, self.place, self.browser = binaries, place, browser

    def folder(self, name):
        path = os.path.join(self.place, name)
        os.makedirs(path, exist_ok=True)
        folder = Folder(self.binaries, path)
        # Finds the programs, and Debian's python3 with matplotlib, first.
        folder.environment["PATH"] = f"{self.binaries}:/usr/bin:/bin"
        return folder

    def write(self, folder, sweep=SWEEP, scene=FLOW_CURVE, tolerance=0.05, maximum=60):
        return folder.write(campaign("flow-curve", sweep, tolerance=tolerance, maximum=maximum, scene=scene))

    @functools.cached_property
    def finished(self):
        """Returns the folder of a finished campaign."""
        folder = self.folder("finished")
        folder.peclet("run", self.write(folder), "--quiet", allowed=(0, 3))
        return folder

    @functools.cached_property
    def begun(self):
        """Returns the folder of a campaign whose first seeds have ended."""
        folder = self.folder("begun")
        folder.peclet("plan", self.write(folder), "--pilot", "4")
        return folder

    @functools.cached_property
    def working(self):
        """Returns the folder of a longer campaign, which pictures of a run continue."""
        folder = self.folder("working")
        file = self.write(folder, SLOW_SWEEP, SLOW_CURVE, tolerance=0.007, maximum=400)
        folder.peclet("run", file, "--quiet", "--time-limit", "60", allowed=(75,))
        return folder

    def report(self, folder, **how):
        return self.browser.open(folder.report("flow-curve.json"), **how)

    def keep(self, page, path, whole=True):
        if page.complaints:
            raise SystemExit(f"{path}: {page.complaints}")
        page.picture(path, whole)

    def keep_element(self, page, path, selector, scale=2):
        """Takes a picture of the size of the element, with `scale` pixels per CSS pixel."""
        box = page.evaluate(f"(b => [b.right, b.bottom])(document.querySelector('{selector}').getBoundingClientRect())")
        width, height = (int(side + 0.999) for side in box)
        page.call(
            "Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=scale, mobile=False
        )
        self.keep(page, path, whole=False)

    def keep_html(self, text, path, selector, scale=2):
        with tempfile.NamedTemporaryFile("w", suffix=".html", dir=self.place, encoding="utf-8", delete=False) as file:
            file.write(text)
        self.keep_element(self.browser.open(file.name, width=2000), path, selector, scale)

    def keep_terminal(self, command, path, rows, columns, seconds, folder, scale=2):
        """Takes a picture of the terminal after `seconds` seconds of a program."""
        screen = watched(command, rows, columns, seconds, cwd=folder.path, env=folder.environment)
        self.keep_html(screen.html(), path, "pre", scale)


@picture("provisional.png")
def page_half_way(studio, path):
    studio.keep(studio.report(studio.begun), path)


@contextlib.contextmanager
def running(studio):
    """Runs the campaign until the picture is taken."""
    folder = studio.working
    command = ["peclet", "run", "flow-curve.json", "--quiet"]
    with subprocess.Popen(command, cwd=folder.path, env=folder.environment, stdout=subprocess.DEVNULL) as run:
        try:
            yield
        finally:
            run.terminate()


@picture("live.png")
def live_page_of_a_run(studio, path, whole=True, **how):
    with studio.working.serve("flow-curve.json") as server, running(studio):
        live = studio.browser.open(server.address, **how)
        live.wait_for("campaign.data && campaign.data.work.now.some(job => job.strain > 0)")
        live.evaluate("Live.prototype.ask = async () => {}")  # freezes the page
        live.evaluate("scrollTo(0, 0)")
        studio.keep(live, path, whole)


@picture("live_top.png")
def upper_part_of_the_live_page(studio, path):
    live_page_of_a_run(studio, path, whole=False, width=1000, height=900)


@picture("live_telephone.png")
def live_page_of_360_pixels(studio, path):
    live_page_of_a_run(studio, path, width=360, touch=True)


@picture("live_finished.png")
def live_page_of_what_has_ended(studio, path):
    with studio.finished.serve("flow-curve.json") as server:
        studio.keep(studio.browser.open(server.address), path)


@picture("wide.png")
def page(studio, path):
    studio.keep(studio.report(studio.finished), path)


@picture("report.png")
def upper_part_of_the_page(studio, path):
    top = studio.report(studio.finished, width=1000, height=880)
    top.evaluate("document.querySelector('#sweep svg').scrollIntoView({block: 'center'}); scrollTo(0, 0)")
    studio.keep(top, path, whole=False)


@picture("telephone.png")
def page_of_360_pixels(studio, path):
    studio.keep(studio.report(studio.finished, width=360, touch=True), path)


@picture("dark.png")
def page_in_the_dark(studio, path):
    dark = studio.report(studio.finished, dark=True)
    choose(dark, "#quantity", "first normal difference")
    studio.keep(dark, path)


@picture("unfolded.png")
def page_with_everything_open(studio, path):
    unfolded = studio.report(studio.finished)
    choose(unfolded, "#quantity", "stress by term, xy")
    open_folds(unfolded)
    studio.keep(unfolded, path)


@picture("paper.pdf")
def page_as_it_is_printed(studio, path):
    studio.report(studio.finished).print(path)


def watch(studio, path, columns, rows):
    """Takes a picture of a concurrent run."""
    folder = studio.working
    command = ["peclet", "watch", "flow-curve.json", "--interval", "0.5"]
    with running(studio):
        studio.keep_terminal(command, path, rows, columns, 6, folder, scale=1 if columns > 100 else 2)


@picture("watch-50.png")
def watch_in_50_columns(studio, path):
    watch(studio, path, 50, 40)


@picture("watch-80.png")
def watch_in_80_columns(studio, path):
    watch(studio, path, 80, 40)


@picture("watch-200.png")
def watch_in_200_columns(studio, path):
    watch(studio, path, 200, 40)


def plot(studio, path, *words, folder=None):
    (folder or studio.finished).peclet("plot", "flow-curve.json", "--output", path, "--quiet", *words)
    os.remove(os.path.splitext(path)[0] + ".py")


@picture("plot.png")
def plot_of_the_target(studio, path):
    plot(studio, path)


@picture("plot-pressure.png")
def plot_over_the_volume_fraction(studio, path):
    plot(studio, path, "--quantity", "pressure", "--over", "volume_fraction")


@picture("plot-band.png")
def plot_half_way_with_the_tolerance(studio, path):
    plot(studio, path, "--band", folder=studio.begun)


def engine(folder, *words):
    command = ["peclet-engine", *words]
    subprocess.run(command, cwd=folder.path, env=folder.environment, stdout=subprocess.DEVNULL, check=True)


@functools.cache
def trajectory(studio):
    """Returns the folder with the frame of docs/pictures/spheres.json."""
    folder = studio.folder("trajectory")
    scene = os.path.join(PAGES, "pictures", "spheres.json")
    engine(folder, "run", scene, "--seed", "1", "--output", "spheres.result.json")
    return folder


def snapshot(studio, path, *words):
    frames = "spheres.result.trajectory.gsd"
    engine(trajectory(studio), "snapshot", frames, *words, "--size", "1000x750", "--output", path)


@picture("spheres.png")
def snapshot_of_spheres(studio, path):
    snapshot(studio, path, "--colour", "stress")


@picture("chains.png")
def snapshot_of_force_chains(studio, path):
    snapshot(studio, path, "--chains")


@functools.cache
def figures_in_python(studio):
    """Returns the folder with the figures of docs/python.md."""
    folder = studio.folder("python")
    script = os.path.join(PAGES, "..", "tests", "python", "page_test.py")
    program = os.path.join(studio.binaries, "peclet")
    subprocess.run([sys.executable, script, program, folder.path], env=folder.environment, check=True)
    return folder


@picture("python.png")
def figure_in_python(studio, path):
    shutil.copy(os.path.join(figures_in_python(studio).path, "flow.png"), path)


@picture("paper.png")
def figure_in_ten_lines(studio, path):
    shutil.copy(os.path.join(figures_in_python(studio).path, "paper.png"), path)


def main(binaries, target, names):
    unknown = [name for name in names if name not in PICTURES]
    if unknown:
        raise SystemExit(f"{', '.join(unknown)}: no such picture; there are {', '.join(PICTURES)}")
    os.makedirs(target, exist_ok=True)
    with tempfile.TemporaryDirectory(prefix="peclet-page-") as place, Browser() as browser:
        studio = Studio(binaries, place, browser)
        for name in names or PICTURES:
            PICTURES[name](studio, os.path.join(os.path.abspath(target), name))
            print(name, flush=True)


if __name__ == "__main__":
    if sys.argv[1:] == ["--list"]:
        print("\n".join(f"{name:20} {function.__name__.replace('_', ' ')}" for name, function in PICTURES.items()))
    elif len(sys.argv) < 3:
        raise SystemExit(__doc__)
    else:
        main(os.path.abspath(sys.argv[1]), sys.argv[2], sys.argv[3:])
