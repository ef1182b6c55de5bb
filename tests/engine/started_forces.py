#!/usr/bin/python3
"""started_forces.py ENGINE

Tests that a realisation started from a file begins with the forces of that file. A frictionless
realisation leaves its final configuration and a trajectory. The next one starts there with steps of 10⁻⁹,
in which nothing moves. The stress of each term in its first frame equals that of `peclet-engine forces`
for the numbers of the text, and its contacts are those of the last frame of the first one.
"""
import hashlib
import json
import os
import re
import subprocess
import sys
import tempfile

import gsd.hoomd
import numpy

from trajectory_text import SCENE, start

FIRST = SCENE | {
    "contact": {"normal_stiffness": 1e4},
    "integrator": {"method": "explicit", "timestep": 0.0005},
    "trajectory": {"interval": {"time": 0.0005}, "contacts": True},
}
STEP = 1e-9
NEXT = FIRST | {
    "integrator": {"method": "explicit", "timestep": STEP},
    "duration": {"equilibration": {"time": 0}, "production": {"time": 32 * STEP}},
    "trajectory": {"interval": {"time": STEP}, "contacts": True},
    "files": {"final_configuration": False},
}
TERMS = "lubrication", "contact_normal"


def run(engine, folder, scene):
    """Returns the first and the last frame of a realisation."""
    assert start(engine, folder, scene).wait() == 0
    with gsd.hoomd.open(os.path.join(folder, "out.trajectory.gsd")) as trajectory:
        return [trajectory[0], trajectory[len(trajectory) - 1]]


def forces_of(engine, folder, text):
    """Returns the answer of `peclet-engine forces` for the numbers of the text."""
    lines = text.splitlines()
    lattice = [float(x) for x in re.search('Lattice="([^"]*)"', lines[1])[1].split()]
    rows = numpy.array([[float(x) for x in line.split()] for line in lines[2:]])
    configuration = {
        "scene": {key: FIRST[key] for key in ("fluid", "flow", "contact", "lubrication")},
        "state": {
            "box": {"lengths": lattice[::4], "tilt": lattice[3]},
            "position": rows[:, 1:4].tolist(),
            "radius": rows[:, 4].tolist(),
            "velocity": rows[:, 5:8].tolist(),
            "angular_velocity": rows[:, 8:11].tolist(),
        },
    }
    path = os.path.join(folder, "configuration.json")
    with open(path, "w") as file:
        json.dump(configuration, file)
    return json.loads(subprocess.run([engine, "forces", path], check=True, capture_output=True).stdout)


def main():
    engine = os.path.abspath(sys.argv[1])
    with tempfile.TemporaryDirectory() as folder:
        last = run(engine, folder, FIRST)[1]
        path = os.path.join(folder, "out.final.xyz")
        with open(path, "rb") as file:
            text = file.read()
        given = {"file": path, "sha256": hashlib.sha256(text).hexdigest()}
        first = run(engine, folder, NEXT | {"start": given})[0]
        forces = forces_of(engine, folder, text.decode())
    assert (first.bonds.group == last.bonds.group).all() and first.bonds.N > 20
    strongest = last.log["bonds/normal_force"].max()
    assert abs(first.log["bonds/normal_force"] - last.log["bonds/normal_force"]).max() < 1e-6 * strongest
    for term in TERMS:
        (xx, xy, xz), (_, yy, yz), (_, _, zz) = forces["stress"][term]
        expected = numpy.array([xx, yy, zz, xy, xz, yz])
        found = first.log["stress/" + term]
        assert abs(found - expected).max() < 1e-5 * abs(expected).max(), (term, found, expected)


if __name__ == "__main__":
    main()
