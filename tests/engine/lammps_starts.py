#!/usr/bin/python3
"""lammps_starts.py ENGINE LAMMPS

LAMMPS moves spheres of two sizes in a tilted cell and writes them as dumps (plain, scaled, unwrapped) and as a
data file. The engine reads each file: positions, radii, velocities and spins are those that LAMMPS prints. A
scene starts from each of them, although its spheres are not in the order of the species.
"""
import hashlib
import json
import math
import os
import subprocess
import sys
import tempfile

import numpy
from trajectory_text import read_xyz

EDGE = 9.0
SCRIPT = f"""
units lj
atom_style sphere
comm_modify vel yes
box tilt large
region cell prism -1 {EDGE - 1} 0 {EDGE} 0 {EDGE} 1.5 0 0
create_box 2 cell
lattice sc 0.037
region inner block 0 7.9 0.1 8.9 0.1 8.9 units box
create_atoms 1 region inner
set group all type/fraction 2 0.4 12345
set type 1 diameter 2
set type 2 diameter 2.8
set group all density 0.1
velocity all create 1 87287
set group all omega 0.1 0.2 0.3
pair_style zero 3
pair_coeff * *
fix move all nve/sphere
timestep 0.01
run 200
write_dump all custom plain.dump id type x y z ix iy iz radius vx vy vz omegax omegay omegaz modify format float %.17g
write_dump all custom scaled.dump type id xs ys zs diameter modify format float %.17g
write_dump all custom unwrapped.dump id type xu yu zu radius modify format float %.17g
write_data all.data
"""


def spheres(engine, path):
    text = subprocess.run([engine, "trajectory", path, "--format", "xyz"], check=True, capture_output=True, text=True)
    return next(read_xyz(text.stdout))


def printed(path):
    """Returns the columns of a dump by name, sorted by id."""
    with open(path) as file:
        lines = file.read().splitlines()
    rows = numpy.array([[float(x) for x in line.split()] for line in lines[9:]])
    columns = dict(zip(lines[8].split()[2:], rows.T))
    order = numpy.argsort(columns["id"])
    return {name: values[order] for name, values in columns.items()}


def main():
    engine, lammps = os.path.abspath(sys.argv[1]), sys.argv[2]
    with tempfile.TemporaryDirectory() as folder:
        done = subprocess.run([lammps, "-log", "none"], input=SCRIPT, text=True, capture_output=True, cwd=folder)
        assert done.returncode == 0, done.stdout[-2000:] + done.stderr
        expected = printed(os.path.join(folder, "plain.dump"))
        cell = numpy.array([[EDGE, 1.5, 0], [0, EDGE, 0], [0, 0, EDGE]])
        images = numpy.array([expected["i" + x] for x in "xyz"]).T
        assert abs(images).max() > 0, "no sphere has left the cell"
        radii = expected["radius"]
        volumes = {a: 4 / 3 * math.pi * a**3 * (radii == a).sum() for a in (1.0, 1.4)}
        assert min(volumes.values()) > 0
        assert (numpy.diff(radii) < 0).any(), "the species are in order"
        scene = {
            "particles": {
                "count": len(radii),
                "density": 0.1,
                "species": [{"radius": a, "number_share": int((radii == a).sum())} for a in (1.0, 1.4)],
            },
            "volume_fraction": sum(volumes.values()) / EDGE**3,
            "fluid": {"viscosity": 0.1},
            "flow": {"shear_rate": 0.05},
            "contact": {"normal_stiffness": 1e4},
            "guard": {"largest_overlap": 1, "largest_displacement": 1},
            "duration": {"equilibration": {"strain": 0}, "production": {"strain": 1e-5}},
            "files": {"final_configuration": True},
        }
        for name, digits in (
            ("plain.dump", 1e-15),
            ("scaled.dump", 1e-14),
            ("unwrapped.dump", 1e-14),
            ("all.data", 1e-14),
        ):
            path = os.path.join(folder, name)
            keys, columns = spheres(engine, path)
            lattice = numpy.array([float(x) for x in keys["Lattice"].split()]).reshape(3, 3).T
            assert abs(lattice - cell).max() < 1e-14 * EDGE, (name, lattice)
            place = numpy.array([expected[x] for x in "xyz"]).T
            place = place + images @ cell.T if name == "unwrapped.dump" else place
            assert abs(columns["pos"] - place).max() <= digits * 2 * EDGE, name
            assert (columns["radius"][:, 0] == radii).all(), name
            assert ([int(kind) for kind in columns["type"][:, 0]] == expected["type"]).all(), name
            for column, prefix in (("velo", "v"), ("angular_velocity", "omega")):
                if name in ("plain.dump", "all.data"):
                    motion = numpy.array([expected[prefix + x] for x in "xyz"]).T
                    assert abs(columns[column] - motion).max() <= digits * 10, (name, column)
            with open(path, "rb") as file:
                scene["start"] = {"file": path, "sha256": hashlib.sha256(file.read()).hexdigest()}
            with open(os.path.join(folder, "scene.json"), "w") as file:
                json.dump(scene, file)
            out = os.path.join(folder, "out.json")
            subprocess.run([engine, "run", file.name, "--seed", "1", "--quiet", "--output", out], check=True)
            _, ended = next(read_xyz(open(os.path.join(folder, "out.final.xyz")).read()))
            order = numpy.argsort(radii, kind="stable")
            assert (ended["radius"][:, 0] == radii[order]).all(), name
            # A strain of 1e-5 moves no sphere by more than some 1e-3.
            way = (ended["pos"] - place[order]) @ numpy.linalg.inv(cell).T
            assert abs(way - way.round()).max() < 1e-3, (name, abs(way - way.round()).max())


if __name__ == "__main__":
    main()
