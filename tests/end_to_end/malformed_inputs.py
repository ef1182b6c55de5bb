#!/usr/bin/python3
"""malformed_inputs.py BIN

Gives the programs in BIN (peclet, peclet-engine) malformed scenes, configurations, campaigns, checkpoints,
frames and databases. Each must cause one line on standard error that names the fault, exit code 2 (6 for
files that the programs wrote), no standard output, and no change of any file.
"""
import copy
import hashlib
import json
import os
import signal
import socket
import sqlite3
import struct
import subprocess
import sys
import tempfile
import time

from thirty_spheres import thirty_spheres

SCENE = thirty_spheres(0.001, 0.005)
CAMPAIGN = {
    "name": "small",
    "scene": SCENE,
    "sweep": [{"set": "/flow/shear_rate", "values": [0.05, 0.04]}],
    "target": {"observable": "relative_viscosity", "relative_tolerance": 0.5},
    "realisations": {"minimum": 4, "maximum": 4},
    "engine": ["peclet-engine", "serve"],
}
CONFIGURATION = {
    "scene": {"fluid": {"viscosity": 0.1}, "contact": {"normal_stiffness": 1e4}},
    "state": {
        "box": {"lengths": [10, 10, 10], "tilt": 0},
        "radius": [1, 1],
        "position": [[1, 1, 1], [4, 4, 4]],
        "velocity": [[0, 0, 0], [0, 0, 0]],
        "angular_velocity": [[0, 0, 0], [0, 0, 0]],
    },
}
ABSENT = object()

# Pointer, value (ABSENT removes it), fragments of the message.
SCENE_FAULTS = [
    ("/fluid/viscosity", -1, ["/fluid/viscosity", "-1", "> 0"]),
    ("/fluid/viscosity", "thick", ["/fluid/viscosity", "thick", "number"]),
    ("/fluid/viscosty", 1, ["/fluid/viscosty", "viscosity"]),
    ("/particles", ABSENT, ["/particles", "missing"]),
    ("/particles/count", 0, ["/particles/count", "0"]),
    ("/particles/count", 2.5, ["/particles/count", "2.5"]),
    ("/particles/species", [], ["/particles/species"]),
    ("/particles/species/1/radius", -1.4, ["/particles/species/1/radius", "-1.4"]),
    ("/volume_fraction", 0.9, ["/volume_fraction", "0.9"]),
    ("/volume_fraction", None, ["/volume_fraction"]),
    ("/lubrication/outer_gap", 1.5, ["/lubrication/outer_gap", "1.5"]),
    ("/lubrication/inner_gap", 0.2, ["/lubrication", "0.2"]),
    ("/lubrication/form", "brenner", ["/lubrication/form", "brenner", "kim-karrila"]),
    ("/duration/production", {"brownian_times": 3}, ["/duration/production", "brownian_times"]),
    ("/start", {"list": "/" + "n" * 5000, "sha256": "0" * 64}, ["/start/list", "must be a file that is there"]),
    ("/duration/production", {"strain": 1e300}, ["/duration/production", "1e+300", "at most"]),
    ("/integrator", {"timestep": 1.0}, ["/integrator/timestep", ": 1: ", "at most"]),
    ("/peclet", 10, ["peclet"]),
]
CONFIGURATION_FAULTS = [
    ("/state/position", [[1, 1, 1]], ["/state/position", "2"]),
    ("/state/radius/1", 0, ["/state/radius/1", "0"]),
    (
        "/state/springs",
        [{"i": 1, "j": 0, "image": [0, 0, 0], "tangential": [0, 0, 0], "rolling": [0, 0, 0]}],
        ["/state/springs/0/j"],
    ),
    ("/state/box/lengths", [1.5, 10, 10], ["image"]),
]
CAMPAIGN_FAULTS = [
    ("/name", "two words", ["/name", "two words"]),
    ("/target/relative_tolerance", 5, ["/target/relative_tolerance", "5"]),
    ("/target/observable", 7, ["/target/observable", "7"]),
    ("/realisations/minimum", 1, ["/realisations/minimum", "1"]),
    ("/realisations", {"minimum": 10, "maximum": 3}, ["/realisations", "3"]),
    ("/sweep/0/values", [], ["/sweep/0/values"]),
    ("/sweep/0/values", [0.05, 0.05], ["/sweep", "0.05"]),
    ("/sweep/0/set", "flow/shear_rate", ["/sweep/0/set", "flow/shear_rate"]),
    ("/scene/fluid/viscosity", -1, ["/scene/fluid/viscosity", "-1", "> 0"]),
    ("/engine", ["no-such-engine"], ["no-such-engine"]),
]


def altered(document, pointer, value):
    document = copy.deepcopy(document)
    *path, last = pointer.split("/")[1:]
    node = document
    for key in path:
        node = node[int(key) if isinstance(node, list) else key]
    if value is ABSENT:
        del node[last]
    elif isinstance(node, list):
        node[int(last)] = value
    else:
        node[last] = value
    return document


def snapshot(folder):
    """Returns the content of every file, without SQLite's side files and the owner's lock."""
    files = {}
    for root, folders, names in os.walk(folder):
        for name in folders:
            files[os.path.join(root, name)] = None
        for name in names:
            if name in ("campaign.lock", "campaign.db-wal", "campaign.db-shm"):
                continue
            path = os.path.join(root, name)
            with open(path, "rb") as f:
                files[path] = hashlib.sha256(f.read()).hexdigest()
    return files


def catches(process, number):
    """Returns True if a process handles a signal."""
    with open(f"/proc/{process}/status") as f:
        caught = next(line.split()[1] for line in f if line.startswith("SigCgt:"))
    return bool(int(caught, 16) >> (number - 1) & 1)


class Trial:
    def __init__(self, bin_folder):
        self.peclet = os.path.abspath(os.path.join(bin_folder, "peclet"))
        self.engine = os.path.abspath(os.path.join(bin_folder, "peclet-engine"))
        self.count = 0
        self.faults = []

    def judge(self, name, folder, before, run, code, fragments):
        self.count += 1
        errors = []
        if run.returncode != code:
            errors.append(f"exit code {run.returncode} instead of {code}")
        lines = [line for line in run.stderr.splitlines() if line.strip()]
        if len(lines) != 1:
            errors.append(f"{len(lines)} lines of message")
        errors += [f"the message lacks {f!r}" for f in fragments if f not in run.stderr]
        if run.stdout:
            errors.append("something on standard output")
        if snapshot(folder) != before:
            errors.append("files changed")
        if errors:
            self.faults.append(f"{name}: {'; '.join(errors)}\n    {run.stderr.strip()[:300]}")

    def refuse(self, name, folder, command, code, fragments):
        before = snapshot(folder)
        run = subprocess.run(command, cwd=folder, capture_output=True, text=True, timeout=60)
        self.judge(name, folder, before, run, code, fragments)

    def file(self, name, text, command, fragments):
        with tempfile.TemporaryDirectory() as folder:
            with open(os.path.join(folder, "input.json"), "w") as f:
                f.write(text)
            self.refuse(name, folder, command + ["input.json"], 2, ["input.json"] + fragments)

    def scenes(self):
        run = [self.engine, "run"]
        for pointer, value, fragments in SCENE_FAULTS:
            self.file(f"scene {pointer}", json.dumps(altered(SCENE, pointer, value)), run, fragments)
        self.file("scene, cut off", json.dumps(SCENE)[:-20], run, ["line"])
        self.file("scene, duplicate key", '{"fluid": {}, "fluid": {}}', run, ["fluid"])
        with tempfile.TemporaryDirectory() as folder:
            self.refuse("scene, absent", folder, run + ["absent.json"], 2, ["absent.json"])

    def configurations(self):
        for pointer, value, fragments in CONFIGURATION_FAULTS:
            self.file(
                f"configuration {pointer}",
                json.dumps(altered(CONFIGURATION, pointer, value)),
                [self.engine, "forces"],
                fragments,
            )

    def campaigns(self):
        for pointer, value, fragments in CAMPAIGN_FAULTS:
            self.file(
                f"campaign {pointer}", json.dumps(altered(CAMPAIGN, pointer, value)), [self.peclet, "run"], fragments
            )
        self.file("campaign, a list", "[]", [self.peclet, "run"], [])

    def checkpoints(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "run.checkpoint")
            scene = copy.deepcopy(SCENE)
            scene["duration"]["production"] = {"strain": 1e6}
            with open(os.path.join(folder, "scene.json"), "w") as f:
                json.dump(scene, f)
            command = [self.engine, "run", "scene.json", "--checkpoint", "run.checkpoint"]
            process = subprocess.Popen(command, cwd=folder, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
            patience = time.monotonic() + 60
            while process.poll() is None and time.monotonic() < patience and not catches(process.pid, signal.SIGTERM):
                time.sleep(0.01)
            process.terminate()
            process.communicate()
            assert process.returncode == 75, f"no checkpoint to alter: exit code {process.returncode}"
            with open(path, "rb") as f:
                good = f.read()
            flipped = bytearray(good)
            flipped[len(good) // 2] ^= 4
            for name, content, more, fragments in [
                ("empty", b"", [], ["no checkpoint"]),
                ("torn", good[: len(good) // 3], [], ["torn"]),
                ("one bit flipped", bytes(flipped), [], ["checksum"]),
                ("of another version", good[:8] + struct.pack("<I", 99) + good[12:], [], ["version 99"]),
                ("of another seed", good, ["--seed", "1"], ["another seed"]),
            ]:
                with open(path, "wb") as f:
                    f.write(content)
                self.refuse(f"checkpoint, {name}", folder, command + more, 6, ["run.checkpoint"] + fragments)

    def frames(self):
        def frame(payload):
            return b"PCF1" + struct.pack("<I", len(payload)) + payload

        for name, sent, fragments in [
            ("not our protocol", b"GET / HTTP/1.1\r\n\r\n", ["PCF1"]),
            ("of another version", b"PCF9" + frame(b"{}")[4:], ["PCF1"]),
            ("announcing 4 GB", b"PCF1" + b"\xff\xff\xff\xff", ["4294967295"]),
            ("that is no JSON", frame(b"{nonsense"), []),
            ("without a type", frame(b"{}"), ["type"]),
            ("of an unknown type", frame(b'{"type": "coffee"}'), ["coffee"]),
            ("of a job without scene", frame(b'{"type": "job", "job": "1"}'), ["job"]),
        ]:
            with tempfile.TemporaryDirectory() as folder:
                before = snapshot(folder)
                ours, theirs = socket.socketpair()
                process = subprocess.Popen(
                    [self.engine, "serve"],
                    stdin=theirs,
                    stdout=subprocess.PIPE,
                    stderr=subprocess.PIPE,
                    cwd=folder,
                    text=True,
                )
                theirs.close()
                ours.sendall(sent)
                out, err = process.communicate(timeout=20)
                ours.close()
                run = subprocess.CompletedProcess([], process.returncode, out, err)
                self.judge(f"frame {name}", folder, before, run, 2, fragments)

    def databases(self):
        with tempfile.TemporaryDirectory() as folder:
            with open(os.path.join(folder, "small.json"), "w") as f:
                json.dump(CAMPAIGN, f)
            run = subprocess.run(
                [self.peclet, "run", "small.json", "--workers", "1"], cwd=folder, capture_output=True, text=True
            )
            assert run.returncode in (0, 3), run.stderr
            path = os.path.join(folder, "small.peclet", "campaign.db")
            with open(path, "rb") as f:
                good = f.read()

            def changed(pragma):
                with open(path, "wb") as f:
                    f.write(good)
                connection = sqlite3.connect(path)
                connection.execute(pragma)
                connection.commit()
                connection.execute("PRAGMA wal_checkpoint(TRUNCATE)")
                connection.close()
                with open(path, "rb") as f:
                    return f.read()

            for name, content, code in [
                ("that is none", b"once upon a time " * 500, 6),
                ("cut off", good[: len(good) // 2], 6),
                ("of another program", changed("PRAGMA application_id = 1"), 6),
                ("of another version", changed("PRAGMA user_version = 99"), 2),
            ]:
                for verb in ("status", "export", "run"):
                    for suffix in ("-wal", "-shm"):
                        if os.path.exists(path + suffix):
                            os.remove(path + suffix)
                    with open(path, "wb") as f:
                        f.write(content)
                    command = [self.peclet, verb, "small.json"]
                    self.refuse(f"database {name}, {verb}", folder, command, code, ["campaign.db"])


def main():
    trial = Trial(sys.argv[1])
    for part in (trial.scenes, trial.configurations, trial.campaigns, trial.checkpoints, trial.frames, trial.databases):
        part()
    for fault in trial.faults:
        print(fault)
    print(f"{trial.count - len(trial.faults)} of {trial.count} malformed inputs were refused as they should be")
    return 1 if trial.faults else 0


if __name__ == "__main__":
    sys.exit(main())
