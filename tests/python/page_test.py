#!/usr/bin/python3
"""page_test.py PECLET [PICTURE]: runs the example of docs/python.md in an empty folder; PICTURE gets its figure."""
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


def main():
    page = (ROOT / "docs" / "python.md").read_text()
    scene, script = (re.search(rf"```{kind}\n(.*?)```", page, re.DOTALL)[1] for kind in ("json", "python"))
    binaries = os.path.dirname(os.path.abspath(sys.argv[1]))
    path = f"{binaries}:{os.environ['PATH']}"
    with tempfile.TemporaryDirectory() as folder:
        Path(folder, "scene.json").write_text(scene)
        environment = {**os.environ, "PATH": path, "PYTHONPATH": str(ROOT / "python"), "MPLBACKEND": "agg"}
        subprocess.run([sys.executable, "-c", script], cwd=folder, env=environment, check=True)
        picture = Path(folder, "flow.png")
        if not picture.read_bytes().startswith(b"\x89PNG"):
            sys.exit("flow.png is no picture")
        if len(sys.argv) > 2:
            shutil.copyfile(picture, sys.argv[2])


main()
