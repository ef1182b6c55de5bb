"""Answers one document of the program peclet: python3 answer.py jamming_report | laws_report

Reads a JSON document from standard input and writes the answer of the module to standard output.
"""
import importlib
import json
import sys
from pathlib import Path

NEEDS = {"jamming_report": ["numpy"], "laws_report": ["numpy", "scipy.optimize", "scipy.stats"]}

if __name__ == "__main__":
    # Imported before the folder of the package is on the path, which might have others of these names.
    try:
        for name in NEEDS[sys.argv[1]]:
            importlib.import_module(name)
    except ModuleNotFoundError as missing:
        sys.exit(f"{sys.executable} has no module {missing.name}")
    sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
    json.dump(importlib.import_module(f"peclet.{sys.argv[1]}").answer(json.load(sys.stdin)), sys.stdout)
