"""The program peclet: where it is, and what it answers."""
import ctypes
import os
import shutil
import signal
import subprocess
import sys

PR_SET_PDEATHSIG = 1
libc = ctypes.CDLL(None)


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
    """What `peclet ARGUMENTS` prints, as text. PecletError has what it says on standard error. Verbs that need Python
    find this one."""
    path = os.pathsep.join([os.path.dirname(sys.executable), os.environ.get("PATH", os.defpath)])
    how = {"capture_output": True, "text": True, "encoding": "utf-8", "env": {**os.environ, "PATH": path}}
    done = subprocess.run([find_program(program), *arguments], **how)
    if done.returncode not in allowed:
        said = done.stderr.strip() or f"peclet {arguments[0]} ended with {done.returncode}"
        raise PecletError(said)
    return done.stdout


def run_shown(program, *arguments):
    """Runs `peclet ARGUMENTS` and shows what it prints. Returns its exit code, what it said last on standard error, and
    whether it was interrupted. An interrupt is passed on, and the end that it leads to is waited for.
    """
    # The program has a process group of its own, because a second signal, as a terminal or notebook sends one to all of
    # the group, would stop it without checkpoints. It is asked to stop when Python is killed.
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
