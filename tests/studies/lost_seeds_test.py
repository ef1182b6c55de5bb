#!/usr/bin/python3
"""lost_seeds_test.py BIN: studies accept seeds that the engine ended, and no seed that was given up."""
import os
import sys
import tempfile
import unittest
from pathlib import Path
from unittest import mock

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "results"))
from studies.campaigns import Program
from studies.scenes import REFERENCE_SCENE

BINARIES = os.path.abspath(sys.argv.pop(1))


def seeds_with(fault):
    """Runs three seeds, of which seed 1 has a fault; returns how many have means."""
    with tempfile.TemporaryDirectory() as folder, mock.patch.dict(os.environ, PECLET_FAKE_FAULTS=f"{fault}:1"):
        program = Program(BINARIES, folder)
        program.engine = os.path.join(BINARIES, "fake_engine")
        [point] = program.run("three", REFERENCE_SCENE, [{"/volume_fraction": 0.3}], 3)
        return len(point.results)


class LostSeeds(unittest.TestCase):
    def test_are_accepted_if_spheres_overlap(self):
        self.assertEqual(seeds_with("overlap"), 2)

    def test_end_the_study_if_an_answer_is_none(self):
        with self.assertRaisesRegex(SystemExit, "seeds were given up.*garbled"):
            seeds_with("nan")


if __name__ == "__main__":
    unittest.main()
