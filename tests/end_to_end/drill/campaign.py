"""A campaign that is run, disturbed and run again, and the results that it has acknowledged."""
import contextlib
import hashlib
import json
import os
import re
import select
import shutil
import signal
import sqlite3
import subprocess
import tempfile

from campaign_folder import CampaignFolder, comes_true, processes_with

MARKER = "PECLET_DRILL_FOLDER"

# A campaign of the fake engine: two points, stop tests at 8, 10, 13 and 14 seeds.
FAKE = {
    "name": "drill",
    "scene": {"fluid": {"viscosity": 1}, "peclet": 1},
    "sweep": [{"set": "/peclet", "values": [1, 2]}],
    "target": {"observable": "relative_viscosity", "relative_tolerance": 0.08},
    "realisations": {"minimum": 8, "maximum": 14},
}
# A tenth of a second of real physics per seed.
REAL = {
    "name": "drill",
    "scene": {
        "particles": {
            "count": 60,
            "density": 0.1,
            "species": [{"radius": 1.0, "volume_share": 0.5}, {"radius": 1.4, "volume_share": 0.5}],
        },
        "volume_fraction": 0.4,
        "peclet": 10,
        "limits": {"shear_rate": 0.045, "thermal_energy": 0.01},
        "fluid": {"viscosity": 0.1},
        "contact": {"normal_stiffness": 1e4, "friction": 0.5},
        "lubrication": {"form": "kim-karrila", "inner_gap": 0.01, "outer_gap": 0.05},
        "duration": {"equilibration": {"strain": 0.3}, "production": {"strain": 2.7}},
        "files": {"final_configuration": True},
        "observables": ["stress", "trajectory"],
        "trajectory": {"interval": {"strain": 0.05}, "contacts": True},
    },
    "sweep": [{"set": "/peclet", "values": [10, 1000]}],
    "target": {"observable": "relative_viscosity", "relative_tolerance": 0.15},
    "realisations": {"minimum": 8, "maximum": 20},
}

# A run that takes longer hangs [s].
PATIENCE = 120


def alive(process):
    """Returns True if a process runs and is not a zombie."""
    try:
        with open(f"/proc/{process}/stat") as f:
            return f.read().rsplit(")", 1)[1].split()[0] not in "ZX"
    except (FileNotFoundError, ProcessLookupError):
        return False


def ends_within(process, seconds):
    """Waits for a child without the naps of Popen.wait(); returns False if it takes longer than `seconds`."""
    descriptor = os.pidfd_open(process.pid)
    try:
        return bool(select.select([descriptor], [], [], seconds)[0])
    finally:
        os.close(descriptor)


def stragglers(folder):
    """Returns the processes of the campaign in `folder` that still run."""
    return [process for process in processes_with(MARKER, folder) if alive(process)]


class Campaign(CampaignFolder):
    """A folder with drill.json, its runs, and the results acknowledged until now."""

    def __init__(self, lab, document=None, workers=2, lease=120, checkpoint=60, **fake):
        self.lab = lab
        self.workers, self.lease, self.checkpoint = workers, lease, checkpoint
        engine = lab.engine if document is REAL else lab.fake_engine
        document = dict(document or FAKE, engine=[engine, "serve"])
        fake.setdefault("files", 2)
        variables = {f"PECLET_FAKE_{name.upper()}": str(value) for name, value in fake.items()}
        self.safe = {}  # (hash, seed) -> (final state, last attempt when acknowledged)
        self.left_alone = False  # True if workers may outlive their owner
        self.unmount = None  # unmounts the campaign's own file system
        super().__init__(os.path.dirname(lab.peclet), tempfile.mkdtemp(dir=lab.folder), document, variables)

    def start(self, environment=None, command=None):
        self.left_alone = True
        words = f"run drill.json --workers {self.workers} --threads 1 --quiet --lease {self.lease} --checkpoint"
        variables = {**(environment or {}), MARKER: self.folder}
        return super().start(*words.split(), str(self.checkpoint), command=command, environment=variables)

    def run(self, environment=None):
        """Returns the exit code of a run, negative after a signal. A run that hangs is stopped by SIGABRT."""
        left_alone = self.left_alone
        process = self.start(environment)
        if not ends_within(process, PATIENCE):
            process.send_signal(signal.SIGABRT)
        code = process.wait()
        self.left_alone = left_alone or code < 0  # an owner that exits waits for its workers
        return code

    def settle(self):
        """Waits until the workers of dead owners have ended."""
        if not self.left_alone:
            return
        comes_true(lambda: not stragglers(self.folder), nap=0.005)
        for process in stragglers(self.folder):
            with contextlib.suppress(ProcessLookupError):
                os.kill(process, signal.SIGKILL)
        self.left_alone = False

    def spool(self):
        """Returns the final states of complete results in the spool, by point and seed."""
        found = {}
        with contextlib.suppress(FileNotFoundError):
            for name in os.listdir(self.path("spool")):
                if re.fullmatch(r"[0-9a-f]{16}-\d+-\d+\.json", name):
                    with contextlib.suppress(FileNotFoundError, ValueError, KeyError), open(
                        self.path("spool", name)
                    ) as f:
                        result = json.load(f)
                        found[result["point"][:16], result["seed"]] = result["final_state_sha256"]
        return found

    def query(self, sql):
        """Returns rows of the database, [] before it has tables."""
        # A rollback journal exists only until the database switches to a write-ahead log, before its tables
        # are made. A reader cannot roll it back.
        set_up = not os.path.exists(self.path("campaign.db-journal"))
        if not os.path.exists(self.path("campaign.db")):
            return []
        try:
            has_tables = super().query("SELECT count(*) FROM sqlite_schema")[0][0]
            return super().query(sql) if has_tables else []
        except sqlite3.OperationalError:
            if set_up:
                raise
            return []

    def count(self, sql):
        rows = self.query(sql)
        return rows[0][0] if rows else 0

    def results(self):
        """Returns the final states in spool and database: (prefix of the hash, seed) -> hash of the state."""
        spooled = self.spool()
        stored = self.query(
            "SELECT substr(hash, 1, 16), seed, final_state_sha256 FROM realisation JOIN point USING "
            "(point_id) WHERE state IN ('done', 'failed')"
        )
        return {**spooled, **{(point, seed): state for point, seed, state in stored}}

    def misplaced_files(self):
        """Returns faults of the files of realisations: files that are absent or differ, files without a row,
        and files in the spool."""
        files = dict(self.query("SELECT path, sha256 FROM files WHERE kept"))
        found = {
            os.path.relpath(os.path.join(folder, name), self.data)
            for top in ("files", "spool/files")
            for folder, _, names in os.walk(self.path(top))
            for name in names
        }
        wrong = sorted(found.symmetric_difference(files))
        for path in found.intersection(files):
            with open(self.path(path), "rb") as f:
                if hashlib.sha256(f.read()).hexdigest() != files[path]:
                    wrong.append(path)
        ended = self.count("SELECT count(*) FROM realisations WHERE cause = 'completed'")
        each = int(self.environment["PECLET_FAKE_FILES"]) if self.document["engine"][0] == self.lab.fake_engine else 2
        return wrong or ([] if len(files) == each * ended else [f"{len(files)} files of {ended} results"])

    def hashes_of_files(self):
        """Returns the hashes of files of the real engine's realisations: (point, seed, name) -> hash."""
        if self.document["engine"][0] != self.lab.engine:
            return {}
        return {tuple(row[:3]): row[3] for row in self.query("SELECT hash, seed, name, sha256 FROM files")}

    def last_attempt(self):
        return self.count("SELECT coalesce(max(attempt_id), 0) FROM attempt")

    def acknowledge(self):
        """Notes the acknowledged results; no owner may run."""
        last = self.last_attempt()
        for key, state in self.results().items():
            self.safe.setdefault(key, (state, last))

    def export(self):
        done = self.say("export", "drill.json", "--json", "--canonical", timeout=PATIENCE)
        return done.stdout if done.returncode == 0 else done.stderr

    def close(self):
        self.settle()
        if self.unmount:
            subprocess.run(["umount", self.unmount], check=True)
        shutil.rmtree(self.folder)


class Lab:
    """The programs, the folder of campaigns, and undisturbed answers, each computed once."""

    def __init__(self, programs, folder):
        self.peclet, self.engine, self.fake_engine, self.shim = (
            os.path.abspath(os.path.join(programs, name))
            for name in ("peclet", "peclet-engine", "fake_engine", "fault_shim.so")
        )
        self.folder = folder
        self.known = {}

    def undisturbed(self, campaign):
        """Returns exit code, canonical export and hashes of files of an undisturbed run by one worker."""
        steps = {name: value for name, value in campaign.environment.items() if name == "PECLET_FAKE_STEPS"}
        key = json.dumps([campaign.document, steps])
        if key not in self.known:
            quiet = Campaign(self, campaign.document, workers=1)
            quiet.document = campaign.document
            quiet.write()
            quiet.environment = steps
            self.known[key] = (quiet.run(), quiet.export(), quiet.hashes_of_files())
            if self.known[key][0] not in (0, 3):
                raise RuntimeError(f"the undisturbed campaign failed:\n{quiet.log()}")
            quiet.close()
        return self.known[key]
