#!/usr/bin/python3
"""lying_far_end.py PROGRAMS

Runs campaigns whose launched workers lie about files: pieces out of order, repeated, of other jobs, with wrong hashes,
roles and names, without end, too many files, noise. Each lie is told once. The near end must refuse it with one line,
within 200 MiB of memory, and write nothing outside its folders; the campaign must then end with the results of a local
one. With a LIE and a FLAG as first words, it is the far end: a true one whose frames it changes.
"""
import json
import os
import subprocess
import sys
import tempfile
import threading

from campaign_folder import CampaignFolder, comes_true, largest_memory, processes_with

HERE = os.path.abspath(__file__)


def framed(message):
    """Returns a frame; the bytes of a piece follow it, and a line break follows them."""
    data = message.get("data")
    head = {key: value for key, value in message.items() if key != "data"}
    if data is not None:
        head = {"bytes": len(data)} | head
    payload = json.dumps(head).encode()
    return b"PCF1" + len(payload).to_bytes(4, "little") + payload + (b"" if data is None else data + b"\n")


def next_message(stream):
    """Returns the next message with its bytes, or nothing at the end."""
    header = stream.read(8)
    if len(header) < 8:
        return None
    message = json.loads(stream.read(int.from_bytes(header[4:], "little")))
    if message["type"] == "piece":
        message["data"] = stream.read(message.pop("bytes"))
        stream.read(1)
    return message


def changed(**members):
    return lambda piece: [dict(piece, **members)]


def endless(piece):
    data = bytes(300_000)
    offset = 0
    while True:
        yield {key: value for key, value in dict(piece, offset=offset, data=data).items() if key != "sha256"}
        offset += 300_000


def many_files(piece):
    for number in range(200):
        yield dict(piece, role="beside", name=f"x{number}")


LIES = {  # what is sent in the place of a piece of a result, and what the owner says
    "repeated": (lambda piece: [without_hash(piece), piece], "begins at byte 0 instead of"),
    "twice": (lambda piece: [piece, piece], "a file of a job twice"),
    "later": (changed(offset=5), "does not begin at byte 0"),
    "hash": (changed(sha256="0" * 64), "does not have its hash"),
    "role": (changed(role="database"), "/role"),
    "name": (changed(role="beside", name="../../../escaped"), "a name that is not plain"),
    "name of a folder": (changed(role="failure", name=".."), "a name that is not plain"),
    "job": (changed(job=4_000_000), "spoke of job 4000000, which it does not have"),
    "long piece": (changed(bytes=10**9), "at most 393216 bytes"),
    "short piece": (changed(bytes=5), "does not have its hash"),
    "endless": (endless, "has more than"),
    "many": (many_files, "files of a job"),
    "ready twice, of another protocol": (lambda piece: [{"type": "ready", "protocol": 2, "version": ""}], "/protocol"),
}
NOISE = {"silent noise": b"x" * 70_000, "noise behind the first frame": framed({"type": "ready"}) + b"noise" * 9}


def without_hash(piece):
    return {key: value for key, value in piece.items() if key != "sha256"}


def lie_once(name, flag, command):
    """Is a far end that tells one lie, unless the flag is there."""
    is_first = not os.path.exists(flag)
    if is_first and name in NOISE:
        open(flag, "w").close()
        sys.stdout.buffer.write(NOISE[name])
        sys.stdout.buffer.flush()
    true = subprocess.Popen(command, stdout=subprocess.PIPE)
    while True:
        message = next_message(true.stdout)
        if message is None:
            return
        if name in LIES and message["type"] == "piece" and message["role"] == "result" and not os.path.exists(flag):
            open(flag, "w").close()
            for lie in LIES[name][0](message):
                sys.stdout.buffer.write(framed(lie))
                sys.stdout.buffer.flush()
        else:
            sys.stdout.buffer.write(framed(message))
            sys.stdout.buffer.flush()


def check(holds, *what):
    if not holds:
        raise SystemExit("lying_far_end.py: " + " ".join(map(str, what)))


class Campaign(CampaignFolder):
    def __init__(self, programs, folder):
        with open(os.path.join(os.path.dirname(HERE), "..", "..", "results", "demo", "campaign.json")) as file:
            document = json.load(file)
        document["scene"]["particles"]["count"] = 40
        document["target"] = {"observable": "pressure", "absolute_tolerance": 1e9}
        document["realisations"] = {"minimum": 2, "maximum": 2}
        super().__init__(programs, folder, document)
        self.memory = 0

    def watch(self, process):
        while process.poll() is None:
            for worker in processes_with("PECLET_CAMPAIGN", self.data):
                try:
                    self.memory = max(self.memory, largest_memory(worker))
                except OSError:
                    pass
            comes_true(lambda: process.poll() is not None, 0.02)

    def run(self, *words):
        process = self.start("run", self.file, "--quiet", *words)
        watch = threading.Thread(target=self.watch, args=(process,))
        watch.start()
        try:
            return process.wait(timeout=120)
        finally:
            process.kill()
            watch.join()


def main():
    with tempfile.TemporaryDirectory() as folder:
        honest = Campaign(sys.argv[1], os.path.join(folder, "honest"))
        check(honest.run("--workers=1") == 0, honest.log())
        for number, name in enumerate([*LIES, *NOISE]):
            campaign = Campaign(sys.argv[1], os.path.join(folder, str(number)))
            flag = campaign.place("told")
            code = campaign.run(f"--launch=/usr/bin/python3 {HERE} '{name}' '{flag}'", "--workers=1", "--lease=20")
            said = campaign.log()
            check(code == 0, name, "ended with", code, said)
            expected = LIES[name][1] if name in LIES else ("frame" if "silent" in name else "")
            lines = [line for line in said.splitlines() if " ended: " in line]
            check(len(lines) == 1 and expected in lines[0], name, "was answered by", said)
            check(campaign.export() == honest.export(), name, "changed results")
            check(campaign.memory < 200, name, "took", campaign.memory, "MiB")
            check(not os.path.exists(campaign.place("escaped")), name, "wrote elsewhere")
            check(campaign.say("doctor", campaign.file).returncode == 0, name, "left a campaign that is not sound")
        print(len(LIES) + len(NOISE), "lies of far ends are refused")


if len(sys.argv) > 3 and sys.argv[1] in {**LIES, **NOISE}:
    lie_once(sys.argv[1], sys.argv[2], sys.argv[3:])
else:
    main()
