#!/usr/bin/python3
"""picture_file.py ENGINE

Tests pictures of `peclet-engine snapshot` with Debian's python3-pil. A sphere in a cell is a disc at the
right place. Every colouring and the chains of a real trajectory give pictures of many colours, and viridis
equals matplotlib's in all of its 256 colours.
"""
import os
import subprocess
import sys
import tempfile

import matplotlib
import numpy
from PIL import Image

from trajectory_text import SCENE, start

SPHERE = '1\nLattice="4 0 0 0 4 0 0 0 4" Origin="-2 -2 -2" Properties=pos:R:3:radius:R:1 pbc="T T T"\n0 0 0 1.9\n'


def picture(engine, path, out, *options):
    subprocess.run([engine, "snapshot", path, "--output", out, *options], check=True)
    with Image.open(out) as image:
        assert (image.format, image.mode) == ("PNG", "RGB")
        image.verify()  # checks the checksums
    with Image.open(out) as image:
        return numpy.array(image).astype(int)


def a_sphere_is_a_disc(engine, folder):
    path = os.path.join(folder, "sphere.xyz")
    with open(path, "w") as file:
        file.write(SPHERE)
    pixels = picture(engine, path, os.path.join(folder, "sphere.png"), "--size", "500x400", "--view", "z")
    assert pixels.shape == (400, 500, 3)
    blue = pixels[:, :380, 2] - pixels[:, :380, 0] > 30  # left of the legend
    rows, columns = numpy.nonzero(blue)
    width, height = numpy.ptp(columns) + 1, numpy.ptp(rows) + 1
    assert abs(width - height) <= 2 and width > 250, (width, height)
    # The edge is sharp and round.
    assert abs(blue.sum() / (numpy.pi / 4 * width * height) - 1) < 0.02
    assert (pixels[0] == 255).all() and (pixels[-1] == 255).all()


def a_trajectory_has_pictures(engine, folder):
    assert start(engine, folder, SCENE).wait() == 0
    trajectory, drawn = os.path.join(folder, "out.trajectory.gsd"), os.path.join(folder, "out.png")
    seen = set()
    for options in (["--colour", c] for c in ("species", "speed", "contacts", "stress")):
        pixels = picture(engine, trajectory, drawn, "--size", "400x300", *options)
        assert len(numpy.unique(pixels.reshape(-1, 3), axis=0)) > 500, options
        seen.add(pixels.tobytes())
    for options in (["--chains"], ["--frame", "0"], ["--view", "x"], ["--view", "10,-40"]):
        seen.add(picture(engine, trajectory, drawn, "--size", "400x300", *options).tobytes())
    assert len(seen) == 8, "two pictures are the same"
    final = os.path.join(folder, "out.final.xyz")
    assert picture(engine, final, drawn, "--size", "64x64").shape == (64, 64, 3)


def the_bar_is_viridis(engine, folder):
    """Compares a bar of 960 pixels, in which every colour has a row."""
    pixels = picture(
        engine,
        os.path.join(folder, "out.trajectory.gsd"),
        os.path.join(folder, "bar.png"),
        *("--size", "2600x1920", "--colour", "speed"),
    )
    published = numpy.array(matplotlib.colormaps["viridis"].colors) * 255
    last = published[-1].round()
    rows, columns = numpy.nonzero((abs(pixels - last).max(axis=2) <= 1)[:, 2000:])
    top, column = rows.min(), 2000 + int(numpy.median(columns))
    bar = pixels[top : top + 960, column]
    at = (960 - numpy.arange(960) - 0.5) / 960 * 255
    expected = numpy.array([numpy.interp(at, range(256), published[:, k]) for k in range(3)]).T
    assert abs(bar - expected).max() <= 2, abs(bar - expected).max()


def main():
    engine = os.path.abspath(sys.argv[1])
    with tempfile.TemporaryDirectory() as folder:
        a_sphere_is_a_disc(engine, folder)
        a_trajectory_has_pictures(engine, folder)
        the_bar_is_viridis(engine, folder)


if __name__ == "__main__":
    main()
