"""Finds and calls the program peclet."""
import codecs
import ctypes
import math
import os
import select
import shutil
import signal
import subprocess
import sys
import time
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


def run_shown(program, *arguments, show=None):
    """Calls `peclet ARGUMENTS` and shows its output.

    show    function that is called about every second, and at the end, in the place of standard output

    Returns the exit code, the last message on standard error, and True if the call was interrupted. Passes an interrupt
    on to the program and waits for its end.
    """
    # The program has its own process group: a terminal or notebook sends signals to the whole group, and a second one
    # would stop it without checkpoints. The kernel asks it to stop if Python is killed. No thread reads its output: the
    # kernel would ask once for each thread of Python.
    process = subprocess.Popen(
        [find_program(program), *arguments],
        stdout=subprocess.DEVNULL if show else None,
        stderr=None if sys.stderr.isatty() and not show else subprocess.PIPE,
        start_new_session=True,
        preexec_fn=lambda: libc.prctl(PR_SET_PDEATHSIG, signal.SIGTERM),
    )
    said, interrupted, code = "", False, None
    decoder = codecs.getincrementaldecoder("utf-8")("replace")
    shown = -math.inf
    try:
        while code is None:
            try:
                if show and time.monotonic() >= shown + 1:
                    show()
                    shown = time.monotonic()
                if process.stderr is None:
                    code = process.wait()
                elif select.select([process.stderr], [], [], 1 if show else None)[0]:
                    new = os.read(process.stderr.fileno(), 1 << 16)
                    text = decoder.decode(new)
                    said += text
                    sys.stderr.write(text)
                    code = None if new else process.wait()
            except KeyboardInterrupt:
                interrupted = True
                process.send_signal(signal.SIGINT)
    finally:
        if process.poll() is None:  # show() has failed
            process.send_signal(signal.SIGINT)
            process.communicate()
        if process.stderr:
            process.stderr.close()
    if show:
        show()
    message = f"\n{said}".rfind("\npeclet: ")
    return code, said[message:].strip() if message >= 0 else "", interrupted
