"""The ways in which an engine lies: what it does, and what is to come of it."""
import collections
import hashlib
import json
import os
import sys
import time

# place: job, after (the honest end of one), hello, validate.
# fate: what becomes of the seed's try, or of the run:
#   again    it is blamed, or at least does not count; the seed is run again, and the campaign ends as the honest one
#   taken    nothing is wrong with it: the campaign ends as the honest one and nobody is blamed
#   either   one of the two
#   ends     the run ends with one of `codes`; nothing is stored that the honest campaign does not have
#   refused  the scenes could not be judged: nothing is written
Way = collections.namedtuple("Way", "name place fate codes lie text slow")
WAYS = {"honest": Way("honest", None, "taken", (), None, None, False)}


def way(name, fate="again", place="job", codes=(), text=None, slow=False):
    def register(lie):
        assert name not in WAYS, name
        WAYS[name] = Way(name, place, fate, codes, lie, text, slow)
        return lie

    return register


def document(name, change, **about):
    """A result whose text is made from the honest document; so the same can be put into the spool."""

    def text(result):
        changed = change(result)
        if changed is None:
            changed = result
        return changed if isinstance(changed, bytes) else json.dumps(changed).encode()

    @way(name, text=text, **about)
    def lie(engine, job):
        engine.deliver(job, text(engine.result(job)))


def setting(*keys):
    """A change that puts a value at a place of the document."""
    *way_there, last, value = keys

    def change(result):
        inner = result
        for key in way_there:
            inner = inner[key]
        inner[last] = value

    return change


def without(*keys):
    *way_there, last = keys

    def change(result):
        inner = result
        for key in way_there:
            inner = inner[key]
        del inner[last]

    return change


def spelt(number):
    """The value in a spelling that json.dumps does not know; what is long is made when it is asked for."""

    def change(result):
        text = json.dumps({**result, "mean": {"relative_viscosity": "HERE"}})
        return text.replace('"HERE"', number() if callable(number) else number).encode()

    return change


ESCAPE = "\x1b[2J\r\n\x07\u202e"
for name, change in {
    "warnings without a code": setting("warnings", [{"message": "x"}]),
    "warnings in words": setting("warnings", "none"),
    "warnings that are numbers": setting("warnings", [1, 2]),
    "warnings with a number as code": setting("warnings", [{"code": 7, "message": "x"}]),
    "warnings with a novel as code": setting("warnings", [{"code": "a" * 100_000, "message": "x"}]),
    "warnings that move the cursor": setting("warnings", [{"code": ESCAPE, "message": ESCAPE}]),
    "warnings with a list as message": setting("warnings", [{"code": "a", "message": []}]),
    "mean in a list": setting("mean", [10]),
    "mean null": setting("mean", None),
    "mean in words": setting("mean", "relative_viscosity", "10"),
    "mean with a truth": setting("mean", "relative_viscosity", True),
    "mean NaN in words": setting("mean", "relative_viscosity", "NaN"),
    "mean with a name that moves the cursor": setting("mean", ESCAPE, 1),
    "mean with a name without end": setting("mean", "a" * 1_000_000, 1),
    "quantities in a list": setting("quantities", [1]),
    "quantities in words": setting("quantities", {"relative_viscosity": "eta_r"}),
    "quantity that is not there": setting(
        "quantities", {"pressure": {"symbol": "P", "unit": "1", "estimator": "mean"}}
    ),
    "quantity whose unit moves the cursor": setting(
        "quantities", {"relative_viscosity": {"symbol": "x", "unit": ESCAPE, "estimator": "mean"}}
    ),
    "quantity with an axis that its value lacks": setting(
        "quantities",
        {
            "relative_viscosity": {
                "symbol": "x",
                "unit": "1",
                "estimator": "mean",
                "axes": [{"name": "r", "unit": "1", "values": [1, 2]}],
            }
        },
    ),
    "control variate in words": setting("mean", "control_variates", "brownian_pairwise", "0"),
    "blocks in a list": setting("blocks", []),
    "blocks null": setting("blocks", None),
    "cost missing": without("cost"),
    "cost negative": setting("cost", "cpu_seconds", -1e9),
    "cost in words": setting("cost", "wall_seconds", "long"),
    "cost beyond all clocks": setting("cost", "cpu_seconds", 1e300),
    "steps negative": setting("steps", "production", -1),
    "steps beyond counting": setting("steps", "production", 1e300),
    "steps in a list": setting("steps", [1]),
    "half a step": setting("ending", "step", 0.5),
    "strain in words": setting("strain", "production", "much"),
    "derived in words": setting("derived", {"stokes": "small"}),
    "time step in words": setting("timestep", "short"),
    "overlap in words": setting("largest_overlap", "none"),
    "engine missing": without("engine"),
    "engine another one": setting("engine", "binary_sha256", "0" * 64),
    "engine that is no hash": setting("engine", "binary_sha256", "hostile"),
    "engine that moves the cursor": setting("engine", "version", ESCAPE),
    "seed another one": setting("seed", 1),
    "seed not asked for yet": setting("seed", 5),
    "seed beyond every campaign": setting("seed", 2147483647),
    "seed beyond an int": setting("seed", 2**40),
    "seed negative": setting("seed", -1),
    "seed in halves": setting("seed", 2.5),
    "point of nobody": setting("point", "f" * 64),
    "point that is no hash": setting("point", ESCAPE * 1000),
    "version of the future": setting("schema_version", 2),
    "cause in capitals": setting("ending", "cause", "Completed"),
    "cause that moves the cursor": setting("ending", "cause", ESCAPE),
    "cause without end": setting("ending", "cause", "a" * 1_000_000),
    "blown up and yet a mean": setting("ending", "cause", "overlap"),
    "ending in words": setting("ending", "completed"),
    "final state missing": setting("final_state_sha256", None),
    "largest number there is": setting("mean", "relative_viscosity", 1.7976931348623157e308),
    "number whose square is none": setting("mean", "relative_viscosity", -1e200),
    "block without bounds": setting("blocks", "relative_viscosity", [1e308] * 32),
    "exponent beyond all": spelt("1e999"),
    "exponent of a thousand digits": spelt("1e" + "9" * 1000),
    "NaN": spelt("NaN"),
    "nan": spelt("nan"),
    "Infinity": spelt("Infinity"),
    "minus infinity": spelt("-inf"),
    "number in hexadecimal": spelt("0x1p3"),
    "nested for ever": spelt("[" * 100_000 + "]" * 100_000),
    "nested and never closed": spelt(lambda: "[" * 5_000_000),
    "keys twice": spelt('1,"relative_viscosity":10'),
    "a million keys": spelt(lambda: "{" + ",".join(f'"{i}":0' for i in range(1_000_000)) + "}"),
    "a million empty objects": spelt(lambda: "[" + ",".join(["{}"] * 1_000_000) + "]"),
    "ten million zeros": spelt(lambda: "[" + "0," * 10_000_000 + "0]"),
    "rubbish behind it": lambda result: json.dumps(result).encode() + b" and more",
    "a list": lambda result: b"[" + json.dumps(result).encode() + b"]",
    "bytes that are no text": lambda result: b"\xff\xfe\x00" + os.urandom(1000),
    "half of it": lambda result: json.dumps(result).encode()[:200],
    "nothing": lambda result: b"",
}.items():
    document(name, change)


# Without the number that the campaign asks for there is nothing to wait for, and no seed to blame.
document("mean without the observable", without("mean", "relative_viscosity"), fate="ends", codes=(2,))


# The file.


@way("file absent")
def file_absent(engine, job):
    engine.announce(job, json.dumps(engine.result(job)).encode())


@way("file a directory")
def file_directory(engine, job):
    os.mkdir(job["spool"])
    engine.announce(job, b"")


@way("file a pipe")
def file_pipe(engine, job):
    os.mkfifo(job["spool"])
    engine.announce(job, b"")


@way("file a link to zeros without end")
def file_endless(engine, job):
    os.symlink("/dev/zero", job["spool"])
    engine.announce(job, b"")


@way("file a link to itself")
def file_loop(engine, job):
    os.symlink(job["spool"], job["spool"])
    engine.announce(job, b"")


@way("file a link to a sound one", fate="either")
def file_link(engine, job):
    text = json.dumps(engine.result(job)).encode()
    with open("elsewhere.json", "wb") as f:
        f.write(text)
    os.symlink(os.path.abspath("elsewhere.json"), job["spool"])
    engine.announce(job, text)


@way("file changed after its hash")
def file_changed(engine, job):
    result = engine.result(job)
    text = json.dumps(result).encode()
    result["mean"]["relative_viscosity"] = 99
    engine.spool(job, json.dumps(result).encode())
    engine.announce(job, text)


@way("file of a gigabyte")
def file_sparse(engine, job):
    with open(job["spool"], "wb") as f:
        f.truncate(1 << 30)
    engine.announce(job, b"")


@way("file somewhere else")
def file_elsewhere(engine, job):
    text = json.dumps(engine.result(job)).encode()
    engine.announce({**job, "spool": job["checkpoint"]}, text)


@way("file's path without end")
def file_path(engine, job):
    engine.announce({**job, "spool": "/" + ESCAPE * 50_000}, b"")


@way("hash without end")
def hash_long(engine, job):
    text = json.dumps(engine.result(job)).encode()
    engine.spool(job, text)
    engine.announce(job, text, sha256=ESCAPE * 10_000)


# What it has left is sound, and is taken from the spool in the end.
@way("hash a number", fate="either")
def hash_number(engine, job):
    text = json.dumps(engine.result(job)).encode()
    engine.spool(job, text)
    engine.announce(job, text, sha256=1)


# Frames.


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


# Who it is; told by workers only, from the second process on.


def hello(name, fate="ends", codes=(1, 6), **changed):
    @way("hello " + name, fate=fate, place="hello", codes=codes)
    def lie(engine, honest):
        engine.send({**honest, **changed})
        engine.wait()


hello("of protocol 2", protocol=2)
hello("of protocol nothing", protocol=None)
hello("of no engine", engine=None)
hello("of a list", engine=[])
hello("without a version", engine={"binary_sha256": "0" * 64, "instruction_set": "none"})
hello("that moves the cursor", engine={"version": ESCAPE, "binary_sha256": "0" * 64, "instruction_set": "none"})
hello("of no hash", engine={"version": "1", "binary_sha256": ESCAPE, "instruction_set": "none"})
hello("with ahead in words", ahead="yes")
hello("of a megabyte", program="x" * (1 << 20))


@way("hello never", fate="ends", place="hello", codes=(1,), slow=True)
def hello_never(engine, honest):
    engine.stand_still()


@way("hello that is no frame", fate="ends", place="hello", codes=(1,))
def hello_garbage(engine, honest):
    engine.send_bytes(os.urandom(100))
    engine.stand_still()


@way("hello of another engine later on", fate="ends", place="hello", codes=(6,))
def hello_changes(engine, honest):
    if engine.starts > 2:
        honest = {**honest, "engine": {**honest["engine"], "binary_sha256": "1" * 64}}
    engine.send(honest)
    if engine.starts == 2:
        job = engine.receive()
        engine.progress(job, 2)
        os.abort()


# What it says about scenes.


def validate(name, codes=(1,), **changed):
    @way("validate " + name, fate="refused", place="validate", codes=codes)
    def lie(engine, honest):
        engine.send({**honest, **changed})


validate("with steps beyond all", steps=1e300)
validate("with steps in words", steps="many")
validate("with half the particles of the universe", particles=5e79)
validate("with a time step below zero", timestep=-1)
validate("with derived words", derived={"stokes": ESCAPE})
validate("with names that move the cursor", derived={ESCAPE: 1})
validate("with warnings in words", warnings="none")
validate("with other observables", codes=(2,), observables=[ESCAPE] * 3000)
validate("with another answer", type="progress")
validate(
    "refused with a novel",
    codes=(2,),
    type="refused",
    pointer=ESCAPE * 1000,
    value=ESCAPE * 1000,
    allowed=ESCAPE * 1000,
)


@way("validate and print without end", fate="refused", place="validate", codes=(1,))
def validate_prints(engine, honest):
    end = time.monotonic() + 2
    while time.monotonic() < end:
        os.write(2, ESCAPE.encode() * 8000)
    os.abort()


@way("validate without an answer", fate="refused", place="validate", codes=(1,), slow=True)
def validate_never(engine, honest):
    engine.stand_still()
