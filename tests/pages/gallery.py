#!/usr/bin/python3
"""gallery.py BIN FOLDER [NAME...]

Runs the campaigns of docs/examples that docs/gallery.md draws, then its commands, and moves the pictures into FOLDER.
NAME chooses pictures by the end of their command: flow.png. All take six minutes on two cores.
"""

import os
import re
import shlex
import shutil
import subprocess
import sys
import tempfile

DOCS = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "docs")


def commands():
    """Returns the commands of the page as lists of words; each ends in the name of its picture."""
    with open(os.path.join(DOCS, "gallery.md"), encoding="utf-8") as file:
        blocks = re.findall(r"```\n(peclet plot .*?)```", file.read(), re.DOTALL)
    lines = "".join(blocks).replace("\\\n", " ").splitlines()
    return [shlex.split(line) for line in lines]


def main(binaries, target, names):
    chosen = [words for words in commands() if not names or words[-1] in names]
    if not chosen:
        raise SystemExit(f"{', '.join(names)}: no such picture; there are {', '.join(one[-1] for one in commands())}")
    environment = dict(os.environ, PATH=f"{os.path.abspath(binaries)}:/usr/bin:/bin")
    os.makedirs(target, exist_ok=True)
    with tempfile.TemporaryDirectory(prefix="peclet-gallery-") as place:
        for campaign in sorted({word for words in chosen for word in words if word.endswith(".json")}):
            shutil.copy(os.path.join(DOCS, "examples", campaign), place)
            run = ["peclet", "run", campaign, "--quiet"]
            done = subprocess.run(run, cwd=place, env=environment, stdout=subprocess.DEVNULL)
            if done.returncode not in (0, 3):  # 3: seeds that jam are lost
                raise SystemExit(f"{' '.join(run)}: exit code {done.returncode}")
        for words in chosen:
            subprocess.run(words, cwd=place, env=environment, check=True)
            shutil.move(os.path.join(place, words[-1]), os.path.join(target, words[-1]))


if __name__ == "__main__":
    if len(sys.argv) < 3:
        raise SystemExit(__doc__)
    main(sys.argv[1], sys.argv[2], sys.argv[3:])
