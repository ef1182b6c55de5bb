#!/usr/bin/python3
"""release_drill.py FOLDER [--suite bookworm] [--mirror URL] [--root DIR]

Tests the packages that `./bootstrap.sh package` writes to FOLDER (build/package) on a bare Debian, as a user
without rights: the smallest that debootstrap makes, in a folder. Needs root, debootstrap, readelf and a
mirror; takes some ten minutes, half of them for the last campaign. --root keeps that folder for the next time.
Requirements:

    programs  need no shared library
    .tar.gz   unpacked by the user, runs the demonstration, also after a move; has studies, adapters and manual
    .deb      is installed by dpkg alone, runs the demonstration with equal bytes, and is removed completely
    .whl      is installed by pip beside Debian's NumPy, SciPy and matplotlib, and gives equal bytes. Then the way of a
              new user, timed: from pip to a figure with error bars of spheres whose sizes a laboratory has measured,
              rough under a sweep of the stress
"""
import argparse
import contextlib
import glob
import hashlib
import json
import math
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time

USER, HOME = "guest", "/home/guest"
DEMO = "share/peclet/results/demo/campaign.json"
# Debian's packages for the wheel's figures and fits.
PYTHON = "python3-venv python3-pip python3-numpy python3-scipy python3-matplotlib".split()


def fail(message):
    sys.exit(f"release_drill: {message}")


def only(pattern):
    found = glob.glob(pattern)
    if len(found) != 1:
        fail(f"{pattern}: must be one file, there are {len(found)}; `./bootstrap.sh package` makes it")
    return found[0]


def say(what):
    print(f"ok  {what}", flush=True)


class Root:
    """A Debian in a folder."""

    def __init__(self, path):
        self.path = path

    def run(self, *command, user=None, folder="/", check=True):
        words = [
            "chroot",
            *([f"--userspec={user}:{user}"] if user else []),
            self.path,
            "/usr/bin/env",
            "-i",
            "PATH=/usr/bin:/bin:/usr/sbin:/sbin",
            f"HOME={HOME}",
            "/bin/sh",
            "-c",
            'cd "$1" && shift && exec "$@"',
            "sh",
            folder,
            *command,
        ]
        done = subprocess.run(
            words, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True
        )
        if check and done.returncode != 0:
            fail(f"{' '.join(command)}: exit {done.returncode}\n{done.stdout}")
        return done.stdout

    def outside(self, path):
        return os.path.join(self.path, path.lstrip("/"))


@contextlib.contextmanager
def debian(arguments):
    with contextlib.ExitStack() as stack:
        path = arguments.root or stack.enter_context(tempfile.TemporaryDirectory(prefix="release-drill-"))
        path = os.path.abspath(path)
        os.makedirs(path, exist_ok=True)
        os.chmod(path, 0o755)  # a temporary folder is closed to other users
        if not os.path.exists(os.path.join(path, "etc/debian_version")):
            subprocess.run(
                ["debootstrap", "--variant=minbase", arguments.suite, path, arguments.mirror],
                check=True,
                stdout=subprocess.DEVNULL,
            )
        # The programs find themselves by /proc.
        subprocess.run(["mount", "-t", "proc", "proc", os.path.join(path, "proc")], check=True)
        stack.callback(subprocess.run, ["umount", os.path.join(path, "proc")], check=True)
        root = Root(path)
        root.run("sh", "-c", f"id {USER} >/dev/null 2>&1 || useradd --create-home {USER}")
        shutil.rmtree(root.outside(HOME))
        os.mkdir(root.outside(HOME))
        root.run("chown", f"{USER}:{USER}", HOME)
        yield root


def check_libraries(programs):
    for program in programs:
        said = subprocess.run(["readelf", "-l", "-d", program], check=True, capture_output=True, text=True).stdout
        if "NEEDED" in said or "INTERP" in said or "LOAD" not in said:
            fail(f"{program} asks for shared libraries:\n{said}")
        notes = subprocess.run(["readelf", "-n", program], check=True, capture_output=True, text=True).stdout
        [kernel] = re.findall(r"OS: Linux, ABI: ([\d.]+)", notes)
    say(f"the programs need no shared library, and Linux {kernel} or newer")


def demonstration(root, peclet, share, folder):
    """Returns the demonstration's table, and the SHA-256 of its canonical export."""
    table = root.run(peclet, "run", f"{share}/{DEMO}", "--directory", folder, "--quiet", user=USER, folder=HOME)
    if "3 points: 3 converged" not in table:
        fail(f"the demonstration does not converge:\n{table}")
    export = root.run(peclet, "export", folder, "--canonical", user=USER, folder=HOME)
    return table, hashlib.sha256(export.encode()).hexdigest()


def try_archive(root, archive):
    shutil.copy(archive, root.outside(HOME))
    root.run("tar", "xzf", os.path.basename(archive), user=USER, folder=HOME)
    top = os.path.basename(archive).removesuffix(".tar.gz")
    check_libraries([root.outside(f"{HOME}/{top}/bin/{name}") for name in ("peclet", "peclet-engine")])
    table, digest = demonstration(root, f"{HOME}/{top}/bin/peclet", f"{HOME}/{top}", f"{HOME}/demo.peclet")
    say(f"the archive runs the demonstration as a user without rights:\n\n{table}")

    root.run("mv", top, "elsewhere", user=USER, folder=HOME)
    peclet = f"{HOME}/elsewhere/bin/peclet"
    again, same = demonstration(root, peclet, f"{HOME}/elsewhere", f"{HOME}/demo.peclet")
    if (again, same) != (table, digest):
        fail(f"after a move the table is another:\n{again}")
    # Studies are scripts of Python, which this Debian lacks: the machine's own lists them.
    studies = [sys.executable, root.outside(f"{HOME}/elsewhere/share/peclet/results/run.py")]
    if "zero-shear" not in subprocess.run(studies, check=True, capture_output=True, text=True).stdout:
        fail("the moved archive does not find its studies")
    root.run(peclet, "init", "own.json", user=USER, folder=HOME)
    root.run(peclet, "validate", "own.json", user=USER, folder=HOME)
    root.run("test", "-x", "elsewhere/share/peclet/adapters/lammps/lammps_engine.py", user=USER, folder=HOME)
    root.run("test", "-s", "elsewhere/share/man/man1/peclet-run.1", user=USER, folder=HOME)
    say("moved to another folder it goes on, and finds engine, studies and adapters")
    return digest


def try_package(root, package, digest):
    before = root.run("dpkg-query", "-W")
    shutil.copy(package, root.outside("/tmp"))
    root.run("dpkg", "-i", f"/tmp/{os.path.basename(package)}")
    check_libraries([root.outside(f"/usr/bin/{name}") for name in ("peclet", "peclet-engine")])
    _, same = demonstration(root, "peclet", "/usr", f"{HOME}/package.peclet")
    if same != digest:
        fail("the package gives other bytes than the archive")
    say("dpkg installs the package with nothing beside it, and it gives the archive's bytes: it is the same engine")
    files = [f for f in root.run("dpkg", "-L", "peclet").split("\n") if os.path.isfile(root.outside(f))]
    root.run("dpkg", "--purge", "peclet")
    left = [f for f in files if os.path.exists(root.outside(f))]
    if left or root.run("dpkg-query", "-W") != before:
        fail(f"purging leaves {left}")
    say(f"purged, it leaves none of its {len(files)} files")


def measured_sizes():
    """Returns a distribution of diameters as a laser diffractometer saves it, with decimal commas."""
    diameters = [0.46 * 1.15**k for k in range(20)]
    shares = [math.exp(-0.5 * (math.log(d / 1.6) / 0.28) ** 2) for d in diameters]
    rows = [f"{d:.3f};{100 * share / sum(shares):.2f};".replace(".", ",") for d, share in zip(diameters, shares)]
    head = ["Sample Name;Silica;", "Obscuration (%);8,31;", "Size Classes (µm);Volume Density (%);"]
    return "\r\n".join([*head, *rows, ""]).encode("latin-1")


def campaign_of(particles):
    """Returns a sweep of the stress, in µm, mPa s and ms: friction acts above a critical load."""
    return {
        "name": "own",
        "scene": {
            "particles": {"count": 100, "density": 0.002, **particles},
            "volume_fraction": 0.5,
            "fluid": {"viscosity": 1},
            "flow": {"stress": 1},
            "contact": {"normal_stiffness": 1e6, "friction": 0.5, "critical_load": 4.3},
            "lubrication": {"form": "kim-karrila", "inner_gap": 1e-2, "outer_gap": 0.05},
            "duration": {"equilibration": {"stress_times": 40}, "production": {"stress_times": 150}},
        },
        "sweep": [{"set": "/flow/stress", "values": [1, 10, 100]}],
        "target": {"observable": "shear_rate", "relative_tolerance": 0.1},
        "realisations": {"minimum": 8, "maximum": 32},
    }


def try_wheel(root, wheel, digest):
    shutil.copy("/etc/resolv.conf", root.outside("/etc"))
    root.run("apt-get", "update", "-qq")
    root.run("apt-get", "install", "-y", "-qq", "--no-install-recommends", *PYTHON)
    shutil.copy(wheel, root.outside(HOME))
    started = time.monotonic()

    def run(*command):
        return root.run(*command, user=USER, folder=HOME)

    run("python3", "-m", "venv", "--system-site-packages", "env")
    run("env/bin/pip", "install", "--no-index", os.path.basename(wheel))
    if "No broken requirements" not in run("env/bin/pip", "check"):
        fail("pip check finds a fault")
    _, same = demonstration(root, f"{HOME}/env/bin/peclet", f"{HOME}/env", f"{HOME}/wheel.peclet")
    if same != digest:
        fail("the wheel gives other bytes than the archive")
    say("pip installs the wheel, and it gives the archive's bytes")

    with open(root.outside(f"{HOME}/sizes.csv"), "wb") as f:
        f.write(measured_sizes())
    sizes = run("env/bin/peclet", "sizes", "sizes.csv", "--sizes", "diameter", "--shares", "volume", "--count", "100")
    species = "".join(line for line in sizes.splitlines() if line.startswith('"'))
    with open(root.outside(f"{HOME}/own.json"), "w") as f:
        json.dump(campaign_of(json.loads("{" + species + "}")), f)
    for verb in (["validate"], ["plan"], ["run", "--quiet"], ["status", "--check"]):
        said = run("env/bin/python", "-m", "peclet", *verb, "own.json")
    run("env/bin/peclet", "plot", "own.json", "--quantity", "apparent_viscosity", "--output", "own.png")
    table = json.loads(run("env/bin/peclet", "plot", "own.json", "--quantity", "apparent_viscosity", "--json"))
    rows = sorted((p["settings"]["/flow/stress"], p["mean"], p["half_width"]) for p in table["points"])
    if not rows[-1][1] - rows[-1][2] > rows[0][1] + rows[0][2]:
        fail(f"rough spheres do not thicken: {rows}")
    with open(root.outside(f"{HOME}/own.png"), "rb") as f:
        if f.read(4) != b"\x89PNG":
            fail("own.png is no picture")
    say(f"from pip to a figure of one's own suspension in {time.monotonic() - started:.0f} s: {said.splitlines()[-1]}")
    for stress, mean, half in rows:
        print(f"      σ = {stress:<5g} η_r = {mean:.1f} ± {half:.1f}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder")
    parser.add_argument("--suite", default="bookworm")
    parser.add_argument("--mirror", default="http://deb.debian.org/debian")
    parser.add_argument("--root")
    arguments = parser.parse_args()
    if os.geteuid() != 0:
        fail("needs root, to make a Debian in a folder")
    for tool in ("debootstrap", "readelf"):
        if not shutil.which(tool):
            fail(f"needs {tool}: apt install debootstrap binutils")
    archive = only(f"{arguments.folder}/peclet-*-linux-x86_64.tar.gz")
    package, wheel = only(f"{arguments.folder}/peclet_*.deb"), only(f"{arguments.folder}/peclet-*.whl")
    with debian(arguments) as root:
        digest = try_archive(root, archive)
        try_package(root, package, digest)
        try_wheel(root, wheel, digest)


if __name__ == "__main__":
    main()
