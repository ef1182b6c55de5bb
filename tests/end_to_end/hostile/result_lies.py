"""Invalid results, and faults of the file of a result."""
import json
import os

from hostile.catalogue import ESCAPE, way


def document(name, change, **about):
    """Adds a result changed from the honest document, which can also be put into the spool."""

    def text(result):
        changed = change(result)
        if changed is None:
            changed = result
        return changed if isinstance(changed, bytes) else json.dumps(changed).encode()

    @way(name, text=text, **about)
    def lie(engine, job):
        engine.deliver(job, text(engine.result(job)))


def setting(*keys):
    """Returns a change that sets a value of the document."""
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
    """Returns a change to a spelling unknown to json.dumps; a callable makes long spellings on demand."""

    def change(result):
        text = json.dumps({**result, "mean": {"relative_viscosity": "HERE"}})
        return text.replace('"HERE"', number() if callable(number) else number).encode()

    return change


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


# Without the campaign's observable no seed can be accepted or blamed, so the run ends.
document("mean without the observable", without("mean", "relative_viscosity"), fate="ends", codes=(2,))


# Lies about the file.


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


# The file is sound, and is taken from the spool in the end.
@way("hash a number", fate="either")
def hash_number(engine, job):
    text = json.dumps(engine.result(job)).encode()
    engine.spool(job, text)
    engine.announce(job, text, sha256=1)
