#!/usr/bin/python3
"""conversation.py SCHEMAS SCENE ENGINE [ARGUMENT ...]

Plays the runner's part for one engine, in another language than both programs: asks about a scene, runs one seed of it,
and holds every frame and the result to schema/frames.schema.json and schema/result.schema.json with an independent
validator. Needs Debian's python3-jsonschema.
"""
import hashlib
import json
import pathlib
import socket
import struct
import subprocess
import sys
import tempfile

from jsonschema import Draft202012Validator, RefResolver


def validators(folder):
    schemas = {name: json.loads((folder / name).read_text()) for name in ("frames.schema.json", "result.schema.json")}
    for schema in schemas.values():
        Draft202012Validator.check_schema(schema)
    return [Draft202012Validator(schema, resolver=RefResolver(name, schema, store=schemas))
            for name, schema in schemas.items()]


class Engine:
    def __init__(self, command, frames):
        self.frames = frames
        self.socket, theirs = socket.socketpair()
        self.socket.settimeout(120)
        self.process = subprocess.Popen(command, stdin=theirs, stdout=subprocess.DEVNULL)
        theirs.close()

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


def converse(engine, scene, folder, result_schema):
    hello = engine.receive()
    assert hello["type"] == "hello", hello
    engine.send({"type": "validate", "request": 7, "scene": scene})
    answer = engine.receive()
    assert answer["type"] == "validated" and answer["request"] == 7, answer
    bad = dict(scene, fluid=dict(scene.get("fluid", {}), viscosity=-1))
    engine.send({"type": "validate", "request": 8, "scene": bad})
    answer = engine.receive()
    assert answer["type"] == "refused" and answer["pointer"] == "/fluid/viscosity", answer

    point = hashlib.sha256(json.dumps(scene, sort_keys=True).encode()).hexdigest()
    engine.send({"type": "job", "job": 1, "point": point, "seed": 3, "scene": scene, "threads": 1,
                 "checkpoint": str(folder / "checkpoint"), "checkpoint_seconds": 60, "progress_seconds": 0.01,
                 "spool": str(folder / "spool.json"), "failures": str(folder)})
    steps = []
    while (answer := engine.receive())["type"] == "progress":
        steps.append(answer["step"])
    assert answer["type"] == "result", answer
    assert steps == sorted(steps), steps
    text = (folder / "spool.json").read_bytes()
    assert answer["sha256"] == hashlib.sha256(text).hexdigest()
    result = json.loads(text)
    result_schema.validate(result)
    assert (result["point"], result["seed"]) == (point, 3)
    assert result["engine"] == hello["engine"]
    engine.send({"type": "drain"})
    assert engine.process.wait(60) == 0
    return result


def main():
    frames, result_schema = validators(pathlib.Path(sys.argv[1]))
    scene = json.loads(pathlib.Path(sys.argv[2]).read_text())
    with tempfile.TemporaryDirectory() as folder:
        result = converse(Engine(sys.argv[3:], frames), scene, pathlib.Path(folder), result_schema)
    print("ended with", result["ending"]["cause"])
    return 0


if __name__ == "__main__":
    sys.exit(main())
