#!/usr/bin/python3
"""picture_file.py ENGINE [--film]

Tests pictures of `peclet-engine snapshot` with Debian's python3-pil. A sphere in a cell is a disc at the
right place. Every colouring and the chains of a real trajectory give pictures of many colours, and viridis
equals matplotlib's in all of its 256 colours. The pictures of a film have one camera and one scale of colours; with
--film ffmpeg makes the film, and ffprobe reads it.
"""
import json
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


def pictures_of_film(engine, path, out, *options):
    """Draws all frames without ffmpeg. Returns the pictures and the command that makes a film of them."""
    words = [engine, "snapshot", path, "--frames", ":", "--output", out, *options]
    done = subprocess.run(words, check=True, capture_output=True, text=True, env={"PATH": "/nowhere"})
    first, command = done.stderr.split("\n  ", 1)
    assert first == "peclet-engine: there is no ffmpeg in PATH; with it this command makes the film:", first
    folder, stem = os.path.split(out[: -len(".png")])
    names = sorted(name for name in os.listdir(folder) if name.startswith(stem + "-"))
    assert names == [f"{stem}-{k:05}.png" for k in range(len(names))], names
    return [numpy.array(Image.open(os.path.join(folder, name))).astype(int) for name in names], command


def a_film_has_one_camera(engine, folder):
    """The second cell has edges twice as long as the first, and the same sphere."""
    path = os.path.join(folder, "growing.xyz")
    with open(path, "w") as file:
        file.write(SPHERE + SPHERE.replace("4", "8").replace("-2 -2 -2", "-4 -4 -4"))
    pictures, _ = pictures_of_film(engine, path, os.path.join(folder, "grow.png"), "--size", "500x400", "--view", "z")
    discs = [(image[:, :380, 2] - image[:, :380, 0] > 30) for image in pictures]  # left of the legend
    assert len(discs) == 2 and discs[0].sum() > 1000
    assert (discs[0] != discs[1]).sum() < 0.02 * discs[0].sum(), [disc.sum() for disc in discs]


def a_film_has_one_scale(engine, folder):
    trajectory, size = os.path.join(folder, "out.trajectory.gsd"), ("--size", "400x300", "--colour", "stress")
    film, _ = pictures_of_film(engine, trajectory, os.path.join(folder, "film.png"), *size)
    alone = [
        picture(engine, trajectory, os.path.join(folder, "alone.png"), *size, "--frame", str(k))
        for k in range(len(film))
    ]
    assert len(film) > 5

    def legends(images):
        return {image[60:230, 320:].tobytes() for image in images}  # without strain and axes

    assert len(legends(film)) == 1 and len(legends(alone)) > 5, (len(legends(film)), len(legends(alone)))
    assert len({image.tobytes() for image in film}) == len(film)


def a_film_is_read(engine, folder):
    """ffprobe reads the film that the engine makes, and that its command makes later, both with odd sizes."""
    path, film = os.path.join(folder, "growing.xyz"), os.path.join(folder, "a 'film' of 100%d.mp4")
    drawn = film.replace(".mp4", ".png")
    _, command = pictures_of_film(engine, path, drawn, "--size", "101x99")
    engine_words = [engine, "snapshot", path, "--frames", ":", "--output", drawn, "--size", "101x99"]
    for words in (["sh", "-c", command], engine_words):
        subprocess.run(words, check=True)
        asked = "stream=codec_name,width,height,nb_frames,r_frame_rate,pix_fmt"
        probe = ["ffprobe", "-v", "error", "-show_entries", asked, "-of", "json", "file:" + film]
        (stream,) = json.loads(subprocess.run(probe, check=True, capture_output=True).stdout)["streams"]
        expected = {"width": 102, "height": 100, "nb_frames": "2", "r_frame_rate": "25/1", "pix_fmt": "yuv420p"}
        assert stream == {"codec_name": "h264", **expected}, stream
        os.remove(film)


def a_film_needs_a_name_for_pictures(engine, folder):
    words = [engine, "snapshot", os.path.join(folder, "growing.xyz"), "--frames", ":", "--output", "film.mp4"]
    done = subprocess.run(words, capture_output=True, text=True)
    assert done.returncode == 2 and "--output: film.mp4: must end in .png with --frames" in done.stderr, done


def main():
    engine = os.path.abspath(sys.argv[1])
    with tempfile.TemporaryDirectory() as folder:
        if sys.argv[2:] == ["--film"]:
            a_film_has_one_camera(engine, folder)
            a_film_is_read(engine, folder)
            return
        a_sphere_is_a_disc(engine, folder)
        a_trajectory_has_pictures(engine, folder)
        the_bar_is_viridis(engine, folder)
        a_film_has_one_camera(engine, folder)
        a_film_has_one_scale(engine, folder)
        a_film_needs_a_name_for_pictures(engine, folder)


if __name__ == "__main__":
    main()
