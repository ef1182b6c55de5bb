#!/usr/bin/python3
"""full_disk.py BIN [--only CASE]

Fills the file system of a campaign's database, spool, checkpoints, logs, and of all of them together, each in
turn while real engines run. Nothing may be lost. The run must say once what is full, start no further seed,
continue by itself when there is room, and export the bytes of an undisturbed run. A run stopped while its
disk is full must exit with 75 and continue later. A file system too small for the campaign ends it with 75
and one message; it continues elsewhere.

The file systems are small tmpfs. Mounting them needs root, or an unprivileged user namespace (unshare -Urm),
which the script creates. If the kernel grants neither, it fails and says so.
"""
import argparse
import os
import signal
import subprocess
import sys
import tempfile
import time

from campaign_folder import BLAMED, ENDED, RESULTS, CampaignFolder, comes_true
from drill.campaign import REAL

# Seeds with many checkpoints, and some on a machine that is several times faster.
SCENE = dict(REAL["scene"], duration={"equilibration": {"strain": 0.3}, "production": {"strain": 4}})
CHECKPOINT_SECONDS = 0.02
FOLDERS = ("spool", "checkpoints", "logs", "backup", "failures")
CASES = {  # the folder that is filled, and the folders with file systems of their own
    "everything": ("", ()),
    "database": ("", FOLDERS),
    "spool": ("spool", ("spool",)),
    "checkpoints": ("checkpoints", ("checkpoints",)),
    "logs": ("logs", ("logs",)),
}
SMALL = ("400k", "1m", "2m", "3m")  # the database alone, without results, takes half a megabyte


class Drill(CampaignFolder):
    """A campaign in a folder of its own, its runs and their output."""

    def __init__(self, programs, folder):
        super().__init__(programs, folder, dict(REAL, scene=SCENE, engine=["peclet-engine", "serve"]))

    def start(self):
        return super().start("run", "drill.json", "--workers", "2", "--checkpoint", str(CHECKPOINT_SECONDS))


def in_own_namespace():
    """Restarts this script where it may mount; returns if it already may."""
    if os.environ.get("PECLET_MAY_MOUNT"):
        return
    ways = [["unshare", "-m"]] if os.geteuid() == 0 else []
    for way in ways + [["unshare", "-Urm"]]:
        with tempfile.TemporaryDirectory() as folder:
            tried = subprocess.run(way + ["mount", "-t", "tmpfs", "none", folder], stderr=subprocess.DEVNULL)
            if tried.returncode == 0:
                os.execvpe(way[0], way + [sys.executable] + sys.argv, {**os.environ, "PECLET_MAY_MOUNT": "1"})
    sys.exit(
        "full_disk.py: needs to mount a tmpfs: run it as root, or where unprivileged user namespaces are allowed "
        "(sysctl kernel.unprivileged_userns_clone, user.max_user_namespaces)"
    )


def mount(path, size):
    os.makedirs(path, exist_ok=True)
    subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={size}", "none", path], check=True)


class FullDisk(Drill):
    def __init__(self, programs, folder, case):
        super().__init__(programs, folder)
        full, own = CASES[case]
        self.mounted = [self.data, *(self.path(name) for name in own)]
        for place in self.mounted:
            mount(place, "16m")
        self.filler = self.path(full, "filler")

    def __enter__(self):
        return self

    def __exit__(self, *raised):
        for place in reversed(self.mounted):
            subprocess.run(["umount", "--lazy", place], check=True)

    def fill(self):
        with open(self.filler, "ab", buffering=0) as f:
            try:
                while True:
                    f.write(bytes(4096))
            except OSError:
                pass

    def keep_full(self, seconds):
        """Refills all freed room for `seconds` seconds."""
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            self.fill()
            time.sleep(0.02)

    def attempts(self):
        return self.ask("SELECT count(*) FROM attempt")

    def fill_under_a_run(self):
        """Returns the process of a run whose disk is full from its first results on."""
        process = self.start()
        begun = comes_true(lambda: self.ended() >= 2 or process.poll() is not None, 120, 0.02)
        assert begun, f"no results within 120 s\n{self.log()}"
        assert process.poll() is None, f"the run ended before the disk was full\n{self.log()}"
        self.fill()
        return process

    def wait_until_said(self, process):
        end = time.monotonic() + 60
        while "is full" not in self.log():
            in_time = time.monotonic() < end and process.poll() is None
            assert in_time, f"it does not say that the disk is full\n{self.log()}"
            self.keep_full(0.1)


def starve(disk, case):
    """Returns the process of a run whose disk is full for some seconds."""
    process = disk.fill_under_a_run()
    if case == "logs":  # a full log does not stop the run
        disk.keep_full(1)
    else:
        disk.wait_until_said(process)
        before = disk.attempts()
        disk.keep_full(6)
        assert disk.attempts() == before, "seeds were given out although the disk is full"
        assert disk.log().count("is full") == 1, disk.log()
    os.remove(disk.filler)
    return process


def stop_while_full(disk):
    process = disk.fill_under_a_run()
    disk.wait_until_said(process)
    process.send_signal(signal.SIGTERM)
    started = time.monotonic()
    while process.poll() is None and time.monotonic() < started + 60:
        disk.keep_full(0.1)
    code = process.wait(1)
    os.remove(disk.filler)
    return code, time.monotonic() - started


def judge(disk, name, code, reference):
    same, sound = disk.export() == reference, disk.ask("PRAGMA integrity_check") == "ok"
    blamed, done, stored = (disk.ask(query) for query in (BLAMED, ENDED, RESULTS))
    counts = f"realisations {done}, results {stored}, blamed {blamed:.0f}, integrity {sound}"
    print(f"{name}: exit code {code}, same bytes {same}, {counts}", flush=True)
    return code == 0 and same and done == stored and blamed == 0 and sound


def too_small(programs, folder, size, reference):
    """Runs the campaign on too small a file system: it ends with a message, and continues elsewhere."""
    drill = Drill(programs, folder)
    mount(drill.data, size)
    try:
        code = drill.start().wait(300)
        said = drill.log().count("for which no room can be made")
        moved = drill.place("larger.peclet")
        subprocess.run(["cp", "-a", drill.data, moved], check=True)
    finally:
        subprocess.run(["umount", "--lazy", drill.data], check=True)
    os.rmdir(drill.data)
    os.rename(moved, drill.data)
    again = drill.start().wait(300)
    same = drill.export() == reference
    text = f"a file system of {size}: exit code {code}, said {said} times; in a larger one: exit code {again}, same"
    print(f"{text} bytes {same}", flush=True)
    return (code == 75 and said == 1 or code == 0) and again == 0 and same


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("bin")
    parser.add_argument("--only", choices=[*CASES, "small"])
    arguments = parser.parse_args()
    in_own_namespace()
    passed = True
    with tempfile.TemporaryDirectory() as folder:
        undisturbed = Drill(arguments.bin, os.path.join(folder, "undisturbed"))
        assert undisturbed.start().wait() == 0
        reference = undisturbed.export()
        if arguments.only in (None, "small"):
            for size in SMALL:
                passed &= too_small(arguments.bin, os.path.join(folder, size), size, reference)
        for case in [case for case in CASES if arguments.only in (None, case)]:
            with FullDisk(arguments.bin, os.path.join(folder, case), case) as disk:
                passed &= judge(disk, f"{case} full", starve(disk, case).wait(), reference)
        if not arguments.only or arguments.only == "everything":
            with FullDisk(arguments.bin, os.path.join(folder, "stopped"), "everything") as disk:
                code, seconds = stop_while_full(disk)
                print(f"SIGTERM while everything is full: exit code {code} after {seconds:.1f} s")
                passed &= code == 75 and seconds < 30  # well before the owner would kill its workers
                passed &= judge(disk, "and then resumed", disk.start().wait(), reference)
    return 0 if passed else 1


if __name__ == "__main__":
    sys.exit(main())
