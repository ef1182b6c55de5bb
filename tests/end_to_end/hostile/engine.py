#!/usr/bin/python3
"""engine.py WAY TIMES: an engine that is honest until it is asked for seed 2, whose first TIMES tries fail in
a WAY of lies.py. Ways with names that begin with hello or validate lie there instead.
"""
import hashlib
import json
import os
import select
import socket
import struct
import sys
import time

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
from hostile import lies

STEPS = 4
IDENTITY = {"version": "1.0", "instruction_set": "none", "binary_sha256": hashlib.sha256(b"hostile").hexdigest()}


def frame(payload):
    return b"PCF1" + struct.pack("<I", len(payload)) + payload


class Engine:
    def __init__(self, way, times):
        self.way, self.times = way, times
        self.socket = socket.socket(fileno=os.dup(0))
        self.received = b""
        self.starts = self.count("starts")  # the first start is asked about the scenes

    def count(self, name):
        """Returns the number of calls for `name` in the campaign's folder, this one included."""
        with open(name, "a+") as f:
            f.write("x")
            return f.tell()

    def send(self, message):
        self.send_bytes(frame(json.dumps(message).encode()))

    def send_bytes(self, data):
        self.socket.sendall(data)

    def receive(self, patience=None):
        """Returns a message, or None if none arrives in time. The end of the stream ends the engine."""
        while len(self.received) < 8 or len(self.received) < 8 + struct.unpack("<I", self.received[4:8])[0]:
            if not select.select([self.socket], [], [], patience)[0]:
                return None
            part = self.socket.recv(65536)
            if not part:
                sys.exit(0)
            self.received += part
        length = 8 + struct.unpack("<I", self.received[4:8])[0]
        payload, self.received = self.received[8:length], self.received[length:]
        return json.loads(payload)

    def hello(self):
        return {"type": "hello", "protocol": 1, "program": "hostile", "engine": IDENTITY}

    def run(self):
        hello = self.hello()
        if self.way.place == "hello" and self.starts > 1:
            self.way.lie(self, hello)
        else:
            self.send(hello)
        while (message := self.receive())["type"] not in ("drain", "stop"):
            if message["type"] == "validate":
                self.validate(message)
            else:
                self.run_job(message)

    def validate(self, message):
        answer = {
            "type": "validated",
            "request": message["request"],
            "timestep": 0.1,
            "steps": STEPS,
            "particles": 1,
            "derived": {},
            "warnings": [],
            "observables": ["relative_viscosity"],
        }
        if self.way.place == "validate":
            self.way.lie(self, answer)
        else:
            self.send(answer)

    def run_job(self, job):
        self.progress(job, 1)
        if job["seed"] == 2 and self.way.place == "job" and self.count("tries") <= self.times:
            self.way.lie(self, job)
            return
        if self.way.place == "after" and job["seed"] == 2 and self.count("tries") <= self.times:
            self.finish(job)
            self.way.lie(self, job)
            return
        self.finish(job)

    def finish(self, job):
        self.deliver(job, json.dumps(self.result(job)).encode())

    def progress(self, job, step, **changed):
        self.send(
            {
                "type": "progress",
                "job": job["job"],
                "phase": "production",
                "step": step,
                "steps": STEPS,
                "strain": 0.1,
                **changed,
            }
        )

    def result(self, job):
        value = 10 + 0.01 * (job["seed"] % 3)
        return {
            "schema_version": 1,
            "point": job["point"],
            "seed": job["seed"],
            "ending": {"cause": "completed", "step": STEPS, "message": "", "state": None},
            "method": None,
            "timestep": 0.1,
            "steps": {"equilibration": 0, "production": STEPS},
            "strain": {"equilibration": 0, "production": 0.4},
            "time": {"equilibration": 0, "production": 0.4},
            "derived": {},
            "warnings": [],
            "units": "scene",
            "mean": {"relative_viscosity": value, "control_variates": {"brownian_pairwise": None}},
            "blocks": {"relative_viscosity": [value] * 32},
            "statistical_inefficiency": 1,
            "largest_overlap": 0,
            "gate": None,
            "cost": {"cpu_seconds": 0.1, "wall_seconds": 0.1},
            "final_state_sha256": hashlib.sha256(str(job["seed"]).encode()).hexdigest(),
            "engine": IDENTITY,
        }

    def spool(self, job, text):
        temporary = f"{job['spool']}.{os.getpid()}.0.tmp"
        with open(temporary, "wb") as f:
            f.write(text)
        os.rename(temporary, job["spool"])

    def announce(self, job, text, **changed):
        self.send(
            {
                "type": "result",
                "job": job["job"],
                "spool": job["spool"],
                "sha256": hashlib.sha256(text).hexdigest(),
                **changed,
            }
        )

    def deliver(self, job, text):
        self.spool(job, text)
        self.announce(job, text)

    def wait(self):
        """Ignores messages until it is told to leave, then exits."""
        while self.receive()["type"] not in ("drain", "stop"):
            pass
        sys.exit(0)

    def stand_still(self):
        time.sleep(3600)


if __name__ == "__main__":
    try:
        Engine(lies.WAYS[sys.argv[1]], int(sys.argv[2])).run()
    except BrokenPipeError:  # the runner closed the connection
        sys.exit(1)
