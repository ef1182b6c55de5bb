"""Faults of the value of one key, or of a key itself, by the schema: one Case each."""
import copy
import json

ESCAPES = "a\x1b[31m\x07\r\nb\u202e"
NESTED = [[[[[[[[{"a": [{}]}]]]]]]]]
LONG = "x" * 300_000
SPELLINGS = ("NaN", "1e999", "-Infinity", "01", "0x10", "1.", ".5", "+1", "1e", "1,5", "--1", "1_000")


class Case:
    """One faulty input. `codes`: allowed exit codes; `words`: arguments of the program."""

    def __init__(self, name, words, text=None, codes=(2,), prepare=None, program="peclet", sent=b""):
        self.name, self.words, self.text, self.codes = name, words, text, codes
        self.prepare, self.program, self.sent = prepare, program, sent


def places(schema, pointer=""):
    """Yields pointer and schema of every place in a schema, with 0 for elements of arrays."""
    for name, below in schema.get("properties", {}).items():
        yield f"{pointer}/{name}", below
        yield from places(below, f"{pointer}/{name}")
    if isinstance(schema.get("items"), dict):
        yield f"{pointer}/0", schema["items"]
        yield from places(schema["items"], f"{pointer}/0")


def altered(document, pointer, value):
    """Returns the document with that value there; absent parents are created."""
    document = copy.deepcopy(document)
    *path, last = pointer.split("/")[1:]
    node = document
    for key, after in zip(path, [*path[1:], last]):
        fresh = [] if after == "0" else {}
        if isinstance(node, list):
            if not node:
                node.append(fresh)
            node = node[0]
        else:
            node = node.setdefault(key, fresh)
        if not isinstance(node, (list, dict)):
            return None  # the scene has a number where an object is needed
    if isinstance(node, list):
        node[:1] = [value]
    else:
        node[last] = value
    return document


def types_of(schema):
    if "enum" in schema:
        return {"choice"}
    if "oneOf" in schema or "anyOf" in schema:
        return set().union(*(types_of(each) for each in schema.get("oneOf", schema.get("anyOf"))))
    kind = schema.get("type")
    return set(kind) if isinstance(kind, list) else {kind} if kind else set()


def bound(schema, names):
    for part in (schema, *schema.get("oneOf", ()), *schema.get("anyOf", ())):
        for name in names:
            if name in part:
                return part[name], name.startswith("exclusive")
    return None, False


def wrong_values(schema):
    """Yields values that the schema does not allow, by name."""
    types = types_of(schema)
    if not types:
        return
    numeric = bool(types & {"number", "integer"})
    yield "null", None
    if "boolean" not in types:
        yield "true", True
    yield "nested", NESTED
    if "object" not in types:
        yield "an object", {}
    if "array" not in types:
        yield "an array", []
    if "string" not in types:
        yield "a text", "x"
        yield "an empty text", ""
        yield "control characters", ESCAPES
        yield "a long text", LONG
    if not numeric:
        yield "a number", 7
        return
    low, is_open = bound(schema, ("minimum", "exclusiveMinimum"))
    if low is not None:
        yield "too small", low - 1
        yield "far too small", -1e300
        if is_open:
            yield "the open bound", low
    high, is_open = bound(schema, ("maximum", "exclusiveMaximum"))
    if high is not None:
        yield "too large", high + max(1, abs(high))
        yield "far too large", 1e300
        if is_open:
            yield "the open upper bound", high
    if "integer" in types:
        yield "a part", 1.5
        yield "beyond all integers", 1e18


def extreme_values(schema):
    if types_of(schema) & {"number", "integer"}:
        yield from (("huge", 1e300), ("tiny", 1e-300), ("large", 1e15), ("small", 1e-15), ("zero", 0))


def spoilt_keys(document, schema, prefix, program, words):
    for pointer, about in places(schema):
        for name, value in wrong_values(about):
            text = altered(document, prefix + pointer, value)
            if text is not None:
                yield Case(f"{prefix}{pointer}, {name}", words, json.dumps(text), program=program)
        for name, value in extreme_values(about):
            text = altered(document, prefix + pointer, value)
            if text is not None:
                yield Case(f"{prefix}{pointer}, {name}", words, json.dumps(text), codes=(0, 2), program=program)
        spoilt = altered(document, prefix + pointer, "HERE")
        if spoilt is not None and types_of(about) & {"number", "integer"}:
            # All keys share one reader of numbers, so one key gets every spelling.
            for word in SPELLINGS if pointer == "/volume_fraction" else SPELLINGS[:2]:
                yield Case(
                    f"{prefix}{pointer}, {word}", words, json.dumps(spoilt).replace('"HERE"', word), program=program
                )
    for pointer in ("", *(p for p, about in places(schema) if types_of(about) == {"object"})):
        for name, key in (
            ("unknown key", "zzz"),
            ("key of control characters", ESCAPES),
            ("long key", LONG),
            ("empty key", ""),
        ):
            text = altered(document, f"{prefix}{pointer}/{key}", 1)
            if text is not None:
                yield Case(f"{prefix}{pointer}, {name}", words, json.dumps(text), program=program)
