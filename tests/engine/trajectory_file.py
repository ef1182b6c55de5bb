#!/usr/bin/python3
"""trajectory_file.py ENGINE

Tests trajectories of peclet-engine, read by Debian's python3-gsd. The last frame is compared with the
final configuration, text with all bits of the numbers: box, positions, images, velocities and radii.
Displacements are continuous across changes of basis. Stresses of the spheres add up to that of the frame,
whose mean over all steps is that of the result. A run that is killed with SIGKILL and resumed leaves
identical bytes, as does one with two threads.
"""
import collections
import json
import os
import re
import signal
import sys
import tempfile
import time

import gsd.fl
import gsd.hoomd
import numpy

import trajectory_text
from trajectory_text import lattice_of, start

SCENE = trajectory_text.SCENE | {
    "observables": ["stress", "trajectory", "contact_network"],
    "trajectory": {"interval": {"strain": 0.001}, "contacts": True},
    "contact_network": {"interval": 0.0005},
}
NOISE = {"fluid": {"viscosity": 0.1, "thermal_energy": 0.02}}
EXPLICIT = {"integrator": {"method": "explicit", "timestep": 0.0005}}
ROUNDING = 2.0**-24  # to the nearest float32, relative
EQUILIBRATION, PRODUCTION = 200, 960  # steps; each of the window has a frame
TERMS = ("solvent", "stresslet", "lubrication", "contact_normal", "friction", "total")

Realisation = collections.namedtuple("Realisation", "result frames final")


def run(engine, folder, scene, *options):
    code = start(engine, folder, scene, *options).wait()
    assert code == 0, f"exit {code}"


def text_of(folder, name):
    with open(os.path.join(folder, name)) as file:
        return file.read()


def bytes_of(folder):
    with open(os.path.join(folder, "out.trajectory.gsd"), "rb") as file:
        return file.read()


def final_of(text):
    """Returns the lattice vectors as columns, and the centre, radius and velocity of each sphere."""
    lines = text.splitlines()
    lattice = [float(x) for x in re.search('Lattice="([^"]*)"', lines[1])[1].split()]
    rows = numpy.array([[float(x) for x in line.split()] for line in lines[2:]])
    assert (rows[:, 0] == range(len(rows))).all()
    return numpy.array(lattice).reshape(3, 3).T, rows[:, 1:4], rows[:, 4], rows[:, 5:8]


def realisation(engine, scene):
    with tempfile.TemporaryDirectory() as folder:
        run(engine, folder, scene)
        with gsd.hoomd.open(os.path.join(folder, "out.trajectory.gsd")) as trajectory:
            frames = list(trajectory)
        return Realisation(json.loads(text_of(folder, "out.json")), frames, final_of(text_of(folder, "out.final.xyz")))


def layout(frames, path):
    with gsd.fl.open(path, "rb") as file:
        assert (file.gsd_version, file.schema, file.schema_version) == ((2, 0), "hoomd", (1, 4))
        assert (file.application, file.nframes) == ("peclet-engine", len(frames))
    for frame in frames:
        frame.validate()


def is_the_final_configuration(realisation):
    lattice, centre, radius, velocity = realisation.final
    frame = realisation.frames[-1]
    box = frame.configuration.box
    assert (box[:3] == numpy.diag(lattice).astype(numpy.float32)).all()
    assert (box[3:] == numpy.float32([lattice[0, 1] / lattice[1, 1], 0, 0])).all()
    assert (frame.particles.diameter == (2 * radius).astype(numpy.float32)).all()
    # Whole cells, recomputed; the cell is centred at the origin.
    cells = numpy.floor(numpy.linalg.solve(lattice, centre.T).T + 0.5)
    assert (abs(cells) > 0).any() and (cells == 0).any()
    assert (frame.particles.position == (centre - cells @ lattice.T).astype(numpy.float32)).all()
    moved = velocity - numpy.outer(cells[:, 1], [SCENE["flow"]["shear_rate"] * lattice[1, 1], 0, 0])
    assert (frame.particles.velocity == moved.astype(numpy.float32)).all()
    steps = [frame.configuration.step for frame in realisation.frames]
    assert steps == list(range(EQUILIBRATION + 1, EQUILIBRATION + PRODUCTION + 1))


def ways_have_no_jump(frames):
    """Unwrapped, a sphere moves in a step by dt times its mean velocity, up to the flow's difference."""
    dt, changes, last = SCENE["integrator"]["timestep"], 0, None
    for frame in frames:
        lattice = lattice_of(frame)
        image = frame.particles.image
        unwrapped = frame.particles.position + image @ lattice.T
        # The velocity at the unwrapped position; images move with the cell.
        velocity = frame.particles.velocity.astype(float)
        velocity[:, 0] += SCENE["flow"]["shear_rate"] * lattice[1, 1] * image[:, 1]
        tilt = frame.configuration.box[3]
        if last is not None:
            step, between = unwrapped - last[0], 0.5 * dt * (velocity + last[1])
            assert abs(step - between).max() < 0.02, abs(step - between).max()
            changes += last[2] - tilt > 0.5
        last = unwrapped, velocity, tilt
    assert changes >= 1, "no basis was changed"
    assert abs(frames[-1].particles.image).max() >= 1


def stress_adds_up(realisation):
    unit = 0.1 * 2  # viscosity times shear rate, which results divide by
    mean = {term: numpy.mean([frame.log["stress/" + term] for frame in realisation.frames], axis=0) for term in TERMS}
    for term, value in mean.items():
        expected = unit * numpy.array(realisation.result["mean"]["stress"][term])
        assert numpy.allclose(value, expected, rtol=1e-11, atol=1e-12), (term, value, expected)
    for frame in realisation.frames:
        parts = frame.log["particles/stress"].astype(float)
        volume = numpy.prod(frame.configuration.box[:3].astype(float))
        of_frame = volume * (frame.log["stress/total"] - frame.log["stress/solvent"])
        # The bound of four roundings of edges and numbers.
        bound = 1.01 * ROUNDING * abs(parts).sum(axis=0) + 4 * ROUNDING * abs(of_frame)
        assert (abs(parts.sum(axis=0) - of_frame) <= bound).all()


def contacts_are_those_of_the_network(realisation):
    """Compares with the observable, which counts the same steps independently."""
    numbers = numpy.concatenate([frame.log["particles/contact_number"] for frame in realisation.frames])
    shares = numpy.bincount(numpy.minimum(numbers, 12), minlength=13) / len(numbers)
    assert numpy.allclose(shares, realisation.result["mean"]["contact_network"]["contacts"], atol=1e-12)
    state = numpy.concatenate([frame.log["bonds/state"] for frame in realisation.frames])
    assert set(state) <= {1, 2}
    assert abs((state == 2).mean() - realisation.result["mean"]["sliding_contacts"]) < 1e-12
    for frame in realisation.frames:
        touched = numpy.bincount(frame.bonds.group.ravel(), minlength=frame.particles.N)
        assert (touched == frame.log["particles/contact_number"]).all()


def dilute(engine):
    """Reads a frame without contacts before frames with some."""
    frames = realisation(engine, SCENE | {"volume_fraction": 0.1, "trajectory": {"contacts": True}}).frames
    assert len(frames) == PRODUCTION // (PRODUCTION // 256)  # a 256th of the window in whole steps
    assert frames[0].bonds.N == 0 and frames[0].log["bonds/gap"].shape == (0,)
    some = next(frame for frame in frames if frame.bonds.N > 0)
    assert some.bonds.group.shape == (some.bonds.N, 2) and some.log["bonds/gap"].shape == (some.bonds.N,)


def wait_until(is_so):
    end = time.monotonic() + 60
    while not is_so():
        assert time.monotonic() < end, "nothing happened in a minute"
        time.sleep(0.01)


def killed_and_resumed(engine):
    """Tests a run stopped with a checkpoint, killed after more frames, and resumed."""
    scene = SCENE | {
        "particles": SCENE["particles"] | {"count": 8000},
        "duration": {"equilibration": {"time": 0.02}, "production": {"time": 0.4}},
        "trajectory": {"interval": {"time": 0.004}, "contacts": True},
    }
    with tempfile.TemporaryDirectory() as folder:
        run(engine, folder, scene)
        uncut = bytes_of(folder)
    with tempfile.TemporaryDirectory() as folder:
        checkpoint = os.path.join(folder, "checkpoint")
        grown = checkpoint + "@growing"

        def size():
            return os.path.getsize(grown) if os.path.exists(grown) else 0

        options = "--checkpoint", checkpoint, "--threads", "2"
        for stop, least in (signal.SIGTERM, 0), (signal.SIGKILL, 1):
            before = size()
            process = start(engine, folder, scene, *options)
            wait_until(lambda: size() > before + least)
            process.send_signal(stop)
            assert process.wait() != 0
            assert os.path.exists(checkpoint)
        run(engine, folder, scene, *options)
        assert bytes_of(folder) == uncut


def main():
    engine = os.path.abspath(sys.argv[1])
    for method in ({}, EXPLICIT):
        for noise in ({}, NOISE):
            made = realisation(engine, SCENE | method | noise)
            is_the_final_configuration(made)
            ways_have_no_jump(made.frames)
            stress_adds_up(made)
            contacts_are_those_of_the_network(made)
    with tempfile.TemporaryDirectory() as folder:
        run(engine, folder, SCENE)
        layout(made.frames, os.path.join(folder, "out.trajectory.gsd"))
    dilute(engine)
    killed_and_resumed(engine)


if __name__ == "__main__":
    main()
