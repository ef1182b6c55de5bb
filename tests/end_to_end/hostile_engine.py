#!/usr/bin/python3
"""hostile_engine.py BIN [--quick] [--way NAME ...] [--jobs 2] [--list]

Lets an engine lie in every way of hostile/lies.py, once and (without --quick) at every try. The run may not
crash or hang, its memory stays below 200 MB, and it prints short lines without control characters. In the end
it stores the honest campaign's results; a seed with a lie at every try is given up and counts as lost. Texts
of invalid results are also put into the spool of a campaign with an honest engine, and may not count.

Prints a line for each way; the exit code is 1 if one of them failed. BIN holds peclet.
"""
import argparse
import concurrent.futures
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time

from campaign_folder import CampaignFolder
from hostile import engine as honest_engine
from hostile import lies

ENGINE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "hostile", "engine.py")
CAMPAIGN = {
    "name": "hostile",
    "scene": {"peclet": 1},
    "target": {"observable": "relative_viscosity", "relative_tolerance": 0.05},
    "realisations": {"minimum": 4, "maximum": 4},
}
LEASE = 2  # [s]
MOST_MEMORY = 200_000  # [kB]
PATIENCE = 400  # of one run [s]; three waits for hello take a minute each
HONEST = lies.WAYS["honest"]


class Trouble(Exception):
    """A fault of a run."""


def expect(truth, message):
    if not truth:
        raise Trouble(message)


class Campaign(CampaignFolder):
    def __init__(self, programs, folder, way, times):
        document = {**CAMPAIGN, "engine": [ENGINE, way.name, str(times)]}
        super().__init__(programs, tempfile.mkdtemp(dir=folder), document)

    def verb(self, *words):
        return self.say(*words, timeout=PATIENCE)

    def run(self):
        """Returns the exit code; keeps the peak memory and the output."""
        with open(self.place("printed"), "wb") as printed:
            words = f"run hostile.json --workers 1 --threads 1 --lease {LEASE}".split()
            process = self.start(*words, stdout=subprocess.DEVNULL, stderr=printed)
            end = time.monotonic() + PATIENCE
            self.memory = 0
            while process.poll() is None:
                self.memory = max(self.memory, memory_of(process.pid))
                if time.monotonic() > end:
                    process.send_signal(signal.SIGABRT)
                    process.wait()
                    raise Trouble(f"still runs after {PATIENCE} s")
                time.sleep(0.01)
        with open(self.place("printed"), "rb") as f:
            self.printed = f.read()
        return process.returncode

    def export(self):
        done = self.verb("export", "hostile.json", "--json", "--canonical")
        expect(done.returncode == 0, f"export: {done.stderr.decode(errors='replace')}")
        return done.stdout

    def values(self):
        return dict(
            self.query(
                "SELECT seed, json_extract(numbers, '$[0]') FROM realisation LEFT JOIN numbers USING (point_id, seed) "
                "WHERE content_sha256 IS NOT NULL"
            )
        )


def memory_of(process):
    """Returns the peak resident memory [kB]; 0 if the process has ended or is not the program yet."""
    try:
        with open(f"/proc/{process}/status") as f:
            about = dict(line.split(":", 1) for line in f)
    except (FileNotFoundError, ProcessLookupError):
        return 0
    return int(about.get("VmHWM", "0").split()[0]) if about["Name"].strip() == "peclet" else 0


def judge_words(campaign, must_speak):
    lines = campaign.printed.split(b"\n")
    expect(not must_speak or len(campaign.printed) > 20, "says nothing")
    for line in lines:
        expect(len(line) < 500, f"a line of {len(line)} bytes: {line[:300]}")
        text = line.decode()  # fails if it is not UTF-8
        expect(text.isprintable(), f"control characters: {text!r}")


class Lab:
    def __init__(self, programs, folder):
        self.programs, self.folder = programs, folder
        campaign = Campaign(programs, folder, HONEST, 0)
        expect(campaign.run() == 0, f"the honest campaign: {campaign.printed.decode()}")
        self.values, self.export = campaign.values(), campaign.export()
        with open(os.path.join(campaign.folder, "starts")) as f:
            expect(len(f.read()) == 2, "the honest engine was started more often than twice")
        self.point = campaign.query("SELECT hash FROM point")[0][0]

    def try_out(self, way, times):
        campaign = Campaign(self.programs, self.folder, way, times)
        code = campaign.run()
        expect(code >= 0, f"ended by signal {-code}")
        expect(campaign.memory < MOST_MEMORY, f"{campaign.memory} kB of memory")
        judge_words(campaign, way.fate not in ("taken", "either"))
        if way.fate == "refused":
            expect(code in way.codes, f"exit code {code}: {campaign.printed.decode()}")
            expect(not os.path.exists(campaign.data), "something was written")
        else:
            self.judge_stored(campaign, way, times, code)
        shutil.rmtree(campaign.folder)
        return campaign.memory

    def judge_stored(self, campaign, way, times, code):
        said = campaign.printed.decode()
        wrong = {
            seed: value
            for seed, value in campaign.values().items()
            if value is not None and value != self.values.get(seed)
        }
        expect(not wrong, f"stored: {wrong}")
        verdict = campaign.query("PRAGMA integrity_check")
        expect(verdict == [("ok",)], f"integrity_check: {verdict}")
        if way.fate == "ends":
            expect(code in way.codes, f"exit code {code}: {said}")
            return
        outcomes = [row[0] for row in campaign.query("SELECT outcome FROM attempt WHERE seed = 2 ORDER BY attempt_id")]
        (state,) = campaign.query("SELECT state FROM realisation WHERE seed = 2")[0]
        if way.fate == "again" and times > 3:
            expect(state == "quarantined", f"the seed is {state} after {outcomes}")
            expect(code in (0, 3), f"exit code {code}: {said}")
            return
        expect(code == 0, f"exit code {code}: {said}")
        expect(campaign.export() == self.export, f"another export than the honest one; {outcomes}")
        expect(way.fate != "again" or (len(outcomes) > 1 and outcomes[0] != "result"), f"nobody noticed: {outcomes}")
        expect(way.fate != "taken" or outcomes == ["result"], f"it was not taken: {outcomes}")

    def try_spool(self):
        """Puts every invalid text and a valid one into the spool of a campaign with an honest engine."""
        campaign = Campaign(self.programs, self.folder, HONEST, 0)
        spool = os.path.join(campaign.data, "spool")
        os.makedirs(spool)
        texts = [way.text for way in lies.WAYS.values() if way.text and way.fate == "again"]
        job = {"point": self.point, "seed": 2}
        # These texts are valid by themselves; only the job that they answer shows the lie.
        sound = [lies.WAYS[name].text for name in ("seed another one", "seed not asked for yet", "engine another one")]
        texts = [text for text in texts if text not in sound]
        for number, text in enumerate(texts):
            with open(os.path.join(spool, f"strange-{number}.json"), "wb") as f:
                f.write(text(honest_engine.Engine.result(None, job)))
        code = campaign.run()
        expect(code == 0, f"exit code {code}: {campaign.printed.decode()}")
        expect(campaign.memory < MOST_MEMORY, f"{campaign.memory} kB of memory")
        judge_words(campaign, True)
        expect(campaign.export() == self.export, "another export than the honest one")
        kept = len(os.listdir(os.path.join(spool, "rejected")))
        expect(kept == len(texts), f"{kept} of {len(texts)} files were set aside")
        return campaign.memory


def chosen_ways(quick=False, parts_of_names=None):
    """Returns all ways, or those selected."""
    return [
        way
        for way in lies.WAYS.values()
        if way is not HONEST
        and not (quick and way.slow)
        and (not parts_of_names or any(part in way.name for part in parts_of_names))
    ]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("bin")
    parser.add_argument(
        "--quick", action="store_true", help="each way once, none that takes long; what runs with the tests"
    )
    parser.add_argument("--way", action="append", metavar="NAME", help="only these; a part of the name is enough")
    parser.add_argument("--jobs", type=int, default=4, help="runs at a time; most of them wait")
    parser.add_argument("--list", action="store_true", help="names the ways")
    arguments = parser.parse_args()
    chosen = chosen_ways(arguments.quick, arguments.way)
    if arguments.list:
        print("\n".join(way.name for way in chosen))
        return 0
    tasks = [(way, times) for way in chosen for times in ([1] if arguments.quick or way.fate != "again" else [1, 99])]
    folder = tempfile.mkdtemp(prefix="hostile-", dir="/dev/shm" if os.access("/dev/shm", os.W_OK) else None)
    failed, memories, began = [], [], time.monotonic()
    try:
        lab = Lab(os.path.abspath(arguments.bin), folder)
        with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
            runs = {
                pool.submit(lab.try_out, way, times): f"{way.name}, {'once' if times == 1 else 'always'}"
                for way, times in tasks
            }
            if not arguments.way:
                runs[pool.submit(lab.try_spool)] = "all texts in the spool"
            for run in concurrent.futures.as_completed(runs):
                try:
                    memories.append((run.result(), runs[run]))
                except Exception as error:  # runs the other ways
                    failed.append(runs[run])
                    print(f"{runs[run]}: {type(error).__name__}: {error}")
    finally:
        shutil.rmtree(folder, ignore_errors=True)
    print(
        f"{len(chosen)} ways, {len(runs)} runs in {time.monotonic() - began:.0f} s, {len(failed)} failed; most memory "
        "{} kB ({})".format(*max(memories, default=(0, "none")))
    )
    return 1 if failed or not memories else 0


if __name__ == "__main__":
    sys.exit(main())
