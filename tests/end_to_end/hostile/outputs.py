"""Targets of --output: a file is replaced; links, devices, FIFOs and open descriptors stay."""
import os
import stat
import subprocess
import threading

from . import things
from .trial import Wrong

SCENE = """{ "particles": { "count": 20, "density": 0.1, "species": [ { "radius": 1, "volume_share": 1 } ] },
"volume_fraction": 0.2,
"fluid": { "viscosity": 0.1 }, "flow": { "shear_rate": 0.05 }, "contact": { "normal_stiffness": 1e4 },
"duration": { "equilibration": { "strain": 0.001 }, "production": { "strain": 0.01 } } }"""


class Writer:
    """A command with --output, and the beginning of its output."""

    def __init__(self, command, begins, folder):
        self.command, self.begins, self.folder = command, begins, folder

    def writes(self, output, code=0, shell=None):
        command = f"{self.command} --output {output}" if shell is None else shell.format(f"{self.command} --output")
        done = subprocess.run(["bash", "-c", command], cwd=self.folder, capture_output=True, text=True, timeout=60)
        if done.returncode != code:
            raise Wrong(f"{command}: exit code {done.returncode}, not {code}\n{done.stderr}")
        if code and (len(done.stderr.splitlines()) != 1 or done.stdout):
            raise Wrong(f"{command}: not one line: {done.stderr}")
        return done

    def expect(self, text, where):
        if not text.startswith(self.begins):
            raise Wrong(f"{self.command}: {where} has {text[:60]!r}")

    def path(self, name):
        path = os.path.join(self.folder, name)
        if os.path.lexists(path):
            os.unlink(path)
        return path


def read(path):
    if not os.path.exists(path):
        return ""
    with open(path) as f:
        return f.read()


def a_file(writer):
    path = writer.path("out")
    with open(path, "w") as f:
        f.write("old")
    writer.writes("out")
    writer.expect(read(path), "the file")


def a_link(writer):
    target, path = writer.path("target"), writer.path("out")
    os.symlink("target", path)
    for _ in range(2):  # to nothing, then to a file
        writer.writes("out")
        writer.expect(read(target), "the link's target")
        if not os.path.islink(path):
            raise Wrong(f"{writer.command}: the link is gone")


def a_fifo(writer):
    path = writer.path("out")
    os.mkfifo(path)
    got = []
    reader = threading.Thread(target=lambda: got.append(read(path)), daemon=True)
    reader.start()
    writer.writes("out")
    reader.join(20)
    writer.expect(got[0] if got else "", "the FIFO")
    if not stat.S_ISFIFO(os.lstat(path).st_mode):
        raise Wrong(f"{writer.command}: the FIFO is gone")


def a_device(writer):
    if not things.ROOT:
        raise things.NotTried("only root makes devices")
    path = writer.path("out")
    os.mknod(path, stat.S_IFCHR | 0o600, os.makedev(1, 3))
    writer.writes("out")
    if not stat.S_ISCHR(os.lstat(path).st_mode):
        raise Wrong(f"{writer.command}: the device is gone")


def standard_output(writer):
    writer.expect(writer.writes("/dev/stdout").stdout, "standard output")
    path = writer.path("out")
    writer.writes("", shell="{{ echo before; {} /dev/stdout; echo after; }} > out")
    text = read(path)
    if not text.startswith("before\n" + writer.begins) or not text.endswith("after\n"):
        raise Wrong(f"{writer.command}: a file that the shell has open has {text[:60]!r}")


def a_substitution(writer):
    path = writer.path("out")
    writer.writes("", shell="{} >(cat > out; touch done) && while [ ! -e done ]; do sleep 0.01; done; rm done")
    writer.expect(read(path), "what >(...) wrote")


def a_folder(writer):
    os.makedirs(os.path.join(writer.folder, "folder"), exist_ok=True)
    writer.writes("folder", 2)
    if os.listdir(os.path.join(writer.folder, "folder")):
        raise Wrong(f"{writer.command}: something is in the folder")


def an_absent_folder(writer):
    writer.writes("absent/out", 2)


KINDS = [a_file, a_link, a_fifo, a_device, standard_output, a_substitution, a_folder, an_absent_folder]


def check(peclet, engine, campaign):
    """Prints a line for each command; returns True if all passed."""
    folder = os.path.join(campaign, "outputs")
    os.makedirs(folder)
    with open(os.path.join(folder, "scene.json"), "w") as f:
        f.write(SCENE)
    passed = True
    for command, begins in (
        (f"{peclet} export ../drill.json --csv", "label"),
        (f"{peclet} report ../drill.json", "<!"),
        (f"{peclet} completion bash", "#"),
        (f"{engine} run scene.json", "{"),
    ):
        words = []
        for kind in KINDS:
            try:
                kind(Writer(command, begins, folder))
                words.append(kind.__name__.replace("_", " "))
            except things.NotTried as why:
                words.append(f"{kind.__name__.replace('_', ' ')} not tried ({why})")
            except Wrong as wrong:
                passed = False
                words.append(f"WRONG: {wrong}")
        print(f"{os.path.basename(command)} --output: {', '.join(words)}", flush=True)
    return passed
