"""Becomes the program peclet: `python -m peclet run flow-curve.json`."""
import os
import sys

from peclet.program import PecletError, find_program

try:
    os.execv(find_program(), ["peclet", *sys.argv[1:]])
except PecletError as error:
    sys.exit(f"peclet: {error}")
