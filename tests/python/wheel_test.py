#!/usr/bin/python3
"""wheel_test.py BUILD: tests the wheel of a build, installed by pip into a virtual environment.

The programs of a usual build need shared libraries, which this machine has; those of a release are static.
"""
import base64
import hashlib
import json
import os
import subprocess
import sys
import tarfile
import tempfile
import unittest
import zipfile
from pathlib import Path

BUILD = Path(sys.argv[1])
SOURCE = Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(SOURCE / "python"))
from build_backend import build_sdist, make_wheel

SCENE = {
    "particles": {"count": 50, "density": 0.1, "species": [{"radius": 1}]},
    "volume_fraction": 0.3,
    "fluid": {"viscosity": 0.1},
    "flow": {"shear_rate": 0.05},
    "contact": {"normal_stiffness": 1e4},
    "duration": {"equilibration": {"strain": 0}, "production": {"strain": 0.1}},
}


def said_by(*command, **options):
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, **options)
    if done.returncode != 0:
        raise AssertionError(f"{command}: {done.returncode}\n{done.stdout}{done.stderr}")
    return done.stdout


class Wheel(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.path = Path(cls.folder.name)
        said_by("cmake", "--install", BUILD, "--prefix", cls.path / "peclet")
        with tarfile.open(cls.path / "peclet.tar", "w") as tar:
            tar.add(cls.path / "peclet", "peclet")
        cls.wheel = cls.path / make_wheel(cls.path / "peclet.tar", cls.path)
        # Debian's venv has no pip of its own without python3-venv.
        said_by(sys.executable, "-m", "venv", "--system-site-packages", "--without-pip", cls.path / "env")
        cls.pip = (sys.executable, "-m", "pip", "--python", cls.path / "env/bin/python3")
        said_by(*cls.pip, "install", "--no-index", cls.wheel)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def test_records_every_file_with_its_hash(self):
        with zipfile.ZipFile(self.wheel) as file:
            [record] = [name for name in file.namelist() if name.endswith(".dist-info/RECORD")]
            rows = [row.rsplit(",", 2) for row in file.read(record).decode().splitlines()]
            self.assertEqual(sorted(row[0] for row in rows), sorted(file.namelist()))
            for path, digest, size in rows:
                if path != record:
                    sha256 = base64.urlsafe_b64encode(hashlib.sha256(file.read(path)).digest()).decode().rstrip("=")
                    self.assertEqual((digest, int(size)), ("sha256=" + sha256, file.getinfo(path).file_size), path)

    def test_has_the_same_bytes_each_time(self):
        (self.path / "again").mkdir()
        again = self.path / "again" / make_wheel(self.path / "peclet.tar", self.path / "again")
        self.assertEqual(again.read_bytes(), self.wheel.read_bytes())

    def test_lacks_nothing_that_pip_would_miss(self):
        # Packages of the machine may lack something; pip then exits with 1.
        checked = subprocess.run([*self.pip, "check"], capture_output=True, text=True).stdout
        self.assertEqual([line for line in checked.splitlines() if line.startswith("peclet ")], [])
        self.assertIn("Version: ", said_by(*self.pip, "show", "peclet"))

    def test_runs_as_a_module_with_the_programs_beside_the_interpreter(self):
        # A program of another release in PATH is not taken.
        (self.path / "other").mkdir()
        other = self.path / "other/peclet"
        other.write_text("#!/bin/sh\nexit 9\n")
        other.chmod(0o755)
        bare = {"PATH": f"{other.parent}:/usr/bin:/bin", "HOME": str(self.path)}
        python = self.path / "env/bin/python3"
        version = said_by(BUILD / "bin/peclet", "--version")
        self.assertEqual(said_by(python, "-m", "peclet", "--version", env=bare), version)
        campaign = {"name": "tiny", "scene": SCENE, "realisations": 2}
        (self.path / "tiny.json").write_text(json.dumps(campaign))
        said_by(python, "-m", "peclet", "run", "tiny.json", "--quiet", env=bare, cwd=self.path)
        exports = [
            said_by(program, "export", self.path / "tiny.json", "--canonical")
            for program in (self.path / "env/bin/peclet", BUILD / "bin/peclet")
        ]
        self.assertEqual(*exports)
        reading = "import peclet; print(peclet.open('tiny.json').estimates()['verdict'])"
        self.assertIn("complete", said_by(python, "-c", reading, env=bare, cwd=self.path))

    def test_draws_with_the_interpreter_of_its_environment(self):
        # A python3 that only the environment has; PATH has none that works.
        (self.path / "broken").mkdir()
        broken = self.path / "broken/python3"
        broken.write_text("#!/bin/sh\nexit 9\n")
        broken.chmod(0o755)
        bare = {"PATH": f"{broken.parent}:/usr/bin:/bin", "HOME": str(self.path)}
        campaign = {"name": "drawn", "scene": SCENE, "realisations": 2}
        campaign["sweep"] = [{"set": "/volume_fraction", "values": [0.2, 0.3]}]
        (self.path / "drawn.json").write_text(json.dumps(campaign))
        peclet = self.path / "env/bin/peclet"
        said_by(peclet, "run", "drawn.json", "--quiet", env=bare, cwd=self.path)
        said_by(peclet, "plot", "drawn.json", "--output", "drawn.png", env=bare, cwd=self.path)
        self.assertTrue((self.path / "drawn.png").read_bytes().startswith(b"\x89PNG"))


class SourceDistribution(unittest.TestCase):
    def test_has_what_git_keeps(self):
        with tempfile.TemporaryDirectory() as folder:
            with tarfile.open(os.path.join(folder, build_sdist(folder))) as tar:
                names = {name.split("/", 1)[1] for name in tar.getnames()}
        self.assertTrue({"PKG-INFO", "bootstrap.sh", "CMakeLists.txt", "python/build_backend.py"} <= names)
        self.assertFalse([name for name in names if name.startswith(("build/", ".git/"))])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
