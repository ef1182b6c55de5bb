#!/usr/bin/python3
"""Scenes of Monti et al. compared with their published groups."""
import math
import os
import sys
import unittest

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.path.insert(0, os.path.join(ROOT, "results"))
from studies.monti import PAIRS, electrochemistry, in_units
from studies.scenes import merged


def groups(scene):
    """Returns St, k_n / (eta a rate), gamma_n rate / k_n and the size ratio."""
    viscosity, rate = scene["fluid"]["viscosity"], scene["flow"]["shear_rate"]
    first, second = (s["radius"] for s in scene["particles"]["species"])
    stiffness = scene["contact"]["normal_stiffness"]
    stokes = scene["particles"]["density"] * first**2 * rate / viscosity
    damping = scene["contact"]["normal_damping"] * rate / stiffness
    return stokes, stiffness / (viscosity * first * rate), damping, second / first


class Groups(unittest.TestCase):
    def test_are_those_of_the_tables(self):
        for found, printed in zip(groups(PAIRS), (1e-3, 4e5, 1e-7, 1.4)):
            self.assertTrue(math.isclose(found, printed))

    def test_are_the_same_in_other_units(self):
        for found, printed in zip(groups(in_units(PAIRS, 0.1, 0.03, 1.7)), groups(PAIRS)):
            self.assertTrue(math.isclose(found, printed))

    def test_forces_of_touching_spheres_have_the_given_sum_and_ratio(self):
        scene = merged(PAIRS, electrochemistry(40, 19, 0.02))
        attraction = scene["attraction"]
        # A_H a / (12 eps^2) with a = 1.
        pull = attraction["hamaker"] / (12 * attraction["regularisation"] ** 2)
        self.assertAlmostEqual(pull, 2)
        self.assertAlmostEqual(scene["repulsion"]["force"], 38)


if __name__ == "__main__":
    unittest.main()
