#!/usr/bin/python3
"""page_test.py PECLET [FOLDER]: runs the examples of docs/python.md; FOLDER gets their figures."""
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PICTURES = ("flow.png", "paper.png", "lines.png")  # of each example


def main():
    page = (ROOT / "docs" / "python.md").read_text()
    scene, scripts = (re.findall(rf"```{kind}\n(.*?)```", page, re.DOTALL) for kind in ("json", "python"))
    binaries = os.path.dirname(os.path.abspath(sys.argv[1]))
    path = f"{binaries}:{os.environ['PATH']}"
    with tempfile.TemporaryDirectory() as folder:
        Path(folder, "scene.json").write_text(scene[0])
        environment = {**os.environ, "PATH": path, "PYTHONPATH": str(ROOT / "python"), "MPLBACKEND": "agg"}
        for script, name in zip(scripts, PICTURES, strict=True):
            subprocess.run([sys.executable, "-c", script], cwd=folder, env=environment, check=True)
            picture = Path(folder, name)
            if not picture.read_bytes().startswith(b"\x89PNG"):
                sys.exit(f"{name} is no picture")
            if len(sys.argv) > 2:
                shutil.copy(picture, sys.argv[2])


main()
