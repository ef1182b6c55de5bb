"""Follows runs by their events: usage event_lines.py PECLET FAKE_ENGINE EVENTS_SCHEMA."""
import fcntl
import json
import os
import signal
import sqlite3
import subprocess
import sys
import tempfile
import time
import unittest
from collections import Counter

import jsonschema

PECLET, FAKE_ENGINE, SCHEMA = map(os.path.abspath, sys.argv[1:4])
F_SETPIPE_SZ = 1031
POINTS, MINIMUM = 3, 8


class EventLines(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        with open(SCHEMA) as file:
            self.schema = jsonschema.Draft202012Validator(json.load(file))

    def path(self, name):
        return os.path.join(self.folder.name, name)

    def command(self, name):
        campaign = {
            "name": name,
            "scene": {"volume_fraction": 0.5},
            "sweep": [{"set": "/peclet", "values": [1, 10, 100]}],
            "target": {"relative_tolerance": 0.05},
            "realisations": {"minimum": MINIMUM, "maximum": 60},
            "engine": [FAKE_ENGINE],
        }
        with open(self.path(name + ".json"), "w") as file:
            json.dump(campaign, file)
        return [PECLET, "run", self.path(name + ".json"), "--workers", "2", "--jsonl", "--quiet"]

    def run_it(self, name, **environment):
        done = subprocess.run(self.command(name), capture_output=True, text=True, env={**os.environ, **environment})
        return done, self.events(done.stdout)

    def events(self, text):
        self.assertTrue(text.endswith("\n"))
        events = [json.loads(line) for line in text.splitlines()]
        for event in events:
            self.schema.validate(event)
        return events

    def query(self, name, sql):
        with sqlite3.connect(f"file:{self.path(name)}.peclet/campaign.db?mode=ro", uri=True) as database:
            return database.execute(sql).fetchall()

    def export(self, name):
        return subprocess.check_output([PECLET, "export", self.path(name + ".json"), "--canonical"])

    def seeds(self, events):
        return sorted(
            (e["point"]["label"], e["seed"], e["cause"], e["value"]) for e in events if e["event"] == "seed-ended"
        )

    def seeds_of_database(self, name):
        return sorted(
            self.query(
                name,
                "SELECT label, seed, cause, value FROM realisations "
                "WHERE state IN ('done', 'failed', 'quarantined')",
            )
        )

    def test_tell_every_seed_stop_test_and_decision_once(self):
        # Seed 7 crashes at each try, of which a seed may have three; seed 3 ends with a verdict.
        done, events = self.run_it("faults", PECLET_FAKE_FAULTS="overlap:3 crash:7")
        self.assertEqual(done.returncode, 3)
        self.assertEqual([events[0]["event"], events[-1]["event"]], ["begin", "end"])
        self.assertEqual(events[0]["points"], POINTS)
        self.assertEqual(events[-1]["exit_code"], 3)
        self.assertEqual(self.seeds(events), self.seeds_of_database("faults"))
        told = Counter(event["event"] for event in events)
        self.assertEqual(told["decided"], POINTS)
        self.assertEqual(told["stop_test"], self.query("faults", "SELECT count(*) FROM stop_test")[0][0])
        crashes = [e for e in events if e["event"] == "attempt-failed" and e["outcome"] == "crashed"]
        self.assertEqual(Counter(e["given_up"] for e in crashes), {False: 2 * POINTS, True: POINTS})
        self.assertTrue(all(e["blamed"] and e["seed"] == 7 for e in crashes))
        for event in events:
            if event["event"] == "decided":
                self.assertEqual(event["verdict"], "converged-with-losses")
                self.assertEqual(event["stop_test"]["lost"], 2)

    def test_tell_a_finished_campaign_nothing_new(self):
        self.run_it("again")
        done, events = self.run_it("again")
        self.assertEqual(done.returncode, 0)
        self.assertEqual([e["event"] for e in events if e["event"] != "progress"], ["begin", "end"])

    def test_tell_the_rest_after_a_stop(self):
        hold = self.path("hold")  # holds each point's last seed, so that the run does not end by itself
        with open(hold, "w"):
            pass
        held = {**os.environ, "PECLET_FAKE_HOLD": hold, "PECLET_FAKE_HOLD_SEED": str(MINIMUM - 1)}
        process = subprocess.Popen(self.command("stopped"), stdout=subprocess.PIPE, text=True, env=held)
        lines = []
        while sum('"seed-ended"' in line for line in lines) < 4:  # events come while the run lasts
            lines.append(process.stdout.readline())
            self.assertTrue(lines[-1], "the run ended early")
        patience = time.monotonic() + 60
        while self.query(
            "stopped", f"SELECT count(*) FROM realisation WHERE state = 'running' AND seed >= {MINIMUM - 1}"
        ) != [(2,)]:
            self.assertLess(time.monotonic(), patience, "no two workers are held")
            time.sleep(0.01)
        process.send_signal(signal.SIGTERM)
        lines += process.stdout.readlines()
        process.stdout.close()
        self.assertEqual(process.wait(), 75)
        first = self.events("".join(lines))
        self.assertEqual(first[-1]["exit_code"], 75)
        self.assertTrue(any(e["event"] == "attempt-failed" and not e["blamed"] for e in first))
        done, second = self.run_it("stopped")
        self.assertEqual(done.returncode, 0)
        self.assertEqual(self.seeds(first + second), self.seeds_of_database("stopped"))

    def test_are_given_up_when_their_reader_leaves(self):
        reader, writer = os.pipe()
        fcntl.fcntl(writer, F_SETPIPE_SZ, 4096)  # some events are left to be written
        process = subprocess.Popen(self.command("left"), stdout=writer, stderr=subprocess.PIPE, text=True)
        os.close(writer)
        self.assertEqual(len(os.read(reader, 100)), 100)
        os.close(reader)
        errors = process.communicate()[1]
        self.assertEqual(process.returncode, 0)
        self.assertEqual(errors.count("the run continues without them"), 1, errors)
        self.run_it("whole")
        self.assertEqual(self.export("left").replace(b"left", b"whole"), self.export("whole"))

    def test_do_not_hold_up_the_run_when_nobody_reads_them(self):
        reader, writer = os.pipe()
        fcntl.fcntl(writer, F_SETPIPE_SZ, 4096)
        process = subprocess.Popen(self.command("unread"), stdout=writer)
        os.close(writer)
        patience = time.monotonic() + 60
        while process.poll() is None and time.monotonic() < patience:
            time.sleep(0.05)
            try:
                decided = self.query("unread", "SELECT count(*) FROM stop_test WHERE verdict = 'converged'")[0][0]
            except sqlite3.OperationalError:  # there is no database yet
                continue
            if decided == POINTS:
                break
        # All points are decided although only some four kilobytes were taken; the reader can still have the rest.
        self.assertEqual(decided, POINTS)
        with os.fdopen(reader) as pipe:
            events = self.events(pipe.read())
        self.assertGreater(len(json.dumps(events)), 8192)
        self.assertEqual(events[-1]["event"], "end")
        self.assertEqual(process.wait(), 0)

    def test_end_with_the_error_that_ended_the_run(self):
        done, events = self.run_it("changing")
        self.assertEqual(done.returncode, 0)
        with open(self.path("changing.json")) as file:
            campaign = json.load(file)
        command = self.command("changing")
        campaign["target"]["relative_tolerance"] = 0.02  # reopens the points, which another engine must not continue
        with open(self.path("changing.json"), "w") as file:
            json.dump(campaign, file)
        other = {**os.environ, "PECLET_FAKE_IDENTITY": "another"}
        done = subprocess.run(command, capture_output=True, text=True, env=other)
        self.assertEqual(done.returncode, 6)
        last = self.events(done.stdout)[-1]
        self.assertEqual((last["event"], last["exit_code"]), ("end", 6))
        self.assertIn("one point never mixes two", last["message"])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
