"""A trial: a campaign with some ended seeds, an object in its folder, and the programs' reaction."""
import os
import re
import shutil
import signal
import subprocess
import time

from campaign_folder import CampaignFolder, query
from drill.campaign import FAKE, REAL
from .things import ROOT
from .ways import REFUSED

LONGEST_LINE = 500
MOST_MEMORY = 200  # of any process [MB]
PATIENCE = 60  # a longer run hangs [s]
CROWD_OF_THE_SHORT_FORM = 3000


class Wrong(Exception):
    pass


class Said:
    def __init__(self, code, out, err, memory):
        self.code, self.out, self.err, self.memory = code, out, err, memory
        self.lines = err.splitlines()


class Stock:
    """A campaign after its pilot and its answer, for each engine; made once and copied."""

    def __init__(self, programs, folder):
        self.peclet, self.engine, self.fake_engine = (
            os.path.abspath(os.path.join(programs, name)) for name in ("peclet", "peclet-engine", "fake_engine")
        )
        self.folder = folder
        self.known = {}

    def of(self, real):
        if real not in self.known:
            document = dict(REAL if real else FAKE, engine=[self.engine if real else self.fake_engine, "serve"])
            folder = os.path.join(self.folder, "real" if real else "fake")
            for place, words in ((folder + "-whole", ("run", "--quiet")), (folder, ("plan", "--pilot"))):
                CampaignFolder(os.path.dirname(self.peclet), place, document)
                run(self.peclet, place, words[0], "drill.json", words[1])
            self.known[real] = folder, export(self.peclet, folder + "-whole")
        return self.known[real]


NOBODY = {"user": 65534, "group": 65534, "extra_groups": []}


def run(peclet, folder, *arguments, humble=False):
    """Runs a command; the caller judges its memory, time and last word."""
    with open(os.path.join(folder, "said.out"), "wb") as out, open(os.path.join(folder, "said.err"), "wb") as err:
        process = subprocess.Popen(
            [peclet, *arguments],
            cwd=folder,
            stdin=subprocess.DEVNULL,
            stdout=out,
            stderr=err,
            start_new_session=True,
            **(NOBODY if humble and ROOT else {}),
        )
        end = time.monotonic() + PATIENCE
        while True:
            done, status, usage = os.wait4(process.pid, os.WNOHANG)
            if done:
                break
            if time.monotonic() > end:
                os.killpg(process.pid, signal.SIGKILL)
                os.wait4(process.pid, 0)
                process.returncode = -9
                raise Wrong(f"`peclet {' '.join(arguments)}` hangs")
            time.sleep(0.005)
        process.returncode = os.waitstatus_to_exitcode(status)
    texts = []
    for name in ("said.out", "said.err"):
        with open(os.path.join(folder, name), errors="surrogateescape") as f:
            texts.append(f.read())
        os.unlink(os.path.join(folder, name))
    return Said(process.returncode, *texts, usage.ru_maxrss / 1024)


def export(peclet, folder):
    said = run(peclet, folder, "export", "drill.json", "--json", "--canonical")
    if said.code != 0:
        raise Wrong(f"no export: {said.err}")
    return said.out


def picture(folder, but):
    """Returns the state of all files in `folder` outside `but`."""
    found = {}
    for place, folders, files in os.walk(folder):
        folders[:] = [name for name in folders if os.path.join(place, name) != but]
        for name in folders + files:
            path = os.path.join(place, name)
            about = os.lstat(path)
            content = None
            if os.path.islink(path):
                content = os.readlink(path)
            elif os.path.isfile(path):
                with open(path, "rb") as f:
                    content = f.read()
            found[path] = (about.st_mode, about.st_uid, content)
    return found


class Trial:
    def __init__(self, stock, folder, way, short):
        self.peclet, self.folder, self.way, self.short = stock.peclet, folder, way, short
        template, self.answer = stock.of(way.real)
        shutil.copytree(template, folder)
        self.data = os.path.join(folder, "drill.peclet")
        self.pristine = os.path.join(template, "drill.peclet")
        self.outside = os.path.join(folder, "outside")
        os.makedirs(self.outside)
        self.victim = os.path.join(self.outside, "victim")
        with open(self.victim, "w") as f:
            f.write('{"precious": true}\n')
        self.most = 0
        if way.humble and ROOT:
            for place, folders, files in os.walk(folder):
                for name in [".", *folders, *files]:
                    os.chown(os.path.join(place, name), NOBODY["user"], NOBODY["group"])

    def crowd(self, number):
        return min(number, CROWD_OF_THE_SHORT_FORM) if self.short else number

    def place(self):
        """Returns the path of the object, with the point and seed that a run takes next."""
        path = self.way.path
        if "{point}" in path:
            ((point, seed),) = query(
                os.path.join(self.data, "campaign.db"),
                "SELECT substr(hash, 1, 16), max(seed) + 1 FROM realisation JOIN point USING (point_id) "
                "WHERE state = 'done' GROUP BY point_id ORDER BY place LIMIT 1",
            )
            path = path.format(point=point, seed=seed)
        return os.path.join(self.data, path)

    def says(self, *arguments):
        said = run(self.peclet, self.folder, *arguments, humble=self.way.humble)
        verb = arguments[0]
        self.most = max(self.most, said.memory)
        if said.code < 0 or said.code not in (0, 1, 2, 3, 4, 6):
            raise Wrong(f"{verb} crashes: exit code {said.code}\n{said.err}")
        if said.memory > MOST_MEMORY:
            raise Wrong(f"{verb} takes {said.memory:.0f} MB")
        for line in said.lines:
            if len(line.encode(errors="surrogateescape")) > LONGEST_LINE:
                raise Wrong(f"{verb} says a line of {len(line)} characters: {line[:200]}")
            if re.search("[\x00-\x1f\x7f-\x9f\udc80-\udcff]", line):
                raise Wrong(f"{verb} says control characters or bytes: {line!r}")
        return said

    def judge(self):
        """Returns the run's line about the object; raises Wrong if the run misbehaves."""
        place = self.place()
        self.way.put(place, self)
        before = picture(self.folder, self.data)
        if not self.short:
            for verb, *more in (["status"], ["doctor"], ["explain"], ["backup", "copy"]):
                self.says(verb, "drill.json", *more)
            shutil.rmtree(os.path.join(self.folder, "copy"), ignore_errors=True)
        said = self.says("run", "drill.json", "--quiet", "--workers", "2")
        if picture(self.folder, self.data) != before:
            raise Wrong("what is outside of the campaign's folder has changed")
        about = [line for line in said.lines if self.way.says in line]
        if self.way.says and not about:
            raise Wrong(f"it does not say: {self.way.says}\n{said.err}")
        if self.way.outcome == REFUSED:
            self.judge_refusal(said, place)
        elif said.code not in (0, 3):
            raise Wrong(f"exit code {said.code}\n{said.err}")
        if export(self.peclet, self.folder) != self.answer:  # the export is read with full rights
            raise Wrong(f"another answer\n{said.err}")
        return about[0] if about and self.way.says else ""

    def judge_refusal(self, said, place):
        if said.code != self.way.code:
            raise Wrong(f"exit code {said.code}, not {self.way.code}\n{said.err}")
        if len(said.lines) != 1 or said.out:
            raise Wrong(f"not one line:\n{said.err}{said.out}")
        self.take_away(place)
        again = self.says("run", "drill.json", "--quiet", "--workers", "2")
        if again.code not in (0, 3):
            raise Wrong(f"exit code {again.code} when it had gone\n{again.err}")

    def take_away(self, place):
        if self.way.humble:
            os.chmod(place, 0o755)
            return
        if os.path.isdir(place) and not os.path.islink(place):
            shutil.rmtree(place)
        elif os.path.lexists(place):
            os.unlink(place)
        was = os.path.join(self.pristine, os.path.relpath(place, self.data))
        if os.path.isdir(was):
            shutil.copytree(was, place)
        elif os.path.exists(was):
            shutil.copy(was, place)
        shutil.rmtree(place + ".was", ignore_errors=True)
