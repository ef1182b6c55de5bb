#!/usr/bin/python3
"""Tests of the evaluator by gradients of energies, conservation and invariance, without any engine."""
import copy
import json
import unittest
from pathlib import Path

import numpy as np

from evaluator.configurations import MIXTURES, SCENE, random_configuration, with_only
from evaluator.evaluation import evaluate, largest_difference, pairs_of, screening_length
from evaluator.geometry import harmonic_mean, lattice

GENERATOR = np.random.default_rng(7)
QUIET = {**SCENE, "fluid": {"viscosity": 0.1}}  # without noise
MONTI = json.loads((Path(__file__).resolve().parent / "monti.json").read_text())


class Energies(unittest.TestCase):
    """Conservative forces are minus the gradient of their energy, by central differences."""

    @staticmethod
    def contact_energy(pairs):
        return np.sum(0.5 * SCENE["contact"]["normal_stiffness"] * pairs.overlap**2)

    @staticmethod
    def exponential_energy(pairs):
        repulsion = SCENE["repulsion"]
        kappa = screening_length(repulsion, pairs.radius_i + pairs.radius_j)
        h = pairs.surface_distance
        return np.sum(np.where(h < 20 * kappa, repulsion["strength"] * np.exp(-h / kappa), 0))

    @staticmethod
    def screened_energy(pairs):
        repulsion, h = MONTI["repulsion"], pairs.surface_distance
        length = repulsion["debye_length"]
        shape = np.where(h > 0, length * np.exp(-np.maximum(h, 0) / length), length - h)
        return np.sum(repulsion["force"] * harmonic_mean(pairs) * shape * (h < 20 * length))

    @staticmethod
    def attraction_energy(pairs):
        block, h, mean = MONTI["attraction"], pairs.surface_distance, harmonic_mean(pairs)
        width = block["regularisation"] * mean
        shape = np.where(h > 0, np.arctan(np.maximum(h, 0) / width), h / width) - np.pi / 2
        return np.sum(block["hamaker"] * mean / (12 * width) * shape * (h < block["cutoff"]))

    def test_forces_are_their_gradients(self):
        self.compare(QUIET, {"contact_normal": self.contact_energy, "repulsion": self.exponential_energy})
        self.compare(MONTI, {"repulsion": self.screened_energy, "attraction": self.attraction_energy})

    def compare(self, scene, energies):
        configuration = random_configuration("1-1.4", scene, 2)
        force = evaluate(configuration)["force"]
        step = 1e-6
        for term, energy in energies.items():
            expected = np.array(force[term])
            i, k = np.unravel_index(np.argmax(abs(expected)), expected.shape)
            ends = []
            for sign in (1, -1):
                moved = copy.deepcopy(configuration)
                moved["state"]["position"][i][k] += sign * step
                ends.append(energy(pairs_of(moved)))
            self.assertAlmostEqual((ends[1] - ends[0]) / (2 * step) / expected[i, k], 1, delta=1e-4)


class Box(unittest.TestCase):
    def configurations(self):
        """Yields configurations without springs, which are named by their images."""
        for scene in (QUIET, MONTI):
            scene = {**scene, "contact": {**scene["contact"], "friction": 0.0}}
            configuration = random_configuration("1-1.4", scene, 4)
            yield configuration, evaluate(configuration)

    def assert_same(self, expected, configuration):
        self.assertLess(max(largest_difference(expected, evaluate(configuration)).values()), 1e-9)

    def test_basis_of_the_lattice_does_not_matter(self):
        for configuration, expected in self.configurations():
            box = configuration["state"]["box"]
            box["tilt"] -= np.sign(box["tilt"]) * box["lengths"][0]
            self.assert_same(expected, configuration)

    def test_particles_may_be_moved_by_lattice_vectors_with_the_velocity_of_the_image(self):
        for configuration, expected in self.configurations():
            state, rate = configuration["state"], configuration["scene"]["flow"]["shear_rate"]
            vectors = lattice(state["box"])
            for position, velocity in zip(state["position"], state["velocity"]):
                shift = GENERATOR.integers(-1, 2, 3)
                position[:] = np.array(position) + shift @ vectors
                velocity[0] += rate * vectors[1, 1] * shift[1]
            self.assert_same(expected, configuration)

    def test_the_total_force_of_pairs_is_zero(self):
        for _, expected in self.configurations():
            for term, force in expected["force"].items():
                if term != "drag":
                    self.assertLess(abs(np.sum(force, axis=0)).max(), 1e-11 * np.abs(force).max() + 1e-300)

    def test_a_box_in_which_a_particle_meets_itself_is_refused(self):
        configuration, _ = next(self.configurations())
        configuration["scene"]["lubrication"]["outer_gap"] = 20
        with self.assertRaises(ValueError):
            evaluate(configuration)


class Comparisons(unittest.TestCase):
    configuration = random_configuration("1-1.4", SCENE, 1)
    expected = evaluate(configuration)

    def test_every_term_acts(self):
        terms = {t for block in ("force", "torque") for t, v in self.expected[block].items() if np.any(v)}
        self.assertEqual(len(terms), 10)
        self.assertTrue(any(np.any(spring["tangential"]) for spring in self.expected["springs"]))

    def test_one_number_that_is_wrong_is_found(self):
        for block, term in (("force", "friction"), ("torque", "rolling"), ("stress", "lubrication")):
            answer = copy.deepcopy(self.expected)
            rows = np.array(answer[block][term])
            rows[np.unravel_index(np.argmax(abs(rows)), rows.shape)] *= 1 + 1e-9
            answer[block][term] = rows.tolist()
            worst = max(largest_difference(self.expected, answer).values())
            self.assertAlmostEqual(worst / 1e-9, 1, delta=1e-3)

    def test_what_is_missing_is_found(self):
        answer = copy.deepcopy(self.expected)
        del answer["force"]["drag"]
        self.assertEqual(largest_difference(self.expected, answer)["force.drag"], np.inf)
        answer = copy.deepcopy(self.expected)
        answer["springs"].pop()
        self.assertEqual(largest_difference(self.expected, answer)["springs"], np.inf)

    def test_mixtures_and_single_laws_can_be_made(self):
        for mixture in MIXTURES:
            terms = evaluate(random_configuration(mixture, with_only(SCENE, "repulsion"), 1))["force"]
            self.assertEqual(terms.keys(), {"repulsion", "drag", "brownian_drag"})


if __name__ == "__main__":
    unittest.main()
