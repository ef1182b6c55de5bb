"""Faults of a campaign, its scene, the text, the file and options, one Case each."""
import json
import os
import re
import subprocess
import sys

from malformed_inputs import CAMPAIGN
from malformed_keys import ESCAPES, LONG, Case, spoilt_keys

VERBS = (
    "init",
    "validate",
    "plan",
    "run",
    "status",
    "watch",
    "explain",
    "export",
    "report",
    "hand-over",
    "ingest",
    "task",
    "set",
    "cancel",
    "retry",
    "backup",
    "restore",
    "doctor",
    "completion",
)


def campaign_faults():
    def sweep(*entries):
        return json.dumps({**CAMPAIGN, "sweep": [{"set": s, "values": v} for s, v in entries]})

    many = list(range(1, 1001))
    for name, text in (
        ("a million points", sweep(("/flow/shear_rate", many), ("/volume_fraction", many))),
        ("a product beyond 64 bits", sweep(*((f"/a/k{i}", many) for i in range(8)))),
        ("a million values", sweep(("/flow/shear_rate", list(range(1_000_001))))),
        ("two equal points", sweep(("/flow/shear_rate", [1, 1.0]))),
        ("overlapping pointers", sweep(("/flow", [{}]), ("/flow/shear_rate", [1]))),
        ("a pointer set twice", sweep(("/flow/shear_rate", [1]), ("/flow/shear_rate", [2]))),
        ("a pointer into a number", sweep(("/flow/shear_rate/deep", [1]))),
        ("a pointer past an array", sweep(("/particles/species/7/radius", [1]))),
        ("a pointer with a lone ~", sweep(("/flow/~", [1]))),
        ("a pointer without a slash", sweep(("flow", [1]))),
        ("an empty pointer", sweep(("", [1]))),
        ("a pointer of control characters", sweep(("/" + ESCAPES, [1]))),
        ("a long pointer", sweep(("/" + LONG, [1]))),
        ("no pointers", sweep(([], [[]]))),
        ("rows of another length", sweep((["/flow/shear_rate", "/volume_fraction"], [[1]]))),
        ("values with control characters", sweep(("/flow/shear_rate", [ESCAPES]))),
        ("long values", sweep(("/flow/shear_rate", [LONG]))),
        (
            "heavy scenes",
            json.dumps(
                {**CAMPAIGN, "scene": {"a": "x" * 1_000_000}, "sweep": [{"set": "/b", "values": list(range(50_000))}]}
            ),
        ),
        ("a name of 10 MB", json.dumps({**CAMPAIGN, "name": "n" * 10_000_000})),
        ("a name of control characters", json.dumps({**CAMPAIGN, "name": ESCAPES})),
        ("a name with a slash", json.dumps({**CAMPAIGN, "name": "../x"})),
        ("fewer seeds than the minimum", json.dumps({**CAMPAIGN, "realisations": {"minimum": 10, "maximum": 9}})),
        ("too few seeds for a stop test", json.dumps({**CAMPAIGN, "realisations": {"minimum": 3, "maximum": 9}})),
        ("an engine that is absent", json.dumps({**CAMPAIGN, "engine": ["./absent"]})),
        ("an engine that is a folder", json.dumps({**CAMPAIGN, "engine": ["/tmp"]})),
        ("an engine of a long name", json.dumps({**CAMPAIGN, "engine": [LONG]})),
        ("an engine of control characters", json.dumps({**CAMPAIGN, "engine": [ESCAPES]})),
        (
            "a misspelt target",
            json.dumps({**CAMPAIGN, "target": {**CAMPAIGN["target"], "observable": "relative_vicosity"}}),
        ),
        (
            "a target of control characters",
            json.dumps({**CAMPAIGN, "target": {**CAMPAIGN["target"], "observable": ESCAPES}}),
        ),
        ("a long target", json.dumps({**CAMPAIGN, "target": {**CAMPAIGN["target"], "observable": LONG}})),
        ("no target", json.dumps({**CAMPAIGN, "target": {**CAMPAIGN["target"], "observable": ""}})),
    ):
        yield Case(f"campaign, {name}", ["validate", "input.json"], text)


def text_faults():
    sound = json.dumps(CAMPAIGN)
    raw = {
        "empty": b"",
        "blank": b" \n\t\n",
        "cut in the middle": sound[:200].encode(),
        "cut before the end": sound[:-1].encode(),
        "followed by rubbish": sound.encode() + b"x",
        "followed by a second one": sound.encode() * 2,
        "followed by NUL and rubbish": sound.encode() + b"\0rubbish",
        "of NULs": b"\0" * 1000,
        "in UTF-16": sound.encode("utf-16"),
        "in UTF-32": sound.encode("utf-32"),
        "that is no UTF-8": b'{"name": "\xff\xfe"}',
        "with a half of a surrogate": b'{"name": "\\ud800"}',
        "with a raw control character": b'{"name": "a\x1bb"}',
        "with a comment without end": sound.encode() + b"/*" + b" one" * 1_000_000,
        "with half a comment": b"/ one\n" + sound.encode(),
        "with a comma too many": sound[:-1].encode() + b",}",
        "with single quotes": sound.replace('"', "'").encode(),
        "with typographic quotes": "{\u201cname\u201d: 1}".encode(),
        "of random bytes": bytes((i * 7919 + 13) % 256 for i in range(5000)),
        "a duplicate key": b'{"name": "a", "name": "b"}',
        "a long duplicate key": ('{"%s": 1, "%s": 2}' % (LONG, LONG)).encode(),
        "a number": b"7",
        "a text": b'"campaign"',
        "null": b"null",
        "an array": b"[]",
        "nested without end": b"[" * 1_000_000,
        "nested in objects": b'{"a":' * 500_000,
        "nested and closed": b"[" * 100_000 + b"]" * 100_000,
        "a text without end": b'{"name": "' + b"x" * 5_000_000,
        "a number without end": b'{"name": ' + b"1" * 1_000_000,
        "too many values": b"[" + b"0," * 8_000_000 + b"0]",
        "too many objects": b"// many\n[" + b'{"a":{}},' * 1_500_000 + b"{}]",
        "17 MB": b"[" + b" " * 17_000_000 + b"]",
        "a program": open(sys.executable, "rb").read(1_000_000),
    }
    for name, text in raw.items():
        for program, verb in (("peclet", "validate"), ("peclet-engine", "run"), ("peclet-engine", "forces")):
            yield Case(f"{program} {verb}, a file {name}", [verb, "input.json"], text, program=program)
        yield Case(f"peclet validate, a pipe {name}", ["validate", "/dev/stdin"], sent=text)


def file_faults():
    def loop(folder):
        os.symlink("loop.json", os.path.join(folder, "loop.json"))

    def holes(folder):
        with open(os.path.join(folder, "holes.json"), "wb") as file:
            file.truncate(1 << 40)

    for verb, more in (
        ("validate", ()),
        ("plan", ()),
        ("run", ()),
        ("status", ()),
        ("explain", ()),
        ("export", ()),
        ("report", ()),
        ("set", ("--tolerance", "0.1")),
        ("cancel", ("peclet=1",)),
        ("retry", ()),
        ("doctor", ()),
        ("backup", ()),
        ("ingest", ()),
    ):
        for name, word, prepare in (
            ("absent", "absent.json", None),
            ("a loop", "loop.json", loop),
            ("a long name", "n" * 5000, None),
            ("a long path", "n/" * 2500 + "x", None),
            ("control characters", ESCAPES, None),
            ("nothing", "", None),
        ):
            yield Case(f"peclet {verb}, {name}", [verb, word, *more], prepare=prepare)
    for verb in ("validate", "plan", "run"):
        for word, prepare in (("/dev/zero", None), ("/dev/null", None), (".", None), ("holes.json", holes)):
            yield Case(f"peclet {verb} {word}", [verb, word], prepare=prepare)
    for word in ("/dev/zero", "/dev/null", ".", "absent.json", "n" * 5000):
        yield Case(f"peclet-engine run {word[:20]}", ["run", word], program="peclet-engine")


def option_faults(peclet):
    positional = {"task": ["manifest.json"], "hand-over": ["slurm", "input.json"], "cancel": ["input.json", "p"]}
    for verb in VERBS:
        start = [verb, *positional.get(verb, ["input.json"])]
        if verb == "completion":
            start = [verb]
        page = subprocess.run([peclet, verb, "--help"], capture_output=True, text=True, check=True).stdout
        names = re.findall(r"^ +(--[a-z-]+)(?: (NUMBER|SECONDS))?", page, re.MULTILINE)
        for option, kind in names:
            if not kind:
                continue
            for value in (
                "nan",
                "inf",
                "-inf",
                "-1e300",
                "1e300",
                "1e999",
                "x",
                "1x",
                "0x10",
                "1,5",
                "1e-999",
                "1" * 100_000,
                ESCAPES,
                "--",
            ):
                yield Case(
                    f"peclet {verb} {option} {value[:10]!r}", [*start, f"{option}={value}"], json.dumps(CAMPAIGN)
                )
        for words in (
            ["--zzz"],
            ["--zzz=1"],
            ["-z"],
            ["--" + LONG[:100_000]],
            ["--" + ESCAPES],
            ["--json=x"],
            ["--directory"],
        ):
            if words != ["--directory"] or ("--directory", "") in names:
                yield Case(f"peclet {verb} {words[0][:12]!r}", [*start, *words], json.dumps(CAMPAIGN))
    for words in (
        [],
        ["zzz"],
        [LONG[:100_000]],
        [ESCAPES],
        ["-z"],
        ["--zzz"],
        ["help", "zzz"],
        ["status"],
        ["run"],
        ["cancel", "input.json"],
        ["validate", "input.json", "more.json"],
        ["completion", "tcsh"],
        ["export", "input.json", "--csv", "--json"],
        ["run", "input.json", "--workers", "1", "--workers", "2"],
        ["run", "input.json", "--workers"],
        ["set", "input.json", "--tolerance", "5"],
        ["set", "input.json", "--confidence", "1"],
        ["set", "input.json", "--minimum", "1e18"],
        ["set", "input.json", "--maximum", "1e300"],
        ["task", "manifest.json", "99999999999999999999"],
        ["retry", "input.json", "--seed", "2147483648"],
        ["run", "input.json", "--time-limit", "0"],
        ["run", "input.json", "--accept-engine", "no-such-engine"],
    ):
        yield Case(f"peclet {' '.join(words)[:60]!r}", words, json.dumps(CAMPAIGN))


def every_case(schemas, peclet):
    validate = ["validate", "input.json"]
    yield from spoilt_keys({**CAMPAIGN, "sweep": []}, schemas["scene"], "/scene", "peclet", validate)
    yield from spoilt_keys(CAMPAIGN, schemas["campaign"], "", "peclet", validate)
    yield from campaign_faults()
    yield from text_faults()
    yield from file_faults()
    yield from option_faults(peclet)
