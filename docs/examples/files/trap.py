#!/usr/bin/env python3
"""An engine in Python: a Brownian particle in a harmonic trap, whose mean x^2 is kT/k. Change simulate()."""
import hashlib
import json
import math
import os
import random
import socket
import struct
import time

KEYS = "temperature", "stiffness", "timestep", "steps"
ENGINE = {"version": "1", "instruction_set": "python"}
ENGINE["binary_sha256"] = hashlib.sha256(open(__file__, "rb").read()).hexdigest()
runner = socket.socket(fileno=os.dup(0))  # standard input is a socket, for both directions


def simulate(scene, key):
    noise, x, total = random.Random(key), 0.0, 0.0
    decay = math.exp(-scene["stiffness"] * scene["timestep"])  # with friction 1; the step is exact
    amplitude = math.sqrt(scene["temperature"] / scene["stiffness"] * (1 - decay**2))
    for _ in range(int(scene["steps"])):
        x = decay * x + amplitude * noise.gauss(0, 1)
        total += x * x
    return {"square": total / scene["steps"]}


def send(message):
    payload = json.dumps(message).encode()
    runner.sendall(b"PCF1" + struct.pack("<I", len(payload)) + payload)


def receive():
    head = runner.recv(8, socket.MSG_WAITALL)
    return json.loads(runner.recv(struct.unpack("<I", head[4:])[0], socket.MSG_WAITALL)) if head else {"type": "stop"}


send({"type": "hello", "protocol": 1, "program": "trap", "engine": ENGINE})
while (message := receive())["type"] not in ("drain", "stop"):
    scene = message["scene"]
    if message["type"] == "validate":
        about = {"request": message["request"]}
        faults = [key for key in KEYS if not isinstance(scene.get(key), (int, float)) or not scene[key] > 0]
        if faults:
            about |= {"pointer": f"/{faults[0]}", "value": str(scene.get(faults[0], "missing"))}
            send({"type": "refused", **about, "allowed": "must be a number > 0"})
            continue
        about |= {"timestep": scene["timestep"], "steps": scene["steps"], "particles": 0}
        send({"type": "validated", **about, "derived": {}, "warnings": [], "observables": ["square"]})
        continue
    began, cpu = time.time(), time.process_time()
    mean = simulate(scene, f"{message['point']} {message['seed']}")  # no random number is shared by two points
    cost = {"cpu_seconds": time.process_time() - cpu, "wall_seconds": time.time() - began}
    result = {"schema_version": 1, "blocks": {}}
    result |= {"point": message["point"], "seed": message["seed"], "engine": ENGINE, "mean": mean, "cost": cost}
    result["final_state_sha256"] = hashlib.sha256(repr(mean).encode()).hexdigest()
    result["ending"] = {"cause": "completed", "step": scene["steps"]}
    text = json.dumps(result).encode()
    temporary = f"{message['spool']}.{os.getpid()}.0.tmp"
    with open(temporary, "wb") as file:
        file.write(text)
        file.flush()
        os.fsync(file.fileno())
    os.rename(temporary, message["spool"])
    send(
        {"type": "result", "job": message["job"], "spool": message["spool"], "sha256": hashlib.sha256(text).hexdigest()}
    )
