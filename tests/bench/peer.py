#!/usr/bin/python3
"""peer.py ENGINE [--before ENGINE] [--repetitions 7] [--strain 0.2] [--skins 0.05] [--lammps lmp]

Compares the speed of ENGINE (a peclet-engine) with that of LAMMPS on the nearest scenes that LAMMPS has,
each on one core. Every round runs all contestants in turn, so that disturbances hit all of them; ratios
are taken within a round. README.md says what is the same in both programs and what is not.

--before   another peclet-engine, for example from build_before.sh, that takes part in every round
--strain   warm-up of LAMMPS; viscosity and temperature of each program are averaged over its second half
--skins    skins of the neighbour list of LAMMPS, one contestant each
"""
import argparse
import json
import math
import os
import re
import statistics
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
VISCOSITY = 0.1
# The edge of a cube at volume fraction 0.5 with 733 spheres of radius 1 and 267 of radius 1.4. The engine
# makes these of 1000 in equal volumes.
EDGE = ((733 + 267 * 1.4**3) * 4 / 3 * math.pi / 0.5) ** (1 / 3)
TIMED_STEPS = 3000
STEPS_BETWEEN_SAMPLES = 20
SKIN = 0.05  # the fastest
OURS = "peclet-engine"  # reference of the ratios

# Cases of engine_bench, with their driving.
DRIVES = {
    "frictionless": {"flow": {"shear_rate": 0.045}},
    "brownian": {"peclet": 10, "limits": {"shear_rate": 0.045, "thermal_energy": 1.0}},
}


def output_of(*command):
    done = subprocess.run(command, capture_output=True, text=True, env={**os.environ, "OMP_NUM_THREADS": "1"})
    if done.returncode != 0:
        last_lines = "\n".join((done.stdout + done.stderr).splitlines()[-5:])
        sys.exit(f"{' '.join(command)}: exit status {done.returncode}\n{last_lines}")
    return done.stdout


def engine_result(engine, case, strain, folder):
    """Returns the engine's result for the scene of `case`, with means over the second half of `strain`."""
    scene = {
        "particles": {
            "count": 1000,
            "density": 0.1,
            "species": [{"radius": 1.0, "volume_share": 0.5}, {"radius": 1.4, "volume_share": 0.5}],
        },
        "volume_fraction": 0.5,
        "fluid": {"viscosity": VISCOSITY},
        "contact": {"normal_stiffness": 1e4},
        "lubrication": {"form": "kim-karrila", "inner_gap": 1e-3, "outer_gap": 0.05},
        "integrator": {"method": "explicit"},
        "duration": {"equilibration": {"strain": strain / 2}, "production": {"strain": strain / 2}},
        **DRIVES[case],
    }
    path = os.path.join(folder, "scene.json")
    with open(path, "w") as f:
        json.dump(scene, f)
    return json.loads(output_of(engine, "run", path))


def bench_median(table, case):
    """Returns the number in the row `case` below the heading `median`."""
    heading = next(match for line in table.splitlines() for match in re.finditer(r"\bmedian\b", line))
    row = next(line for line in table.splitlines() if line.split()[:1] == [case])
    return next(
        float(word.group())
        for word in re.finditer(r"\S+", row)
        if word.start() < heading.end() and heading.start() < word.end()
    )


def loop_seconds(output):
    """Returns the processor time of the loop (wall-clock time times share) and its particle steps."""
    loop = re.search(r"Loop time of (\S+) on 1 procs for (\d+) steps with (\d+) atoms", output)
    share = re.search(r"([\d.]+)% CPU use", output)
    return float(loop[1]) * float(share[1]) / 100, int(loop[2]) * int(loop[3])


class Lammps:
    """A scene in LAMMPS, packed and warmed up; `seconds` is the processor time of that."""

    def __init__(self, program, folder, rate, thermal_energy, step, strain, packing=1):
        self.program = program
        self.shear = {"rate": rate, "thermal_energy": thermal_energy, "step": step}
        packed, self.warm, self.unused = (os.path.join(folder, name) for name in ("packed", "warm", "unused"))
        self.run("lammps_packing.in", edge=EDGE, rate=rate, packing=packing, to=packed)
        warming = self.run(
            "lammps.in",
            **{"from": packed},
            to=self.warm,
            steps=round(strain / rate / step),
            every=STEPS_BETWEEN_SAMPLES,
            skin=SKIN,
            **self.shear,
        )
        self.seconds = loop_seconds(warming)[0]
        lines = warming[warming.index("\nStep ") : warming.index("\nLoop time")].splitlines()[2:]
        second_half = [[float(word) for word in line.split()] for line in lines[len(lines) // 2 :]]
        _, self.relative_viscosity, self.temperature = (statistics.fmean(column) for column in zip(*second_half))

    def run(self, script, **variables):
        given = [word for name, value in variables.items() for word in ("-var", name, str(value))]
        return output_of(self.program, "-in", os.path.join(HERE, script), "-log", "none", *given)

    def nanoseconds(self, skin):
        """Returns the nanoseconds of the loop per particle and step."""
        output = self.run(
            "lammps.in", **{"from": self.warm}, to=self.unused, steps=TIMED_STEPS, every=0, skin=skin, **self.shear
        )
        seconds, particle_steps = loop_seconds(output)
        return 1e9 * seconds / particle_steps


def bench(engine):
    """Returns the command that times cases: engine_bench beside the engine, or an older engine's verb."""
    beside = os.path.join(os.path.dirname(engine), "engine_bench")
    return [beside] if os.path.exists(beside) else [engine, "bench"]


def compare(case, arguments, folder):
    engines = {OURS: arguments.engine}
    if arguments.before:
        engines["before"] = arguments.before
    results = {label: engine_result(engine, case, arguments.strain, folder) for label, engine in engines.items()}
    derived, step = results[OURS]["derived"], results[OURS]["timestep"]
    rate = 1 / derived["shear_time"]
    thermal_energy = VISCOSITY / derived["brownian_time"] if derived["brownian_time"] else 0  # tau_B = eta a^3 / kT
    peer = Lammps(arguments.lammps, folder, rate, thermal_energy, step, arguments.strain)

    contestants = {
        label: lambda engine=engine: bench_median(output_of(*bench(engine), case), case)
        for label, engine in engines.items()
    }
    states = {
        label: (result["mean"]["relative_viscosity"], result["mean"]["kinetic_temperature"])
        for label, result in results.items()
    }
    for skin in arguments.skins:
        label = f"LAMMPS, skin {skin}"
        contestants[label] = lambda skin=skin: peer.nanoseconds(skin)
        states[label] = peer.relative_viscosity, peer.temperature
    rounds = [{label: run() for label, run in contestants.items()} for _ in range(arguments.repetitions)]

    for label, result in results.items():
        build = result["engine"]
        print(
            f"{label}: commit {build['git_commit']}{' with changes' if build['git_dirty'] else ''}, {build['compiler']}"
        )
    print(
        f"{case}: {arguments.repetitions} rounds, time step {step:.4g}, shear rate {rate:.4g}, kT "
        f"{thermal_energy:.4g}\n"
    )
    report(rounds, states, thermal_energy)


def report(rounds, states, thermal_energy):
    def spread(numbers, digits):
        low, middle, high = (f"{x:.{digits}f}" for x in (min(numbers), statistics.median(numbers), max(numbers)))
        return f"{middle:>8} {low:>8} .. {high:<8}"

    print(f"{'':<18} ns per particle and step        over {OURS}              relative   temperature")
    print(f"{'':<18}   median smallest .. largest       median smallest .. largest   viscosity    over kT")
    for label, (viscosity, temperature) in states.items():
        times = [each[label] for each in rounds]
        ratios = [each[label] / each[OURS] for each in rounds]
        over_kt = f"{temperature / thermal_energy:.2f}" if thermal_energy else ""
        print(f"{label:<18} {spread(times, 1)}    {spread(ratios, 2)} {viscosity:>8.1f}{over_kt:>11}")
    print(flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("engine")
    parser.add_argument("--before")
    parser.add_argument("--repetitions", type=int, default=7)
    parser.add_argument("--strain", type=float, default=0.2)
    parser.add_argument("--skins", type=float, nargs="+", default=[SKIN])
    parser.add_argument("--lammps", default="lmp")
    arguments = parser.parse_args()
    with open("/proc/cpuinfo") as f:
        described = f.read()
    model, family = (re.search(rf"{key}\s*: (.*)", described)[1] for key in ("model name", "cpu family"))
    version = re.search(r"Simulator - (.*)", output_of(arguments.lammps, "-h"))[1]
    print(f"{model}, family {family}; one core each; LAMMPS {version}\n", flush=True)
    with tempfile.TemporaryDirectory() as folder:
        for case in DRIVES:
            compare(case, arguments, folder)


if __name__ == "__main__":
    main()
