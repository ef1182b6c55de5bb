"""Finds and calls the program peclet."""
import ctypes
import os
import shutil
import signal
import subprocess
import sys
import sysconfig

PR_SET_PDEATHSIG = 1
libc = ctypes.CDLL(None)


class PecletError(Exception):
    """An error that the program peclet or this package reports; its text is meant for users."""


def installed_beside():
    """Returns the folder of the programs that pip installs together with a package in the folder of this one."""
    package = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
    for scheme in sysconfig.get_scheme_names():
        if package in (sysconfig.get_path("platlib", scheme), sysconfig.get_path("purelib", scheme)):
            return sysconfig.get_path("scripts", scheme)
    return os.devnull  # not installed by pip


def find_program(program=None):
    """Returns the path of the program peclet.

    program    path or name; by default the environment variable PECLET, or else the program that pip installed
               together with this package, or else "peclet" on PATH

    Raises PecletError if it is not found.
    """
    name = program or os.environ.get("PECLET") or "peclet"
    chosen = program or os.environ.get("PECLET")
    beside = None if chosen else shutil.which(name, path=installed_beside())
    path = beside or shutil.which(name)
    if path is None:
        raise PecletError(
            f"{name}: no such program; install peclet, or set the environment variable PECLET to its path"
        )
    return path


def ask(program, *arguments, allowed=(0,)):
    """Calls `peclet ARGUMENTS` and returns its standard output as text.

    program    as for find_program()
    arguments  texts
    allowed    exit codes that are not errors

    Verbs that need Python find this interpreter. Raises PecletError with the program's standard error.
    """
    path = os.pathsep.join([os.path.dirname(sys.executable), os.environ.get("PATH", os.defpath)])
    how = {"capture_output": True, "text": True, "encoding": "utf-8", "env": {**os.environ, "PATH": path}}
    done = subprocess.run([find_program(program), *arguments], **how)
    if done.returncode not in allowed:
        said = done.stderr.strip() or f"peclet {arguments[0]} ended with {done.returncode}"
        raise PecletError(said)
    return done.stdout


def run_shown(program, *arguments):
    """Calls `peclet ARGUMENTS` and shows its output.

    Returns the exit code, the last message on standard error, and True if the call was interrupted. Passes an interrupt
    on to the program and waits for its end.
    """
    # The program has its own process group: a terminal or notebook sends signals to the whole group, and a second one
    # would stop it without checkpoints. The kernel asks it to stop if Python is killed.
    process = subprocess.Popen(
        [find_program(program), *arguments],
        stderr=None if sys.stderr.isatty() else subprocess.PIPE,
        start_new_session=True,
        preexec_fn=lambda: libc.prctl(PR_SET_PDEATHSIG, signal.SIGTERM),
    )
    said, interrupted, code = "", False, None
    while code is None:
        try:
            for line in process.stderr or ():
                text = line.decode(errors="replace")
                said = text if text.startswith("peclet: ") else said and said + text
                sys.stderr.write(text)
            code = process.wait()
        except KeyboardInterrupt:
            interrupted = True
            process.send_signal(signal.SIGINT)
    if process.stderr:
        process.stderr.close()
    return code, said.strip(), interrupted
