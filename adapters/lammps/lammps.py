"""One LAMMPS process: started with a script and variables, heard while it runs, and never left behind."""
import collections
import ctypes
import math
import os
import re
import select
import signal
import subprocess

PR_SET_PDEATHSIG = 1
libc = ctypes.CDLL(None, use_errno=True)

# One thread, because the sums of several are not made in the same order twice; and without the daemon that Open MPI
# starts beside a program that nobody has started with mpirun.
ENVIRONMENT = {**os.environ, "OMP_NUM_THREADS": "1", "OMPI_MCA_ess_singleton_isolated": "1", "LC_ALL": "C"}


class LammpsError(Exception):
    """LAMMPS said ERROR, or did not do what a script has to do."""


FROM_OUTSIDE = (signal.SIGKILL, signal.SIGTERM, signal.SIGINT, signal.SIGHUP)
# A launcher that is asked to leave ends its ranks and removes its files.
LAUNCHER_PATIENCE = 5


class KilledFromOutside(Exception):
    """Somebody has ended the process, which says nothing about the simulation."""

    def __init__(self, number):
        super().__init__(f"lmp was ended by signal {number}")
        self.signal = number


def die_with(parent):
    """In the child, before lmp starts: the kernel kills it as soon as the adapter is gone, however that went."""
    libc.prctl(PR_SET_PDEATHSIG, signal.SIGKILL)
    if os.getppid() != parent:
        os._exit(1)


class Thermo:
    """The thermo output in what LAMMPS prints: the rows of the latest run, as columns."""

    def __init__(self):
        self.columns, self.heading, self.inside, self.expect_heading = {}, [], False, False
        self.timestep = self.atoms = self.error = None
        self.last_lines = collections.deque(maxlen=12)

    def hear(self, line):
        self.last_lines.append(line)
        if found := re.match(r"  Time step\s*: (\S+)", line):
            self.timestep = float(found[1])
        elif line.startswith("ERROR"):
            self.error = self.error or line
        elif line.startswith("Per MPI rank memory allocation"):
            self.expect_heading = True
        elif self.expect_heading:
            self.heading, self.expect_heading, self.inside = line.split(), False, True
            self.columns = {name: [] for name in self.heading}
        elif found := re.match(r"Loop time of .* with (\d+) atoms", line):
            self.atoms, self.inside = int(found[1]), False
        elif self.inside:
            self.hear_row(line.split())

    def hear_row(self, words):
        if len(words) != len(self.heading):
            return  # a warning, or what the script prints
        try:
            values = [float(word) for word in words]
        except ValueError:
            return
        for name, value in zip(self.heading, values):
            self.columns[name].append(value)

    def steps_done(self):
        """Of the latest run."""
        steps = self.columns.get("Step")
        return int(steps[-1] - steps[0]) if steps else 0

    def is_finite(self):
        return all(math.isfinite(value) for column in self.columns.values() for value in column)


class Lammps:
    """A running `lmp -in script` in `folder`, or what `launcher` (words) makes of it. Use it in a with block, which
    ends it."""

    def __init__(self, program, launcher, script, folder, variables):
        # stdbuf: without it progress would come in pieces of 4 KiB.
        command = ["stdbuf", "-oL", program, "-in", script, "-log", "none"]
        environment = ENVIRONMENT
        self.is_launched = bool(launcher)
        if launcher:
            # Ranks are children of the launcher and would outlive one that is killed; so the kernel kills them with it.
            command = [*launcher, "setpriv", "--pdeathsig", "KILL", *command]
            # What a killed launcher leaves goes with the folder.
            environment = {**ENVIRONMENT, "TMPDIR": folder}
        for name, value in variables.items():
            command += ["-var", name, str(value)]
        parent = os.getpid()
        self.process = subprocess.Popen(
            command,
            cwd=folder,
            env=environment,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            preexec_fn=lambda: die_with(parent),
        )
        self.thermo = Thermo()
        self.unfinished_line = b""

    def __enter__(self):
        return self

    def __exit__(self, *_):
        if self.is_launched and self.process.poll() is None:
            self.process.terminate()
            try:
                self.process.wait(LAUNCHER_PATIENCE)
            except subprocess.TimeoutExpired:
                pass
        self.process.kill()
        self.process.wait()
        self.process.stdout.close()

    def listen(self, also, patience):
        """Takes in what has been printed. Returns whether it goes on, and whether `also` can be read."""
        ready = select.select([self.process.stdout, also], [], [], patience)[0]
        if self.process.stdout not in ready:
            return True, also in ready
        part = os.read(self.process.stdout.fileno(), 65536)
        *lines, self.unfinished_line = (self.unfinished_line + part).split(b"\n")
        for line in lines:
            self.thermo.hear(line.decode(errors="replace").rstrip("\r"))
        return bool(part), also in ready

    def finish(self, steps):
        """Once it has stopped printing: its thermo output, if it ran so many steps. Throws LammpsError,
        KilledFromOutside."""
        status = self.process.wait()
        # A launcher leaves as a shell does when one of its ranks was killed: with 128 + the signal.
        killer = status - 128 if self.is_launched and status > 128 else -status
        if killer in FROM_OUTSIDE and not self.thermo.error:
            raise KilledFromOutside(killer)
        if status != 0 or self.thermo.error:
            last = "\n".join(self.thermo.last_lines)
            print(f"lmp ended with {status}:\n{last}", flush=True)
            raise LammpsError(
                self.thermo.error or f"lmp ended with status {status}: {list(self.thermo.last_lines)[-1:]}"
            )
        heading = self.thermo.heading
        if self.thermo.atoms is None or "Step" not in heading or heading[0].startswith("-"):
            raise LammpsError(
                "the script has no run whose thermo output has a column Step and one line per sample "
                "(thermo_style one or custom)"
            )
        if self.thermo.steps_done() != steps:
            raise LammpsError(
                f"the script's last run was to make ${{steps}} = {steps} steps and made {self.thermo.steps_done()}"
            )
        return self.thermo
