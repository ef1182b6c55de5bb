#!/usr/bin/python3
"""Storage moduli from loss moduli, and prices, compared with formulas."""
import sys
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "results"))
from studies.at_rest import storage_by_loss, viscosity_at_high_frequency
from studies.costs import price, seconds_of_window

import numpy as np


class KramersAndKronig(unittest.TestCase):
    def test_give_the_storage_of_a_maxwell_fluid_beside_a_newtonian_one(self):
        # eta' = 3 + 2 / (1 + w^2), so G'' = w eta' and G' = 2 w^2 / (1 + w^2).
        w = 2.0 ** np.arange(-6, 7)
        storage = storage_by_loss(w, w * (3 + 2 / (1 + w**2)))
        np.testing.assert_allclose(storage, 2 * w**2 / (1 + w**2), rtol=0.02)

    def test_see_a_storage_that_belongs_to_another_fluid(self):
        w = 2.0 ** np.arange(-6, 7)
        storage = storage_by_loss(w, w / (1 + (2 * w) ** 2))
        self.assertGreater(np.max(np.abs(storage / (w**2 / (1 + w**2)) - 1)), 0.5)


class HighFrequency(unittest.TestCase):
    def test_viscosity_begins_as_einstein_says(self):
        # 1 + 5/2 phi + O(phi^2)
        self.assertAlmostEqual((viscosity_at_high_frequency(1e-4) - 1) / 1e-4, 2.5, delta=1e-3)


class Prices(unittest.TestCase):
    def test_are_of_five_percent(self):
        # The standard error sqrt(2 / (2 1)) = 1 of 10 is twice 5 %, so the price is four times 2 seconds.
        needed, error = price([9.0, 11.0], [1.0, 1.0], 10)
        self.assertAlmostEqual(needed, 8)
        self.assertAlmostEqual(error, 8 * 2**0.5)

    def test_are_of_the_window_alone(self):
        self.assertAlmostEqual(seconds_of_window({"cost": {"cpu_seconds": 9.0}}, 100, 200), 6)


unittest.main()
