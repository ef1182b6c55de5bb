"""Limits of the machine: room, rights, time, an environment."""
import glob
import os
import subprocess

from .night import NotTried

NOBODY = "setpriv --reuid=65534 --regid=65534 --clear-groups"


def export_on_full_disk(night):
    """The export written to a full disk"""
    night.has_run()
    night.types("peclet export night.json > /dev/full", 1, ["No space left on device", "--output"])
    night.types("peclet export night.json --output export.json && tail -c 2 export.json", 0)
    night.lost_nothing()


def as_nobody(night, command, code, says=()):
    """Runs the command as an ordinary user; root becomes one."""
    return night.types(f"{NOBODY} {command}" if os.geteuid() == 0 else command, code, says)


def read_only_folder(night):
    """In a folder that is somebody else's"""
    night.write()
    os.chmod(night.folder, 0o555)
    as_nobody(night, "peclet run night.json", 2, ["night.peclet", "Permission denied", "--directory"])
    os.chmod(night.folder, 0o755)
    night.types("mkdir -m 777 mine")
    as_nobody(night, "peclet run night.json --quiet --directory mine/night", 0, ["2 converged"])


def run_as_root(night):
    """Run as root once, then as oneself"""
    if os.geteuid() != 0:
        raise NotTried("not started as root")
    night.write()
    night.types('sudo() { "$@"; }; sudo peclet run night.json --quiet > table')
    night.remembers()
    os.chmod(night.folder, 0o755)
    as_nobody(night, "peclet status night.json", 0, ["2 converged"])
    as_nobody(night, "peclet run night.json", 1, ["belongs to the user root", "sudo chown -R nobody"])
    night.types("chown -R nobody night.peclet")
    as_nobody(night, "peclet run night.json --quiet", 0, ["2 converged"])
    night.lost_nothing()


def many_workers(night):
    """--workers 1000 on a laptop"""
    night.write()
    night.types("ulimit -n 64; peclet run night.json --workers 1000", 2, ["--workers"])
    night.types("peclet run night.json --workers 1000", 0, ["cores", "2 converged"])


def empty_environment(night):
    """From cron, with next to no environment"""
    night.write()
    night.types(f"env -i {night.programs}/peclet run night.json", 0, ["2 converged"])


def clock_set_back(night):
    """The clock set back by a day between two runs"""
    library = glob.glob("/usr/lib/*/faketime/libfaketime.so.1")
    if not library:
        raise NotTried("libfaketime is not installed")
    night.slow(200)
    night.write()
    night.types("peclet run night.json --workers 2 --time-limit 0.4 --quiet > table", 75)
    night.remembers()
    night.remarks("From here on the programs believe that it is yesterday (libfaketime).")
    night.environment.update(LD_PRELOAD=library[0], FAKETIME="-1d", DONT_FAKE_MONOTONIC="1")
    night.types("peclet run night.json --workers 2 --quiet", 0, ["2 converged"])
    night.lost_nothing()
    night.types("peclet doctor night.json", (0, 1), ["clock"])
    night.answers_as_undisturbed()


def can_mount(night):
    return (
        subprocess.run(
            ["unshare", "-m", "mount", "-t", "tmpfs", "none", night.folder], stderr=subprocess.DEVNULL, check=False
        ).returncode
        == 0
    )


def full_disk(night):
    """The disk full while it runs"""
    if not can_mount(night):
        raise NotTried("no file system can be mounted here")
    night.write()
    night.slow(300)
    script = (
        "unshare -m bash -c 'mkdir night.peclet && mount -t tmpfs -o size=16m none night.peclet && "
        "{ (sleep 1; head -c 20m /dev/zero > night.peclet/film.mkv; sleep 3; rm night.peclet/film.mkv) 2> /dev/null & "
        "peclet run night.json --workers 2; cp -r night.peclet kept.peclet; }'"
    )
    night.types(script, 0, ["is full", "no further seed is given out", "nothing is in the way any more", "2 converged"])


CASES = [export_on_full_disk, full_disk, read_only_folder, run_as_root, many_workers, empty_environment, clock_set_back]
SLOW = [full_disk, clock_set_back]
