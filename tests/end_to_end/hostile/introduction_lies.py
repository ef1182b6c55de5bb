"""Lies about the engine and about scenes, before it has a job."""
import os
import time

from hostile.catalogue import ESCAPE, way


# Lies about the engine, sent by workers only, from the second process on.


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


# Lies about scenes.


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
