#!/usr/bin/python3
"""Control variates compared with their formulas, and contacts of constructed frames."""
import sys
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "results"))
from studies.configurations import contacts_per_sphere, largest_cluster, lifetime
from studies.estimates import cross_fitted, variance_ratio

import numpy as np


class CrossFitting(unittest.TestCase):
    def test_takes_a_linear_part_away_exactly(self):
        generator = np.random.default_rng(1)
        controls = generator.normal(size=(100, 2))
        found = cross_fitted(7 + controls @ (3, -2), controls)
        np.testing.assert_allclose(found, 7)

    def test_leaves_the_mean_where_controls_are_odd_in_what_the_values_are_even_in(self):
        # Values z^2 - 1, control z: a fit of all 40 of a set has the bias -E[(z^2 - 1) z^2] / 40 = -0.05. The
        # mean of 400 sets has a standard error of sqrt(2 / 16000) = 0.011. The seed is fixed.
        z = np.random.default_rng(2).normal(size=(400, 40))
        means = [cross_fitted(row**2 - 1, row[:, None]).mean() for row in z]
        self.assertAlmostEqual(np.mean(means), 0, delta=0.03)

    def test_never_uses_a_realisation_for_its_own_coefficients(self):
        # A common fit with 30 controls would leave little; each value is fitted by 30 others.
        generator = np.random.default_rng(3)
        values, controls = generator.normal(size=40), generator.normal(size=(40, 30))
        self.assertGreater(cross_fitted(values, controls).var(), values.var())


class Ratios(unittest.TestCase):
    def test_of_independent_halves_are_a_half(self):
        # Var(a) / Var(a + b) of normal a, b with squared correlation 1/2: its relative error is
        # sqrt(4 (1 - 1/2) / n), 0.0316 at n = 2000.
        a, b = np.random.default_rng(4).normal(size=(2, 2000))
        value, error = variance_ratio(a + b, a)
        self.assertAlmostEqual(value, 0.5, delta=0.08)
        self.assertAlmostEqual(error, 0.5 * 0.0316, delta=0.003)

    def test_of_rows_are_of_all_their_averages(self):
        rows = np.array([[1.0, 3.0], [5.0, 7.0]])
        self.assertAlmostEqual(variance_ratio(rows, 2 * rows)[0], 4)


class Contacts(unittest.TestCase):
    def pairs(self, *rows):
        return np.array(rows, dtype=int).reshape(-1, 2)

    def test_last_as_many_frames_as_they_are_there(self):
        # A contact in frames 1 and 2, another in 3 ... 6: three frames on average.
        one, other = self.pairs((0, 1)), self.pairs((1, 2))
        frames = [self.pairs(), one, one, other, other, other, other, self.pairs()]
        self.assertEqual(lifetime(frames), 3)

    def test_that_never_begin_last_for_ever(self):
        self.assertEqual(lifetime([self.pairs((0, 1))] * 4), float("inf"))

    def test_connect_spheres_that_do_not_touch_themselves(self):
        chain = self.pairs((0, 1), (1, 2), (4, 5))
        self.assertEqual(largest_cluster(chain, 10), 0.3)
        self.assertEqual(largest_cluster(self.pairs(), 10), 0.1)
        self.assertEqual(contacts_per_sphere(chain, 10), 0.6)


if __name__ == "__main__":
    unittest.main()
