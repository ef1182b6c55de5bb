#!/usr/bin/python3
"""full_disk.py BIN [--only CASE]

Fills the file system of a campaign's database, spool, checkpoints, logs, and of all of them together, each in turn and
while the campaign runs with real engines. Nothing may be lost: the run must say once what is full, give out no further
seed, go on by itself when there is room, and export the same bytes as an undisturbed one. A run that is stopped while
its disk is full must leave with exit code 75 and go on afterwards. A file system that is too small for the campaign
ends it with exit code 75 and one message, and it goes on where it is moved.

The file systems are small tmpfs. Mounting them takes root, or an unprivileged user namespace (unshare -Urm), which the
script makes for itself; where the kernel grants neither, it fails and says so.
"""
import argparse
import json
import os
import signal
import sqlite3
import subprocess
import sys
import tempfile
import time

from drill.campaign import REAL

# Seeds of many checkpoints each here, and of some on a machine that is several times faster.
SCENE = dict(REAL["scene"], duration={"equilibration": {"strain": 0.3}, "production": {"strain": 4}})
CHECKPOINT_SECONDS = 0.02
FOLDERS = ("spool", "checkpoints", "logs", "backup", "failures")
CASES = {  # what is full: the folder whose file system is filled, and which folders have one of their own
    "everything": ("", ()),
    "database": ("", FOLDERS),
    "spool": ("spool", ("spool",)),
    "checkpoints": ("checkpoints", ("checkpoints",)),
    "logs": ("logs", ("logs",)),
}
SMALL = ("400k", "1m", "2m", "3m")  # the database alone, without results, takes half a megabyte


class Drill:
    """A campaign in a folder of its own, its runs, and what they said."""

    def __init__(self, peclet, folder):
        self.peclet, self.folder = peclet, folder
        os.makedirs(folder)
        with open(os.path.join(folder, "drill.json"), "w") as f:
            json.dump(dict(REAL, scene=SCENE, engine=["peclet-engine", "serve"]), f)

    def start(self):
        with open(os.path.join(self.folder, "log"), "a") as log:
            return subprocess.Popen(
                [self.peclet, "run", "drill.json", "--workers", "2", "--checkpoint", str(CHECKPOINT_SECONDS)],
                cwd=self.folder,
                stdout=log,
                stderr=log,
            )

    def export(self):
        return subprocess.run(
            [self.peclet, "export", "drill.json", "--json", "--canonical"],
            cwd=self.folder,
            capture_output=True,
            check=True,
        ).stdout

    def count(self, query):
        database = sqlite3.connect(f"file:{self.folder}/drill.peclet/campaign.db?mode=ro", uri=True)
        try:
            return database.execute(query).fetchone()[0]
        finally:
            database.close()


def in_own_namespace():
    """Starts this script again where it may mount; returns when it already may."""
    if os.environ.get("PECLET_MAY_MOUNT"):
        return
    ways = [["unshare", "-m"]] if os.geteuid() == 0 else []
    for way in ways + [["unshare", "-Urm"]]:
        with tempfile.TemporaryDirectory() as folder:
            if (
                subprocess.run(way + ["mount", "-t", "tmpfs", "none", folder], stderr=subprocess.DEVNULL).returncode
                == 0
            ):
                os.execvpe(way[0], way + [sys.executable] + sys.argv, {**os.environ, "PECLET_MAY_MOUNT": "1"})
    sys.exit(
        "full_disk.py: needs to mount a tmpfs: run it as root, or where unprivileged user namespaces are allowed "
        "(sysctl kernel.unprivileged_userns_clone, user.max_user_namespaces)"
    )


def mount(path, size):
    os.makedirs(path, exist_ok=True)
    subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={size}", "none", path], check=True)


class FullDisk:
    def __init__(self, peclet, folder, case):
        self.full, self.own = CASES[case]
        self.drill = Drill(peclet, folder)
        self.root = os.path.join(folder, "drill.peclet")
        mount(self.root, "16m")
        for name in self.own:
            mount(os.path.join(self.root, name), "16m")
        self.filler = os.path.join(self.root, self.full, "filler")

    def __enter__(self):
        return self

    def __exit__(self, *raised):
        for folder in [os.path.join(self.root, name) for name in self.own] + [self.root]:
            subprocess.run(["umount", "--lazy", folder], check=True)

    def log(self):
        with open(os.path.join(self.drill.folder, "log")) as f:
            return f.read()

    def fill(self):
        with open(self.filler, "ab", buffering=0) as f:
            try:
                while True:
                    f.write(bytes(4096))
            except OSError:
                pass

    def keep_full(self, seconds):
        """Whatever is freed is taken again, as by a neighbour who writes without end."""
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            self.fill()
            time.sleep(0.02)

    def attempts(self):
        return self.drill.count("SELECT count(*) FROM attempt")

    def wait(self, what, until, process):
        end = time.monotonic() + 120
        while not until():
            assert time.monotonic() < end, f"waited in vain for: {what}\n{self.log()}"
            assert process.poll() is None, f"the run ended before: {what}\n{self.log()}"
            time.sleep(0.02)

    def begun(self):
        try:
            return self.drill.count("SELECT count(*) FROM realisation WHERE state = 'done'") >= 2
        except sqlite3.Error:
            return False


def starve(disk, case):
    """A run whose disk is full for some seconds. Returns what it says of itself."""
    process = disk.drill.start()
    disk.wait("the first results", disk.begun, process)
    disk.fill()
    if case == "logs":  # nobody waits for a log
        disk.keep_full(1)
    else:
        end = time.monotonic() + 60
        while "is full" not in disk.log():
            assert (
                time.monotonic() < end and process.poll() is None
            ), f"it does not say that the disk is full\n{disk.log()}"
            disk.keep_full(0.1)
        before = disk.attempts()
        disk.keep_full(6)
        assert disk.attempts() == before, "seeds were given out although the disk is full"
        assert disk.log().count("is full") == 1, disk.log()
    os.remove(disk.filler)
    return process


def stop_while_full(disk):
    process = disk.drill.start()
    disk.wait("the first results", disk.begun, process)
    disk.fill()
    end = time.monotonic() + 60
    while "is full" not in disk.log():
        assert time.monotonic() < end and process.poll() is None, disk.log()
        disk.keep_full(0.1)
    process.send_signal(signal.SIGTERM)
    started = time.monotonic()
    while process.poll() is None and time.monotonic() < started + 60:
        disk.keep_full(0.1)
    code = process.wait(1)
    os.remove(disk.filler)
    return code, time.monotonic() - started


def judge(disk, name, code, reference):
    same = disk.drill.export() == reference
    blamed = disk.drill.count("SELECT total(blamed) FROM attempt")
    done = disk.drill.count("SELECT count(*) FROM realisation WHERE state = 'done'")
    stored = disk.drill.count("SELECT count(*) FROM result")
    sound = disk.drill.count("PRAGMA integrity_check") == "ok"
    print(
        f"{name}: exit code {code}, same bytes {same}, realisations {done}, results {stored}, blamed {blamed:.0f}, "
        f"integrity {sound}",
        flush=True,
    )
    return code == 0 and same and done == stored and blamed == 0 and sound


def too_small(peclet, folder, size, reference):
    """The campaign's file system is too small for it: it ends by itself, says so, and goes on elsewhere to the same
    bytes."""
    drill = Drill(peclet, folder)
    root = os.path.join(folder, "drill.peclet")
    mount(root, size)
    try:
        code = drill.start().wait(300)
        with open(os.path.join(folder, "log")) as f:
            log = f.read()
        said = log.count("for which nobody can make room")
        moved = os.path.join(folder, "larger.peclet")
        subprocess.run(["cp", "-a", root, moved], check=True)
    finally:
        subprocess.run(["umount", "--lazy", root], check=True)
    os.rmdir(root)
    os.rename(moved, root)
    again = drill.start().wait(300)
    same = drill.export() == reference
    print(
        f"a file system of {size}: exit code {code}, said {said} times; in a larger one: exit code {again}, same "
        f"bytes {same}",
        flush=True,
    )
    return (code == 75 and said == 1 or code == 0) and again == 0 and same


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("bin")
    parser.add_argument("--only", choices=[*CASES, "small"])
    arguments = parser.parse_args()
    in_own_namespace()
    peclet = os.path.abspath(os.path.join(arguments.bin, "peclet"))
    passed = True
    with tempfile.TemporaryDirectory() as folder:
        undisturbed = Drill(peclet, os.path.join(folder, "undisturbed"))
        assert undisturbed.start().wait() == 0
        reference = undisturbed.export()
        if arguments.only in (None, "small"):
            for size in SMALL:
                passed &= too_small(peclet, os.path.join(folder, size), size, reference)
        for case in [case for case in CASES if arguments.only in (None, case)]:
            with FullDisk(peclet, os.path.join(folder, case), case) as disk:
                passed &= judge(disk, f"{case} full", starve(disk, case).wait(), reference)
        if not arguments.only or arguments.only == "everything":
            with FullDisk(peclet, os.path.join(folder, "stopped"), "everything") as disk:
                code, seconds = stop_while_full(disk)
                print(f"SIGTERM while everything is full: exit code {code} after {seconds:.1f} s")
                passed &= code == 75 and seconds < 30  # well before the owner would kill its workers
                passed &= judge(disk, "and then resumed", disk.drill.start().wait(), reference)
    return 0 if passed else 1


if __name__ == "__main__":
    sys.exit(main())
