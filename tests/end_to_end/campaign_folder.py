"""A folder with a campaign, for tests of whole programs, and its processes."""
import json
import os
import sqlite3
import subprocess
import time

# Queries of a campaign's database.
ENDED = "SELECT count(*) FROM realisation WHERE state = 'done'"
RESULTS = "SELECT count(*) FROM result"
BLAMED = "SELECT total(blamed) FROM attempt"

# Sixty spheres in shear, with implicit steps: a realisation takes some tenths of a second.
SMALL_SCENE = {
    "particles": {
        "count": 60,
        "density": 0.01,
        "species": [{"radius": 1, "number_share": 1}, {"radius": 1.4, "number_share": 1}],
    },
    "volume_fraction": 0.4,
    "fluid": {"viscosity": 0.1},
    "flow": {"shear_rate": 2},
    "contact": {"normal_stiffness": 1e4},
    "guard": {"largest_overlap": 0.1},  # so that no seed is lost
    "lubrication": {"form": "kim-karrila", "inner_gap": 0.03, "outer_gap": 0.1},
    "integrator": {"method": "implicit"},
    "duration": {"equilibration": {"strain": 0.3}, "production": {"strain": 3}},
}


class CampaignFolder:
    """The file NAME.json of a document, the programs that run it, and their output in the file `log`."""

    def __init__(self, programs, folder, document, environment=None):
        self.programs, self.folder, self.document = os.path.abspath(programs), folder, dict(document)
        self.peclet = self.program("peclet")
        self.file = document["name"] + ".json"
        self.data = self.place(document["name"] + ".peclet")
        self.environment = environment or {}  # in addition to this process's own
        os.makedirs(folder, exist_ok=True)
        self.write()

    def program(self, name):
        return os.path.join(self.programs, name)

    def place(self, *names):
        """Returns a path in the folder."""
        return os.path.join(self.folder, *names)

    def path(self, *names):
        """Returns a path in the folder that the campaign makes for itself."""
        return os.path.join(self.data, *names)

    def write(self):
        with open(self.place(self.file), "w") as f:
            json.dump(self.document, f)

    def start(self, *words, command=None, environment=None, **how):
        """Starts `peclet WORDS`, or another command, and returns its process."""
        variables = {**os.environ, **self.environment, **(environment or {})}
        with open(self.place("log"), "a") as log:
            how = {"stdin": subprocess.DEVNULL, "stdout": log, "stderr": log, **how}
            return subprocess.Popen(command or [self.peclet, *words], cwd=self.folder, env=variables, **how)

    def say(self, *words, **how):
        """Runs `peclet WORDS` to its end; returns exit code and output."""
        variables = {**os.environ, **self.environment}
        return subprocess.run([self.peclet, *words], cwd=self.folder, env=variables, capture_output=True, **how)

    def log(self):
        with open(self.place("log"), errors="replace") as f:
            return f.read()

    def export(self):
        """Returns the canonical export. Raises AssertionError if the verb fails."""
        done = self.say("export", self.file, "--json", "--canonical")
        assert done.returncode == 0, done.stderr.decode(errors="replace")
        return done.stdout

    def query(self, sql):
        """Returns rows of the database."""
        return query(self.path("campaign.db"), sql)

    def ask(self, sql):
        """Returns the first number of the first row."""
        return self.query(sql)[0][0]

    def ended(self):
        """Returns the number of results, 0 before the database has tables."""
        try:
            return self.ask(ENDED)
        except sqlite3.Error:
            return 0


def query(path, sql):
    database = sqlite3.connect(f"file:{path}?mode=ro", uri=True, timeout=20)
    try:
        return database.execute(sql).fetchall()
    finally:
        database.close()


def comes_true(is_so, seconds=20, nap=0.01):
    """Waits until a condition is met; returns False if that takes longer than `seconds`."""
    end = time.monotonic() + seconds
    while not is_so():
        if time.monotonic() > end:
            return False
        time.sleep(nap)
    return True


def children(process):
    try:
        with open(f"/proc/{process}/task/{process}/children") as f:
            return [int(word) for word in f.read().split()]
    except (FileNotFoundError, ProcessLookupError):
        return []


def processor_time(process):
    """Returns the processor time of a process [s]."""
    with open(f"/proc/{process}/stat") as f:
        fields = f.read().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def largest_memory(process):
    """Returns the peak memory of a process [MiB]; 0 for a zombie."""
    with open(f"/proc/{process}/status") as f:
        return next((int(line.split()[1]) / 1024 for line in f if line.startswith("VmHWM")), 0)


def processes_with(variable, value):
    """Returns the other processes with this variable in their environment."""
    mark, found = f"{variable}={value}".encode(), []
    for name in filter(str.isdigit, os.listdir("/proc")):
        try:
            with open(f"/proc/{name}/environ", "rb") as f:
                if mark in f.read().split(b"\0") and int(name) != os.getpid():
                    found.append(int(name))
        except OSError:
            pass  # ended, or another user's
    return found
