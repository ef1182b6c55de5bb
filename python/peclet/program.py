"""The program peclet: where it is, and what it answers."""
import os
import shutil
import subprocess


class PecletError(Exception):
    """What peclet, or this package, says is wrong."""


def find_program(program=None):
    """Path of the program: as given, else of the variable PECLET of the environment, else of PATH."""
    name = program or os.environ.get("PECLET") or "peclet"
    path = shutil.which(name)
    if path is None:
        raise PecletError(f"{name}: no such program; install peclet, or name it by the variable PECLET")
    return path


def ask(program, *arguments, allowed=(0,)):
    """What `peclet ARGUMENTS` prints, as text. PecletError has what it says on standard error."""
    done = subprocess.run([find_program(program), *arguments], capture_output=True, text=True, encoding="utf-8")
    if done.returncode not in allowed:
        said = done.stderr.strip() or f"peclet {arguments[0]} ended with {done.returncode}"
        raise PecletError(said)
    return done.stdout
