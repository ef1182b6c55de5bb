#!/usr/bin/python3
"""lammps.py BIN [--packings 6] [--lammps lmp]

Measures the point of LAMMPS in the chart and writes lammps.csv beside this script. Shears packings of the reference
scene by a strain of 2 with Debian's LAMMPS, in explicit steps of half of the largest stable one of peclet-engine, and
16 other packings with the peclet-engine in BIN at its default step. Viscosities are means over the second half. Takes
about five minutes for each packing of LAMMPS.
"""
import argparse
import concurrent.futures
import os
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
sys.path.insert(0, str(HERE.parent.parent / "tests/bench"))
from peer import Lammps
from studies.campaigns import Program
from studies.estimates import estimate, relative_difference, student_quantile
from studies.scenes import REFERENCE_SCENE, in_strains, merged
from studies.tables import write_table
from studies.speed_accuracy import COLUMNS

STRAIN = 2
SEEDS = 16
TARGET = 0.02


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("binaries")
    parser.add_argument("--packings", type=int, default=6)
    parser.add_argument("--lammps", default="lmp")
    arguments = parser.parse_args()
    scene = merged(REFERENCE_SCENE, in_strains(STRAIN / 2, STRAIN / 2))
    rate = scene["flow"]["shear_rate"]
    with tempfile.TemporaryDirectory() as folder:
        program = Program(arguments.binaries, folder)
        step = program.derived(merged(scene, integrator={"method": "explicit"}))["timestep"]
        ours = program.run("ours", scene, [{"/integrator": {"method": "implicit"}}], SEEDS)[0].by_seed()

        def sheared(packing):
            own = os.path.join(folder, f"packing-{packing}")
            os.mkdir(own)
            lammps = Lammps(arguments.lammps, own, rate, 0, step, STRAIN, packing)
            print(f"packing {packing}: {lammps.relative_viscosity:.2f}, {lammps.seconds:.0f} s", flush=True)
            return lammps

        with concurrent.futures.ThreadPoolExecutor(2) as pool:
            theirs = list(pool.map(sheared, range(1, arguments.packings + 1)))
        commit = " ".join(sorted(program.commits))
    values = {packing: lammps.relative_viscosity for packing, lammps in enumerate(theirs)}
    viscosity, error = estimate([*values.values()])
    bias, bias_error, degrees = relative_difference(values, ours, paired=False)
    seconds = estimate([lammps.seconds for lammps in theirs])[0]
    row = {
        "panel": "reference",
        "method": "LAMMPS",
        "step": 0.5,
        "timestep": step,
        "seeds": arguments.packings,
        "lost": 0,
        "viscosity": viscosity,
        "viscosity_error": error,
        "bias_percent": 100 * bias,
        "bias_half_width_percent": 100 * bias_error * student_quantile(degrees, 0.975),
        "seconds_per_strain": seconds / STRAIN,
        "seconds_to_2_percent": seconds * (error / viscosity) ** 2 * arguments.packings / TARGET**2,
        "particles": scene["particles"]["count"],
        "commit": commit,
    }
    write_table(HERE / "lammps.csv", COLUMNS, [row], digits=5)
    text = "{viscosity:.2f} ± {viscosity_error:.2f}, {bias_percent:.1f} ± {bias_half_width_percent:.1f} %"
    print(text.format(**row))


if __name__ == "__main__":
    main()
