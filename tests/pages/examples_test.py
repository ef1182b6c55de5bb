#!/usr/bin/python3
"""examples_test.py BIN [NAME...]

Runs every example of `peclet init` to its end, and the commands in its first lines: takes some ten minutes on two
cores. NAME chooses examples.
"""
import os
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

BIN = os.path.abspath(sys.argv[1])
EXAMPLES = Path(__file__).resolve().parent.parent.parent / "docs/examples"
NAMES = sys.argv[2:] or sorted(path.stem for path in EXAMPLES.glob("*.json"))


def commands_of(text):
    """Returns the commands in the comments at the beginning of an example, without their introduction."""
    lines = re.match(r"(//.*\n)*", text)[0].replace("\\\n//", " ").splitlines()
    return [found[1] for line in lines if (found := re.match(r"//(?: \w+:)? +(peclet.*)", line))]


class Examples(unittest.TestCase):
    def test_run_to_their_end_and_are_drawn(self):
        environment = {**os.environ, "PATH": f"{BIN}:/usr/bin:/bin"}
        for name in NAMES:
            with self.subTest(name), tempfile.TemporaryDirectory(prefix="peclet-example-") as place:

                def said_by(command, *codes):
                    done = subprocess.run(
                        ["bash", "-o", "pipefail", "-c", command],
                        cwd=place,
                        env=environment,
                        stdout=subprocess.PIPE,
                        stderr=subprocess.STDOUT,
                        text=True,
                    )
                    self.assertIn(done.returncode, codes or (0,), f"{command}\n{done.stdout}")
                    return done.stdout

                said_by(f"peclet init mine.json --example {name}")
                self.assertNotIn("warning", said_by("peclet validate mine.json"))
                said_by("peclet run mine.json --quiet")
                for command in commands_of((EXAMPLES / f"{name}.json").read_text("utf-8")):
                    said_by(command.replace("FILE", "mine.json"))
                pictures = [path for path in os.listdir(place) if path.endswith(".png")]
                self.assertTrue(pictures, "no command draws a picture")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
