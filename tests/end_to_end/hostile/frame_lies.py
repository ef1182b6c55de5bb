"""Lies sent or printed while a job runs."""
import hashlib
import json
import os
import sys
import time

from hostile.catalogue import ESCAPE, way


def raw(name, data, **about):
    @way(name, **about)
    def lie(engine, job):
        engine.send_bytes(data() if callable(data) else data)
        engine.stand_still()


def framed(payload):
    return b"PCF1" + len(payload).to_bytes(4, "little") + payload


raw("no frame", b"this is no frame at all")
raw("frame of another protocol", b"PCF2" + bytes(4))
raw("frame of four gigabytes", b"PCF1\xff\xff\xff\xff")
raw("frame of a hundred megabytes", b"PCF1\x00\x00\x40\x06")
raw("frame of sixty megabytes", lambda: b"PCF1" + (60 << 20).to_bytes(4, "little") + b"[" * (8 << 20))
raw("frame of nothing", framed(b""))
raw("frame that is no JSON", framed(b"{"))
raw("frame that is a list", framed(b"[]"))
raw("frame without a type", framed(b"{}"))
raw("frame whose type is a number", framed(b'{"type":1}'))
raw("frame of an unknown type", framed(json.dumps({"type": ESCAPE * 5000}).encode()))
raw("frame nested for ever", framed(b'{"type":' + b"[" * 900_000))
raw("frame with NaN", framed(b'{"type":"progress","job":1,"phase":"production","step":NaN,"steps":1,"strain":0}'))
raw("frame that is no text", framed(b'{"type":"\xff\xfe"}'))
raw("frame with a hundred thousand keys", lambda: framed(b"{" + b",".join(b'"%d":0' % i for i in range(90_000)) + b"}"))
raw("frame with keys twice", framed(b'{"type":"progress","type":"result"}'))
raw("half a frame", b"PCF1\x40\x00\x00\x00{")
raw("job that it does not have", framed(b'{"type":"drained","job":987654321,"step":1}'))


@way("frame in single bytes", fate="taken")
def torn(engine, job):
    text = json.dumps(engine.result(job)).encode()
    engine.spool(job, text)
    message = {"type": "result", "job": job["job"], "spool": job["spool"], "sha256": hashlib.sha256(text).hexdigest()}
    for byte in framed(json.dumps(message).encode()):
        engine.send_bytes(bytes([byte]))


def progress(name, **changed):
    @way(name)
    def lie(engine, job):
        engine.progress(job, 2, **changed)
        engine.stand_still()


progress("progress of another job", job=123456)
progress("progress of half a job", job=0.5)
progress("progress backwards below zero", step=-1)
progress("progress beyond counting", step=1e300)
progress("progress of total beyond counting", steps=2**63)
progress("progress in words", step="far")
progress("progress in an unknown phase", phase=ESCAPE)
progress("progress in a list", phase=[])
progress("progress with strain in words", strain="much")
progress("progress with strain beyond all", strain=1e300)


@way("progress without end")
def progress_flood(engine, job):
    while True:
        engine.progress(job, 2)


@way("hello without end")
def hello_flood(engine, job):
    while True:
        engine.send(engine.hello())


@way("hello a second time")
def hello_again(engine, job):
    engine.send(engine.hello())
    engine.stand_still()


@way("result twice", fate="taken")
def result_twice(engine, job):
    text = json.dumps(engine.result(job)).encode()
    engine.deliver(job, text)
    engine.announce(job, text)


@way("result two thousand times", fate="taken")
def result_flood(engine, job):
    text = json.dumps(engine.result(job)).encode()
    engine.deliver(job, text)
    for _ in range(2000):
        engine.announce(job, text)


@way("progress after the result", fate="taken")
def progress_late(engine, job):
    engine.finish(job)
    engine.progress(job, 4)


@way("result of no job", place="after", fate="either")
def result_of_none(engine, job):
    engine.announce({**job, "job": job["job"] + 1}, b"")


@way("silence")
def silence(engine, job):
    engine.stand_still()


@way("given back unasked")
def drained(engine, job):
    engine.send({"type": "drained", "job": job["job"], "step": 1})
    engine.wait()


@way("failed with a novel")
def failed(engine, job):
    engine.send({"type": "failed", "job": job["job"], "message": ESCAPE * 20_000})


@way("failed with a number")
def failed_number(engine, job):
    engine.send({"type": "failed", "job": job["job"], "message": 1})
    engine.stand_still()


@way("no room though there is")
def no_room(engine, job):
    while True:
        engine.send({"type": "no-room", "job": job["job"], "path": job["spool"], "bytes": 10})
        time.sleep(0.05)


@way("no room for everything")
def no_room_at_all(engine, job):
    engine.send({"type": "no-room", "job": job["job"], "path": job["spool"], "bytes": 2**62})
    engine.stand_still()


@way("no room elsewhere")
def no_room_elsewhere(engine, job):
    engine.send({"type": "no-room", "job": job["job"], "path": "/proc/" + ESCAPE, "bytes": 10})
    engine.stand_still()


@way("leaves without a word")
def leaves(engine, job):
    sys.exit(0)


@way("leaves and has left its result", fate="taken")
def leaves_result(engine, job):
    engine.spool(job, json.dumps(engine.result(job)).encode())
    sys.exit(0)


@way("hangs up and lives on")
def hangs_up(engine, job):
    engine.socket.shutdown(2)
    engine.socket.close()
    os.close(0)
    engine.stand_still()


@way("prints twenty megabytes", fate="taken", slow=True)
def prints(engine, job):
    for number in range(340):
        os.write(2, ESCAPE.encode() * 6000 + b"\n")
        if number % 10 == 0:
            engine.progress(job, 2 + number)
    engine.finish(job)


@way("prints without end")
def prints_for_ever(engine, job):
    while True:
        os.write(1, b"x" * 65536)
