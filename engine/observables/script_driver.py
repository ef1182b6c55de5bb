"""Runs a script of measurements for the engine, which starts it as `python3 -c` and speaks through a socket.

The engine sends the script, then one frame after the other; each message has an answer. Every frame is measured by a
fresh copy of the script, so that nothing is kept from one frame to the next: a realisation that was resumed gives the
same numbers as one that was not.
"""

import json
import math
import os
import socket
import struct
import sys
import time
import traceback

os.environ.setdefault("OMP_NUM_THREADS", "1")  # a worker counts as one processor; NumPy would take all of them

SOCKET = 3  # descriptor
MAGIC = b"PCF1"  # contract/frames.h
MOST_ELEMENTS = 10000
LONGEST_NAME = 120


class ScriptFault(Exception):
    """What the script did wrong, in words."""


class Rows:
    """Arrays of equal length as attributes; rows[mask] has some of the rows."""

    def __init__(self, arrays):
        self.__dict__.update(arrays)

    def __len__(self):
        return len(next(iter(self.__dict__.values())))

    def __getitem__(self, chosen):
        return Rows({name: array[chosen] for name, array in self.__dict__.items()})


class Frame:
    """One moment of a realisation; docs/measure.md describes the members."""

    def __init__(self, scene, head, arrays):
        self.scene = scene
        self.step, self.time, self.strain = head["step"], head["time"], head["strain"]
        self.pairs = Rows({name[5:]: arrays.pop(name) for name in list(arrays) if name.startswith("pair/")})
        self.pairs.sliding = self.pairs.sliding.astype(bool)
        self.contacts = self.pairs[self.pairs.gap < 0]
        stress = arrays.pop("stress")
        self.stress = stress[:, [[0, 3, 4], [3, 1, 5], [4, 5, 2]]]
        self.__dict__.update(arrays)
        self.count = len(self.radii)

    def nearest(self, vectors):
        """Returns the shortest images of these vectors (..., 3) through the periodic cell."""
        vectors = np.asarray(vectors, float)
        vectors = vectors - np.rint(vectors @ np.linalg.inv(self.box)) @ self.box
        cells = np.array(np.meshgrid(*3 * [[-1, 0, 1]])).reshape(3, -1).T @ self.box
        images = vectors[..., None, :] + cells
        shortest = np.einsum("...i,...i", images, images).argmin(-1)
        return np.take_along_axis(images, shortest[..., None, None], -2)[..., 0, :]


def is_name(text):
    return (
        isinstance(text, str) and 0 < len(text.encode()) <= LONGEST_NAME and all(c >= " " and c != "\x7f" for c in text)
    )


def require_keys(where, given, known):
    if not isinstance(given, dict):
        raise ScriptFault(f"{where} must be a dict, not {type(given).__name__}")
    for key in given:
        if key not in known:
            raise ScriptFault(f"{where} has the unknown key {key!r}; known are {', '.join(known)}")


def described_axis(where, axis):
    require_keys(where, axis, ("name", "unit", "values"))
    values = np.asarray(axis.get("values", [])).tolist()
    numbers = (int, float)
    good = isinstance(values, list) and all(
        is_name(v) or isinstance(v, numbers) and not isinstance(v, bool) and math.isfinite(v) for v in values
    )
    if not good or not values:
        raise ScriptFault(f"{where} must have values, a list of numbers or of words")
    if not is_name(axis.get("name")) or not is_name(axis.get("unit", "1")):
        raise ScriptFault(f"{where} must have a name and, unless it is a pure number, a unit: short texts")
    return {"name": axis["name"], "unit": axis.get("unit", "1"), "values": values}


def described(quantities):
    """Returns the descriptions of all quantities with their defaults. Raises ScriptFault."""
    if not isinstance(quantities, dict) or not quantities:
        raise ScriptFault('must have quantities = {"NAME": {}, ...}: a description of each number that it measures')
    answer, elements = [], 0
    for name, about in quantities.items():
        if not is_name(name) or not (name.isidentifier() and name.isascii()):
            raise ScriptFault(f"quantities has the name {name!r}; must have letters, digits and underscores")
        where = f'quantities["{name}"]'
        require_keys(where, about, ("symbol", "unit", "axes"))
        if (about.get("symbol") and not is_name(about["symbol"])) or not is_name(about.get("unit", "1")):
            raise ScriptFault(f"{where} must have short texts as symbol and unit")
        axes = about.get("axes", [])
        if not isinstance(axes, (list, tuple)):
            raise ScriptFault(f"{where} must have a list of axes")
        axes = [described_axis(f"{where}: axis {k}", axis) for k, axis in enumerate(axes)]
        elements += math.prod(len(axis["values"]) for axis in axes)
        answer.append({"name": name, "symbol": about.get("symbol") or "", "unit": about.get("unit", "1"), "axes": axes})
    if elements > MOST_ELEMENTS:
        raise ScriptFault(f"quantities has {elements} numbers in all; must have at most {MOST_ELEMENTS}")
    return answer


class Script:
    def __init__(self, name, text, scene):
        self.name, self.scene = name, scene
        self.code = compile(text, name, "exec")
        script = self.fresh()
        self.quantities = described(script.get("quantities"))
        if not callable(script.get("measure")):
            raise ScriptFault("must have a function measure(frame)")

    def fresh(self):
        script = {"__name__": "measure", "__file__": self.name}
        exec(self.code, script)
        return script

    def measure(self, head, arrays):
        """Returns the numbers of each quantity in one list; null without a value. Raises ScriptFault."""
        # A scene of its own, too: a script may change what it gets.
        measured = self.fresh()["measure"](Frame(json.loads(self.scene), head, arrays))
        if not isinstance(measured, dict):
            raise ScriptFault(f"measure() must return a dict, not {type(measured).__name__}")
        names = [about["name"] for about in self.quantities]
        if set(measured) != set(names):
            wrong = sorted(map(repr, set(measured).symmetric_difference(names)))
            raise ScriptFault(f"measure() must return all that quantities names and nothing else: see {wrong[0]}")
        return {about["name"]: self.numbers(about, measured[about["name"]]) for about in self.quantities}

    @staticmethod
    def numbers(about, value):
        if value is None:
            return None
        what = f'measure() returned "{about["name"]}"'
        shape = tuple(len(axis["values"]) for axis in about["axes"])
        try:
            array = np.asarray(value, float)
        except (TypeError, ValueError):
            raise ScriptFault(f"{what} as {type(value).__name__}; must be a number or a list of numbers") from None
        if array.shape != shape:
            raise ScriptFault(f"{what} of shape {array.shape}; its axes say {shape}")
        if not np.isfinite(array).all():
            wrong = array[~np.isfinite(array)].flat[0]
            raise ScriptFault(f"{what} with {wrong}; must be finite, or None for a frame without a value")
        return array.ravel().tolist()


def explained(error, name):
    """Returns "mine.py, line 12: ZeroDivisionError: division by zero"."""
    if isinstance(error, ScriptFault):
        return f"{name}: {error}"
    line = error.lineno if isinstance(error, SyntaxError) and error.filename == name else None
    for place in traceback.extract_tb(error.__traceback__):
        if place.filename == name:
            line = place.lineno
    words = error.msg if isinstance(error, SyntaxError) and error.msg else str(error)
    where = name if line is None else f"{name}, line {line}"
    return f"{where}: {type(error).__name__}" + (f": {' '.join(words.split())}" if words else "")


class Engine:
    def __init__(self):
        self.socket = socket.socket(fileno=SOCKET)
        os.set_inheritable(SOCKET, False)

    def take(self, count):
        """Returns the next bytes. Ends the process if the engine is gone."""
        data = bytearray(count)
        view = memoryview(data)
        while view:
            received = self.socket.recv_into(view)
            if received == 0:
                os._exit(0)
            view = view[received:]
        return data

    def hear(self):
        length = struct.unpack("<I", self.take(8)[len(MAGIC) :])[0]
        message = json.loads(self.take(length))
        arrays = {}
        for name, kind, shape in message.get("arrays", []):
            # Arrays of the script's own, which it may change.
            arrays[name] = np.frombuffer(self.take(8 * math.prod(shape)), kind).reshape(shape)
        return message, arrays

    def say(self, message):
        sys.stdout.flush()
        payload = json.dumps({**message, "seconds": time.process_time()}).encode()
        self.socket.sendall(MAGIC + struct.pack("<I", len(payload)) + payload)


def main():
    engine, script = Engine(), None
    name = "python3"
    while True:
        message, arrays = engine.hear()
        try:
            if script is None:
                name = message["name"]
                script = Script(name, message["text"], message["scene"])
                engine.say({"type": "quantities", "quantities": script.quantities})
            else:
                engine.say({"type": "values", "values": script.measure(message, arrays)})
        except BaseException as error:  # SystemExit, too: the script must not end this process
            engine.say({"type": "fault", "message": explained(error, name)})


sys.path = [folder for folder in sys.path if folder]  # the folder of the engine has nothing for the script
try:
    import numpy as np
except ImportError:
    engine = Engine()
    engine.hear()
    engine.say(
        {"type": "fault", "message": f"scripts need NumPy (Debian: python3-numpy), which {sys.executable} lacks"}
    )
else:
    main()
