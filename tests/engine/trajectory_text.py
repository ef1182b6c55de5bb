#!/usr/bin/python3
"""trajectory_text.py ENGINE [LAMMPS]

Tests the text formats of `peclet-engine trajectory` with other programs, and compares them with the GSD
file, read by Debian's python3-gsd. Extended XYZ is parsed by its definition. Every number is that of the
GSD file, rounded to a float, and stresses of spheres add up to that of the frame. LAMMPS reads the dump
with read_dump: positions, images, cell, velocities and radii are those of the file, and displacements are
continuous across changes of basis. Malformed files end with one message and exit code 2.
"""
import json
import os
import re
import subprocess
import sys
import tempfile

import gsd.hoomd
import numpy

SCENE = {
    "particles": {
        "count": 60,
        "density": 0.1,
        "species": [{"radius": 1, "volume_share": 1}, {"radius": 1.4, "volume_share": 1}],
    },
    "volume_fraction": 0.45,
    "fluid": {"viscosity": 0.1},
    "flow": {"shear_rate": 2},
    "contact": {"normal_stiffness": 1e4, "friction": 0.5},
    "lubrication": {"form": "kim-karrila", "inner_gap": 0.03, "outer_gap": 0.1},
    "integrator": {"timestep": 0.0005},
    "guard": {"largest_overlap": 0.2, "largest_displacement": 0.2},
    "duration": {"equilibration": {"time": 0.1}, "production": {"time": 0.48}},
    "observables": ["stress", "trajectory"],
    "trajectory": {"interval": {"strain": 0.04}, "contacts": True},
    "files": {"final_configuration": True},
}
COLUMNS = {"I": int, "R": float, "S": str}
# The script by LAMMPS' manual; radii are read as charges. Read and written with all digits, for each frame.
SCRIPT = """
units lj
atom_style charge
box tilt large
region cell prism -1 1 -1 1 -1 1 0 0 0
create_box 2 cell
mass * 1
pair_style zero 1 nocoeff
pair_coeff * *
"""
STEP = """
read_dump {dump} {step} x y z ix iy iz vx vy vz q label q radius box yes replace yes purge no add keep
reset_timestep 0
write_dump all custom {out} id type x y z ix iy iz xu yu zu vx vy vz q modify format float %.17g sort id
"""


def start(engine, folder, scene, *options):
    """Starts a realisation of seed 3, whose result and files will be out.*."""
    path = os.path.join(folder, "scene.json")
    with open(path, "w") as file:
        json.dump(scene, file)
    out = os.path.join(folder, "out.json")
    return subprocess.Popen([engine, "run", path, "--seed", "3", "--quiet", "--output", out, *options])


def lattice_of(frame):
    """Returns the lattice by the schema: lx, ly, lz, and tilts over the length of their second axis."""
    lx, ly, lz, xy, xz, yz = frame.configuration.box.astype(float)
    return numpy.array([[lx, xy * ly, xz * lz], [0, ly, yz * lz], [0, 0, lz]])


def read_xyz(text):
    """Yields frames as (second line, columns by name)."""
    lines = text.splitlines()
    while lines:
        count, about = int(lines[0]), lines[1]
        keys = {key: quoted or bare for key, quoted, bare in re.findall(r'(\w+)=(?:"([^"]*)"|(\S+))', about)}
        parts = keys["Properties"].split(":")
        rows = [line.split() for line in lines[2 : 2 + count]]
        columns, at = {}, 0
        for name, kind, width in zip(parts[::3], parts[1::3], map(int, parts[2::3])):
            columns[name] = numpy.array([[COLUMNS[kind](x) for x in row[at : at + width]] for row in rows])
            at += width
        assert all(len(row) == at for row in rows)
        yield keys, columns
        lines = lines[2 + count :]


def numbers(text):
    return numpy.array([float(x) for x in text.split()])


def xyz_is_the_trajectory(text, frames):
    read = list(read_xyz(text))
    assert len(read) == len(frames)
    for (keys, columns), frame in zip(read, frames):
        lattice = numbers(keys["Lattice"]).reshape(3, 3).T
        assert (lattice == lattice_of(frame)).all()
        assert (numbers(keys["Origin"]) == -lattice.sum(axis=1) / 2).all()
        assert (int(keys["Step"]), float(keys["Strain"])) == (frame.configuration.step, frame.log["strain"][0])
        assert (columns["id"][:, 0] == range(frame.particles.N)).all()
        types = numpy.array(frame.particles.types)[frame.particles.typeid]
        assert (columns["type"][:, 0] == types).all()
        assert (columns["radius"][:, 0].astype("f4") == frame.particles.diameter / 2).all()
        for name, expected in (
            ("pos", frame.particles.position),
            ("velo", frame.particles.velocity),
            ("angular_velocity", frame.log["particles/angular_velocity"]),
            ("stress", frame.log["particles/stress"]),
        ):
            assert (columns[name].astype("f4") == expected).all(), name
        assert (columns["image"] == frame.particles.image).all()
        assert (columns["contacts"][:, 0] == frame.log["particles/contact_number"]).all()
        volume = numpy.linalg.det(lattice)
        of_frame = volume * (numbers(keys["stress_total"]) - numbers(keys["stress_solvent"]))
        bound = 2.0**-23 * (abs(columns["stress"]).sum(axis=0) + 4 * abs(of_frame))
        assert (abs(columns["stress"].sum(axis=0) - of_frame) <= bound).all()


def read_dump(path):
    """Returns columns by name, the lattice and its corner, by LAMMPS' rule for bounds of tilted cells."""
    with open(path) as file:
        lines = file.read().splitlines()
    assert lines[4] == "ITEM: BOX BOUNDS xy xz yz pp pp pp", lines[4]
    bounds = numpy.array([[float(x) for x in line.split()] for line in lines[5:8]])
    xy, xz, yz = bounds[:, 2]
    low = bounds[:, 0] - [min(0, xy, xz, xy + xz), min(0, yz), 0]
    high = bounds[:, 1] - [max(0, xy, xz, xy + xz), max(0, yz), 0]
    lx, ly, lz = high - low
    names = lines[8].split()[2:]
    rows = numpy.array([[float(x) for x in line.split()] for line in lines[9:]])
    return dict(zip(names, rows.T)), numpy.array([[lx, xy, xz], [0, ly, yz], [0, 0, lz]]), low


def lammps_reads_the_trajectory(lammps, folder, dump, frames):
    script = SCRIPT
    for frame in frames:
        step = frame.configuration.step
        script += STEP.format(dump=dump, step=step, out=os.path.join(folder, f"{step}.dump"))
    done = subprocess.run([lammps, "-log", "none"], input=script, text=True, capture_output=True, cwd=folder)
    assert done.returncode == 0, done.stdout[-2000:] + done.stderr
    changes, last = 0, None
    for frame in frames:
        read, lattice, low = read_dump(os.path.join(folder, f"{frame.configuration.step}.dump"))
        assert abs(lattice - lattice_of(frame)).max() < 1e-13 * lattice[0, 0], lattice - lattice_of(frame)
        assert abs(low + lattice.sum(axis=1) / 2).max() < 1e-13 * lattice[0, 0]
        columns = {name: numpy.array([read[name + x] for x in "xyz"]).T for name in ("", "i", "v")}
        columns["u"] = numpy.array([read[x + "u"] for x in "xyz"]).T
        # On the edge of the cell either image is right: LAMMPS has doubles, the file floats.
        moved = columns["i"] - frame.particles.image
        assert abs(columns[""] + moved @ lattice.T - frame.particles.position).max() < 1e-6
        assert (moved == 0).all(axis=1).sum() >= frame.particles.N - 1
        assert abs(columns["u"] - frame.particles.position - frame.particles.image @ lattice.T).max() < 1e-5
        assert (columns["v"].astype("f4") == frame.particles.velocity).all()
        assert (read["q"].astype("f4") == frame.particles.diameter / 2).all()
        assert (read["type"] == frame.particles.typeid + 1).all()
        tilt = frame.configuration.box[3]
        if last is not None:
            # In a strain of 0.04 a sphere moves with the flow by 4 % of its unwrapped height.
            way = columns["u"] - last[0]
            assert abs(way).max() < 2, abs(way).max()
            changes += last[1] - tilt > 0.5
        last = columns["u"], tilt
    assert changes >= 1, "no basis was changed"


def hostile_files_end_in_words(engine, folder, trajectory):
    with open(trajectory, "rb") as file:
        whole = file.read()
    path = os.path.join(folder, "hostile.gsd")
    broken = whole[:8] + b"\xff" * 32 + whole[40:]
    for bytes_ in (whole[:300], whole[:-40], b"x" * 999, b"", broken, b"\x00" + whole[1:]):
        with open(path, "wb") as file:
            file.write(bytes_)
        out = os.path.join(folder, "hostile.xyz")
        for verb in (["trajectory", path, "--output", out], ["snapshot", path, "--output", out]):
            done = subprocess.run([engine, *verb], capture_output=True, text=True)
            assert (done.returncode, done.stdout, done.stderr.count("\n")) == (2, "", 1), done
            assert path in done.stderr and len(done.stderr) < 500, done.stderr
            assert not os.path.exists(out)


def arguments_are_answered(engine, trajectory):
    for options, named in (
        ([], "--format"),
        (["--format", "pdb"], "--format"),
        (["--output", "x.pdb"], "x.pdb: must end in .lammpstrj"),
        (["--format", "xyz", "--frames", "1:2:3:4"], "--frames: 1:2:3:4"),
        (["--format", "xyz", "--frames", "9999"], "frame 9999: must be from 0 to"),
        (["--format", "xyz", "--output", "/absent/x"], "/absent"),
    ):
        done = subprocess.run([engine, "trajectory", trajectory, *options], capture_output=True, text=True)
        assert (done.returncode, done.stdout) == (2, "") and named in done.stderr, (options, done)


def main():
    engine, lammps = os.path.abspath(sys.argv[1]), sys.argv[2] if len(sys.argv) > 2 else None
    with tempfile.TemporaryDirectory() as folder:
        assert start(engine, folder, SCENE).wait() == 0
        trajectory = os.path.join(folder, "out.trajectory.gsd")
        with gsd.hoomd.open(trajectory) as file:
            frames = list(file)
        if lammps:
            dump = os.path.join(folder, "t.lammpstrj")
            subprocess.run([engine, "trajectory", trajectory, "--output", dump], check=True)
            lammps_reads_the_trajectory(lammps, folder, dump, frames)
            return
        convert = [engine, "trajectory", trajectory, "--format", "xyz"]
        text = subprocess.run(convert, check=True, capture_output=True, text=True).stdout
        xyz_is_the_trajectory(text, frames)
        some = subprocess.run([*convert, "--frames", "2:-1:5"], check=True, capture_output=True, text=True).stdout
        xyz_is_the_trajectory(some, frames[2::5])
        hostile_files_end_in_words(engine, folder, trajectory)
        arguments_are_answered(engine, trajectory)


if __name__ == "__main__":
    main()
