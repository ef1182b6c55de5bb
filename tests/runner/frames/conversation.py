#!/usr/bin/python3
"""conversation.py [--refused POINTER=VALUE] SCHEMAS SCENE ENGINE [ARGUMENT ...]

Plays the runner's part for one engine, in another language than both programs. It asks about a scene and about a bad
one (SCENE with VALUE at POINTER; by default, a viscosity of -1). It runs one seed, runs it again and takes the job back
after the first progress, and runs it once more and hangs up; each time a new process continues. An engine that takes a
job ahead gets two at once, and a drain with two of them; one that runs several at once gets up to four, and a drain.
Every frame and result is held to schema/frames.schema.json and schema/result.schema.json with an independent validator
(Debian's python3-jsonschema), and results to each other.
"""
import argparse
import copy
import hashlib
import json
import pathlib
import socket
import struct
import subprocess
import sys
import tempfile

from jsonschema import Draft202012Validator, RefResolver

PATIENCE = 120


def validators(folder):
    schemas = {name: json.loads((folder / name).read_text()) for name in ("frames.schema.json", "result.schema.json")}
    for schema in schemas.values():
        Draft202012Validator.check_schema(schema)
    return [
        Draft202012Validator(schema, resolver=RefResolver(name, schema, store=schemas))
        for name, schema in schemas.items()
    ]


class Engine:
    """Engine process, from its hello to its exit."""

    def __init__(self, command, frames):
        self.frames = frames
        self.socket, theirs = socket.socketpair()
        self.socket.settimeout(PATIENCE)
        self.process = subprocess.Popen(command, stdin=theirs, stdout=subprocess.DEVNULL)
        theirs.close()
        hello = self.receive()
        assert hello["type"] == "hello", hello
        self.identity = hello["engine"]
        self.takes_ahead = hello.get("ahead", False)
        self.capacity = hello.get("capacity", 1)

    def send(self, message):
        self.frames.validate(message)
        payload = json.dumps(message).encode()
        self.socket.sendall(b"PCF1" + struct.pack("<I", len(payload)) + payload)

    def take(self, count):
        received = b""
        while len(received) < count:
            part = self.socket.recv(count - len(received))
            if not part:
                raise EOFError("the engine left")
            received += part
        return received

    def receive(self):
        magic, length = struct.unpack("<4sI", self.take(8))
        assert magic == b"PCF1", magic
        message = json.loads(self.take(length))
        self.frames.validate(message)
        return message

    def leave(self, how="drain"):
        """Ends the engine by `how`: drain, stop, hang up; or asked, if an idle engine was already told to drain."""
        if how == "hang up":
            self.socket.close()
        elif how != "asked":
            self.send({"type": how})
        status = self.process.wait(PATIENCE)
        assert how == "hang up" or status == 0, status


class Conversation:
    def __init__(self, command, scene, folder, schemas):
        self.command, self.scene, self.folder = command, scene, folder
        self.frames, self.result_schema = schemas
        self.point = hashlib.sha256(json.dumps(scene, sort_keys=True).encode()).hexdigest()

    def start(self):
        return Engine(self.command, self.frames)

    def abilities(self):
        engine = self.start()
        engine.leave()
        return engine.takes_ahead, engine.capacity

    def ask(self, refused, value):
        engine = self.start()
        engine.send({"type": "validate", "request": 7, "scene": self.scene})
        answer = engine.receive()
        assert answer["type"] == "validated" and answer["request"] == 7, answer
        engine.send({"type": "validate", "request": 8, "scene": with_value(self.scene, refused, value)})
        answer = engine.receive()
        assert answer["type"] == "refused" and answer["request"] == 8 and answer["pointer"] == refused, answer
        engine.leave("stop")

    def give_job(self, engine, job, checkpoint="checkpoint"):
        engine.send(
            {
                "type": "job",
                "job": job,
                "point": self.point,
                "seed": 3,
                "scene": self.scene,
                "threads": 1,
                "checkpoint": str(self.folder / checkpoint),
                "checkpoint_seconds": 0.01,
                "progress_seconds": 0.01,
                "spool": str(self.spool(job)),
                "files": self.files(job),
                "failures": str(self.folder),
            }
        )

    def files(self, job):
        return str(self.folder / f"files-{job}@")

    def spool(self, job):
        return self.folder / f"spool-{job}.json"

    def hear_result(self, engine, job):
        phases = ["packing", "equilibration", "production"]
        steps = [(0, 0)]
        while (answer := engine.receive())["type"] == "progress":
            steps.append((phases.index(answer["phase"]), answer["step"]))
        assert answer["type"] == "result" and answer["job"] == job, answer
        assert steps == sorted(steps), steps
        return self.read_result(engine, job, answer["sha256"])

    def read_result(self, engine, job, sha256):
        text = self.spool(job).read_bytes()
        assert sha256 == hashlib.sha256(text).hexdigest()
        result = json.loads(text)
        self.result_schema.validate(result)
        assert (result["point"], result["seed"]) == (self.point, 3)
        assert result["engine"] == engine.identity
        for file in result.get("files", []):
            content = pathlib.Path(self.files(job) + file["name"]).read_bytes()
            assert (len(content), hashlib.sha256(content).hexdigest()) == (file["bytes"], file["sha256"]), file
        checkpoint = self.folder / "checkpoint"
        checkpoint.unlink(missing_ok=True)  # as the runner does once it has the result
        return result

    def undisturbed(self, job):
        engine = self.start()
        self.give_job(engine, job)
        result = self.hear_result(engine, job)
        engine.leave()
        return result

    def disturbed(self, job, how):
        """Interrupts the job after its first progress and lets another process continue it.

        Returns its result and whether it was cut.
        """
        engine = self.start()
        self.give_job(engine, job)
        answer = engine.receive()
        was_cut = answer["type"] == "progress"
        told = was_cut and how == "drain"
        if told:
            engine.send({"type": "drain"})
            while (answer := engine.receive())["type"] == "progress":
                pass
            was_cut = answer["type"] == "drained"
        if answer["type"] == "result":  # the engine was faster than this program
            engine.leave("asked" if told else "drain")
            return self.read_result(engine, job, answer["sha256"]), False
        engine.leave("hang up" if how == "hang up" else "drain")
        return self.undisturbed(job + 1), was_cut

    def ahead(self, job):
        """Gives two jobs at once; returns one result after the other."""
        engine = self.start()
        self.give_job(engine, job)
        self.give_job(engine, job + 1)
        results = [self.hear_result(engine, number) for number in (job, job + 1)]
        engine.leave()
        return results

    def ahead_and_drained(self, job):
        """Drains an engine with a waiting job, which it gives up without a message. Returns whether it still waited."""
        engine = self.start()
        self.give_job(engine, job)
        answer = engine.receive()
        waits = answer["type"] == "progress"
        self.give_job(engine, job + 1)
        engine.send({"type": "drain"})
        while answer["type"] == "progress":
            answer = engine.receive()
        if answer["type"] == "result":  # it was faster than this program, and may have begun the other one
            waits = False
        else:
            assert answer["type"] == "drained" and answer["job"] == job, answer
            engine.send({"type": "drain"})
            try:
                raise AssertionError(engine.receive())
            except EOFError:
                assert not self.spool(job + 1).exists()
        if waits:
            engine.leave("asked")
        else:
            engine.process.kill()
            engine.process.wait()
        return waits

    def several(self, jobs):
        """Gives these jobs at once; returns their results, which come in any order."""
        engine = self.start()
        for job in jobs:
            self.give_job(engine, job, f"checkpoint-{job}")
        results = {}
        while len(results) < len(jobs):
            answer = engine.receive()
            assert answer["type"] in ("progress", "result") and answer["job"] in set(jobs) - set(results), answer
            if answer["type"] == "result":
                results[answer["job"]] = self.read_result(engine, answer["job"], answer["sha256"])
        engine.leave()
        return results.values()

    def several_drained(self, jobs):
        """Drains an engine with these jobs after the first progress; it answers each. Returns those taken back."""
        engine = self.start()
        for job in jobs:
            self.give_job(engine, job, f"checkpoint-{job}")
        open_jobs, back = set(jobs), []
        told = False
        while open_jobs:
            answer = engine.receive()
            assert answer["job"] in open_jobs, answer
            if not told:
                engine.send({"type": "drain"})
                told = True
            if answer["type"] != "progress":
                assert answer["type"] in ("result", "drained"), answer
                open_jobs.remove(answer["job"])
            if answer["type"] == "drained":
                back.append(answer["job"])
        engine.leave("drain" if answer["type"] == "drained" else "asked")
        return back


def with_value(scene, pointer, value):
    changed = copy.deepcopy(scene)
    *way, last = (part.replace("~1", "/").replace("~0", "~") for part in pointer.split("/")[1:])
    inner = changed
    for part in way:
        inner = inner[int(part)] if isinstance(inner, list) else inner.setdefault(part, {})
    inner[int(last) if isinstance(inner, list) else last] = value
    return changed


def without_cost(result):
    return {key: value for key, value in result.items() if key not in ("cost", "files")}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("schemas", type=pathlib.Path)
    parser.add_argument("scene", type=pathlib.Path)
    parser.add_argument("--refused", default="/fluid/viscosity=-1", metavar="POINTER=VALUE")
    parser.add_argument("engine", nargs=argparse.REMAINDER)
    arguments = parser.parse_args()
    pointer, _, value = arguments.refused.partition("=")
    with tempfile.TemporaryDirectory() as folder:
        conversation = Conversation(
            arguments.engine,
            json.loads(arguments.scene.read_text()),
            pathlib.Path(folder),
            validators(arguments.schemas),
        )
        conversation.ask(pointer, json.loads(value))
        result = conversation.undisturbed(1)
        print("ended with", result["ending"]["cause"])
        for job, how in ((2, "drain"), (4, "hang up")):
            again, was_cut = conversation.disturbed(job, how)
            assert without_cost(again) == without_cost(result), f"{how}: another result: {again}"
            print(f"{how}: {'cut and resumed' if was_cut else 'too fast to be cut'}, the same result")
        takes_ahead, capacity = conversation.abilities()
        if takes_ahead and capacity == 1:
            for again in conversation.ahead(6):
                assert without_cost(again) == without_cost(result), f"ahead: another result: {again}"
            waited = conversation.ahead_and_drained(8)
            print(f"ahead: the same results; {'given up by a drain' if waited else 'too fast to be drained'}")
        if capacity > 1:
            jobs = list(range(20, 20 + min(capacity, 4)))
            back = conversation.several_drained(jobs)
            for again in conversation.several(jobs):
                assert without_cost(again) == without_cost(result), f"several: another result: {again}"
            print(f"{len(jobs)} at once: the same results; {len(back)} of them cut by a drain and resumed")
    return 0


if __name__ == "__main__":
    sys.exit(main())
