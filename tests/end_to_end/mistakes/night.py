"""One mistake: its folder, the commands, the answers, and the required state."""
import contextlib
import json
import os
import re
import shutil
import signal
import sqlite3
import subprocess

from campaign_folder import comes_true, processes_with, query
from thirty_spheres import thirty_spheres

# A command that takes longer hangs [s].
PATIENCE = 120
# The fake engine's campaign: two points of eight seeds with one stop test each, 20 ms a seed by default.
CAMPAIGN = {
    "name": "night",
    "scene": {"fluid": {"viscosity": 1}, "peclet": 1},
    "sweep": [{"set": "/peclet", "values": [1, 2]}],
    "target": {"observable": "relative_viscosity", "relative_tolerance": 0.3},
    "realisations": {"minimum": 8, "maximum": 8},
    "engine": ["fake_engine"],
}
# A second of real physics per seed.
SCENE = thirty_spheres(0.5, 1)
REAL = dict(
    CAMPAIGN, scene=SCENE, sweep=[{"set": "/flow/shear_rate", "values": [0.05]}], engine=["peclet-engine", "serve"]
)


def workers_of(night):
    """Returns the engines of the case's campaign."""
    return processes_with("PECLET_CAMPAIGN", night.path("night.peclet"))


class Wrong(Exception):
    """An expectation of a case failed."""


class NotTried(Exception):
    """The machine lacks something that the case needs."""


class Night:
    def __init__(self, programs, folder):
        self.programs, self.folder = os.path.abspath(programs), folder
        self.environment = {**os.environ, "PATH": f"{self.programs}:/usr/bin:/bin", "PECLET_FAKE_STEP_MS": "2"}
        for name in ("PECLET_FAKE_FAULTS", "PECLET_FAKE_IDENTITY", "PECLET_FAKE_HOLD"):
            self.environment.pop(name, None)
        self.page = []  # commands and answers, for the transcript
        self.said = ""  # the last answer
        self.started = []
        self.known = {}  # results seen: (point, seed) -> hash of the final state

    # Actions of a person.

    def write(self, document=None, name="night.json"):
        with open(self.path(name), "w") as f:
            f.write(document if isinstance(document, str) else json.dumps(document or CAMPAIGN, indent=2) + "\n")

    def types(self, command, code=0, says=(), hides=()):
        """Runs a command line in a shell, judges exit code and answer, and returns the answer."""
        done = self.shell(command, stderr=subprocess.STDOUT)
        self.said = done.stdout
        self.page += [("types", command), ("answer", self.said)]
        self.judge(done.returncode, code, says, hides)
        return self.said

    def starts(self, command):
        """Starts the command line in the background, in its own process group like an interactive shell."""
        log = self.path(f"answer-{len(self.started)}")
        with open(log, "w") as f:
            how = {"stdin": subprocess.DEVNULL, "stdout": f, "stderr": f, "start_new_session": True}
            command_line = ["bash", "-c", "exec " + command]
            process = subprocess.Popen(command_line, cwd=self.folder, env=self.environment, **how)
        self.page.append(("types", command + " &"))
        self.started.append((process, log))
        return process

    def answer_of(self, process):
        """Returns the output of a started process until now."""
        with open(next(log for known, log in self.started if known is process)) as f:
            return f.read()

    def waits(self, process, code=0, says=(), hides=()):
        """Waits for the end of a started process and judges its exit code and answer."""
        got = process.wait(timeout=PATIENCE)
        self.said = self.answer_of(process)
        self.page.append(("answer", self.said))
        self.judge(got, code, says, hides)
        return self.said

    def stops(self, process):
        """Sends Ctrl-C."""
        self.page.append(("remark", "Ctrl-C."))
        process.send_signal(signal.SIGINT)

    def remarks(self, text):
        self.page.append(("remark", text))

    def follows(self, pattern=r"peclet [^`\n]*", code=0, says=()):
        """Types the command named in the last answer: the first match in backquotes or at a line's end."""
        found = re.search(rf"`({pattern})`|(?:with: |: )({pattern})$", self.said, re.MULTILINE)
        if not found:
            raise Wrong(f"no command to follow in: {self.said!r}")
        return self.types(found.group(1) or found.group(2), code, says)

    def has_run(self):
        """Runs the campaign to its end."""
        self.write()
        self.types("peclet run night.json --quiet > table")
        self.remembers()

    def has_begun(self, seconds):
        """Runs the campaign for a while, with slow seeds."""
        self.slow(300)
        self.write()
        self.types(f"peclet run night.json --quiet --workers 2 --time-limit {seconds} > table", 75)

    def ends(self):
        """Runs the campaign to its end, and requires that nothing is lost."""
        self.types("peclet run night.json --quiet", 0, ["2 converged"])
        self.lost_nothing()

    # Requirements.

    def judge(self, got, code, says, hides):
        codes = code if isinstance(code, tuple) else (code,)
        if got not in codes:
            raise Wrong(f"exit code {got} instead of {code}: {self.said!r}")
        for phrase in says:
            if phrase not in self.said:
                raise Wrong(f"the answer lacks {phrase!r}: {self.said!r}")
        for phrase in hides:
            if phrase in self.said:
                raise Wrong(f"the answer has {phrase!r}: {self.said!r}")
        if code not in (0, 3) and "Traceback" in self.said:
            raise Wrong(self.said)
        self.page.append(("code", got))

    def query(self, sql, data="night.peclet"):
        return query(self.path(data, "campaign.db"), sql)

    def results(self, data="night.peclet"):
        """Returns the results in the database of a campaign's folder."""
        rows = self.query(
            "SELECT hash, seed, final_state_sha256 FROM realisation JOIN point USING (point_id) "
            "WHERE state IN ('done', 'failed')",
            data,
        )
        return {(point, seed): state for point, seed, state in rows}

    def remembers(self, data="night.peclet"):
        self.known.update(self.results(data))
        return len(self.known)

    def lost_nothing(self, data="night.peclet", but=0):
        """Requires that every earlier result exists unchanged, except `but` that the mistake destroyed."""
        now = self.results(data)
        gone = [key for key, state in self.known.items() if now.get(key) != state]
        if len(gone) > but:
            raise Wrong(f"{len(gone)} of {len(self.known)} results are lost")
        self.page.append(("kept", len(self.known) - len(gone), len(gone)))

    def answers_as_undisturbed(self):
        """Requires the canonical export of a campaign without the mistake."""
        disturbed = self.quietly("peclet export night.json --canonical")
        self.quietly(
            "mkdir undisturbed && cp night.json undisturbed/ && cd undisturbed && peclet run night.json --quiet"
        )
        if self.quietly("cd undisturbed && peclet export night.json --canonical") != disturbed:
            raise Wrong("the export differs from that of an undisturbed campaign")
        self.page.append(("same",))

    # Tools of the methods above.

    def path(self, *names):
        return os.path.join(self.folder, *names)

    def shell(self, command, **how):
        how = {"stdin": subprocess.DEVNULL, "stdout": subprocess.PIPE, "text": True, "timeout": PATIENCE, **how}
        return subprocess.run(["bash", "-c", command], cwd=self.folder, env=self.environment, **how)

    def quietly(self, command):
        done = self.shell(command, stderr=subprocess.PIPE)
        if done.returncode not in (0, 3):
            raise Wrong(f"{command}: exit code {done.returncode}: {done.stdout}{done.stderr}")
        return done.stdout

    def wait_for(self, what, happened):
        def has_happened():
            with contextlib.suppress(OSError, sqlite3.Error):
                return happened()

        if not comes_true(has_happened, PATIENCE, 0.02):
            raise Wrong(f"{what}: not within {PATIENCE} s")

    def wait_for_results(self, count, data="night.peclet"):
        self.wait_for(f"{count} results", lambda: len(self.results(data)) >= count)

    def holds(self):
        """Makes the last seed of each point stop half-way, so that a run lasts until lets_go()."""
        with open(self.path("hold"), "w"):
            pass
        self.environment.update(PECLET_FAKE_HOLD=self.path("hold"), PECLET_FAKE_HOLD_SEED="7")

    def lets_go(self):
        with contextlib.suppress(FileNotFoundError):
            os.remove(self.path("hold"))

    def wait_for_answer(self, process, phrase):
        """Waits until the output of a started process contains `phrase`."""
        self.wait_for(f"the answer {phrase!r}", lambda: phrase in self.answer_of(process))

    def slow(self, milliseconds):
        self.environment["PECLET_FAKE_STEP_MS"] = str(milliseconds / 10)

    def close(self):
        for process, _ in self.started:
            if process.poll() is None:
                with contextlib.suppress(ProcessLookupError):
                    os.killpg(process.pid, signal.SIGKILL)
                process.wait()
        shutil.rmtree(self.folder, ignore_errors=True)
