"""Runs one LAMMPS process with a script and variables, and reads its thermo output."""
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

# One thread, because several add up in a different order each time. Open MPI must not start its daemon beside a program
# that runs without mpirun.
ENVIRONMENT = {**os.environ, "OMP_NUM_THREADS": "1", "OMPI_MCA_ess_singleton_isolated": "1", "LC_ALL": "C"}


class LammpsError(Exception):
    """LAMMPS reported an error, or the script does not do what the adapter requires."""


FROM_OUTSIDE = (signal.SIGKILL, signal.SIGTERM, signal.SIGINT, signal.SIGHUP)
# Time for a launcher to end its ranks and remove its files after SIGTERM [s].
LAUNCHER_PATIENCE = 5


class KilledFromOutside(Exception):
    """Another process or the user has ended LAMMPS; this is not a fault of the simulation."""

    def __init__(self, number):
        super().__init__(f"lmp was ended by signal {number}")
        self.signal = number


def die_with(parent):
    """Called in the child before lmp starts: has the kernel kill it as soon as the process `parent` has ended."""
    libc.prctl(PR_SET_PDEATHSIG, signal.SIGKILL)
    if os.getppid() != parent:
        os._exit(1)


class Thermo:
    """Reads the thermo output of the latest run from what LAMMPS prints: lists of numbers by column name.

    A row is a line of numbers whose Step is at most `steps` after that of the first row, by a multiple of the number in
    the command `thermo`. LAMMPS prints commands before it executes them (-echo screen).
    """

    def __init__(self, steps):
        self.columns, self.heading, self.inside, self.expect_heading = {}, [], False, False
        self.steps = steps
        self.every = 0  # steps between rows; 0: only at both ends of a run, LAMMPS' default; None: unknown
        self.timestep = self.atoms = self.error = None
        self.last_lines = collections.deque(maxlen=12)

    def hear(self, line):
        """Takes one line of output. Raises LammpsError as hear_row()."""
        self.last_lines.append(line)
        if found := re.match(r"  Time step\s*: (\S+)", line):
            self.timestep = float(found[1])
        elif line.startswith("ERROR"):
            self.error = self.error or line
        elif not self.inside and re.match(r"\s*run\s", line):
            # A run without set-up prints its heading at once; others print their memory before.
            self.columns, self.heading, self.atoms = {}, [], None
            self.expect_heading = re.search(r"\spre\s+no\b", line) is not None
        elif line.startswith("Per MPI rank memory allocation"):
            self.expect_heading = True
        elif self.expect_heading and not line.startswith("WARNING"):
            self.heading, self.expect_heading, self.inside = line.split(), False, True
            self.columns = {name: [] for name in self.heading}
        elif found := re.match(r"Loop time of .* with (\d+) atoms", line):
            self.atoms, self.inside = int(found[1]), False
        elif self.inside:
            self.hear_row(line)
        elif found := re.match(r"\s*thermo\s+(\S+)", line):
            self.every = int(found[1]) if found[1].isdigit() else None
        elif re.match(r"\s*echo\s+(none|log)\b", line):
            self.every = None

    def hear_row(self, line):
        """Takes one line of a run. Raises LammpsError if the script prints lines that look like rows."""
        try:
            row = dict(zip(self.heading, [float(word) for word in line.split()], strict=True))
        except ValueError:
            return  # a warning, or a line that the script prints
        before = self.columns.get("Step")
        if before:
            done = row["Step"] - before[0]
            if not 0 <= done <= self.steps or done % (self.every or self.steps or 1) != 0:
                return  # a line that the script prints
            if row["Step"] <= before[-1]:
                raise LammpsError(
                    f"the script prints lines that look like rows of thermo output: Step is {row['Step']:.0f} in "
                    f"'{line.strip()}', and {before[-1]:.0f} in a line before; they must begin with a word, or go to a "
                    "file alone (screen no)"
                )
        for name, value in row.items():
            self.columns[name].append(value)

    def steps_done(self):
        """Returns the number of steps that the latest run has made."""
        steps = self.columns.get("Step")
        return int(steps[-1] - steps[0]) if steps else 0

    def check(self):
        """Raises LammpsError unless the latest run has all rows of its steps."""
        if self.atoms is None or "Step" not in self.heading or self.heading[0].startswith("-"):
            raise LammpsError(
                "the script has no run whose thermo output has a column Step and one line per sample "
                "(thermo_style one or custom)"
            )
        if len(self.columns) < len(self.heading):
            raise LammpsError(f"two columns of the thermo output have the same name: {' '.join(self.heading)}")
        if self.every is None:
            raise LammpsError(
                "the script must give thermo a number of steps, and leave echo alone: these tell rows of thermo output "
                "from other lines"
            )
        if not self.columns["Step"]:
            raise LammpsError("the thermo output of the script's last run has no row of plain numbers")
        first = self.columns["Step"][0]
        if self.every and (first % self.every != 0 or self.steps % self.every != 0):
            # At other steps LAMMPS prints means of fixes from an earlier step, or 0.
            raise LammpsError(
                f"the script's last run has {self.steps} steps from step {first:.0f}, and rows of thermo output every "
                f"{self.every}: it must begin and end with one"
            )
        if self.steps_done() != self.steps:
            raise LammpsError(
                f"the script's last run was to make ${{steps}} = {self.steps} steps and made {self.steps_done()}"
            )
        rows, wanted = len(self.columns["Step"]), 1 + self.steps // (self.every or self.steps or 1)
        if rows != wanted:
            raise LammpsError(f"the thermo output of the script's last run has {rows} rows of {wanted}")

    def is_finite(self):
        return all(math.isfinite(value) for column in self.columns.values() for value in column)


class Lammps:
    """A process `lmp -in script` in `folder`, started through `launcher` (a list of words; may be empty).

    `variables` are given to the script as -var NAME VALUE. Use it in a with block, which ends the process.
    """

    def __init__(self, program, launcher, script, folder, variables):
        # Without stdbuf, progress would arrive in pieces of 4 KiB.
        command = ["stdbuf", "-oL", program, "-in", script, "-log", "none", "-echo", "screen"]
        environment = ENVIRONMENT
        self.is_launched = bool(launcher)
        if launcher:
            # Ranks are children of the launcher and would outlive a killed one; setpriv has the kernel kill them.
            command = [*launcher, "setpriv", "--pdeathsig", "KILL", *command]
            # Files that a killed launcher leaves are removed with the folder.
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
        self.thermo = Thermo(variables["steps"])
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
        """Reads output for up to `patience` [s]. Returns True while LAMMPS runs, and True if `also` is readable."""
        ready = select.select([self.process.stdout, also], [], [], patience)[0]
        if self.process.stdout not in ready:
            return True, also in ready
        part = os.read(self.process.stdout.fileno(), 65536)
        *lines, self.unfinished_line = (self.unfinished_line + part).split(b"\n")
        for line in lines:
            self.thermo.hear(line.decode(errors="replace").rstrip("\r"))
        return bool(part), also in ready

    def finish(self):
        """Returns the Thermo of the process once its output has ended. Raises LammpsError, KilledFromOutside."""
        status = self.process.wait()
        # If a rank was killed, a launcher exits as a shell does: with 128 + the signal.
        killer = status - 128 if self.is_launched and status > 128 else -status
        if killer in FROM_OUTSIDE and not self.thermo.error:
            raise KilledFromOutside(killer)
        if status != 0 or self.thermo.error:
            last = "\n".join(self.thermo.last_lines)
            print(f"lmp ended with {status}:\n{last}", flush=True)
            raise LammpsError(
                self.thermo.error or f"lmp ended with status {status}: {list(self.thermo.last_lines)[-1:]}"
            )
        self.thermo.check()
        return self.thermo
