#!/usr/bin/python3
"""Tests of the evaluator's laws, without any engine: conservation, invariance, dissipation,
fluctuation-dissipation, and numbers calculated by hand.
"""
import copy
import json
import unittest
from pathlib import Path

import numpy as np

from evaluator.geometry import Pairs, across, along
from evaluator.laws import contact, flow, lubrication, strained_lubrication, stress, surface_forces

GENERATOR = np.random.default_rng(7)
VISCOSITY, INNER = 0.1, 1e-3
MONTI = json.loads((Path(__file__).resolve().parent / "monti.json").read_text())


def some_pairs(count, radius_i=None, radius_j=None, gap=None):
    """Returns pairs of any sizes, directions and velocities; xi from overlap to half of the mean radius."""
    a_i = GENERATOR.uniform(0.3, 7, count) if radius_i is None else np.full(count, float(radius_i))
    a_j = GENERATOR.uniform(0.3, 7, count) if radius_j is None else np.full(count, float(radius_j))
    xi = GENERATOR.uniform(-0.02, 0.5, count) if gap is None else np.full(count, float(gap))
    normal = GENERATOR.normal(size=(count, 3))
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    separation = normal * (a_i + a_j)[:, None] * (1 + xi / 2)[:, None]
    motion = GENERATOR.normal(size=(4, count, 3))
    index = np.arange(count)
    return Pairs(index, index + count, np.zeros((count, 3), int), separation, a_i, a_j, *motion, 5 * motion[0, :, 1])


def turned(pairs, rotation):
    """Returns the pairs in a rotated frame."""
    vectors = ("separation", "velocity_i", "velocity_j", "spin_i", "spin_j")
    result = copy.copy(pairs)
    for name in vectors:
        setattr(result, name, getattr(pairs, name) @ rotation.T)
    return result


def rigidly_moved(pairs):
    """Returns the pairs with the velocities of a rigid body."""
    velocity, spin = GENERATOR.normal(size=(2, 3))
    result = copy.copy(pairs)
    result.velocity_i = np.broadcast_to(velocity, pairs.separation.shape)
    result.velocity_j = velocity + np.cross(spin, pairs.separation)
    result.spin_i = result.spin_j = np.broadcast_to(spin, pairs.separation.shape)
    return result


def power(pairs, force, torque_i=0.0, torque_j=0.0):
    """Returns the power of a load on the motion of each pair."""
    parts = force * (pairs.velocity_i - pairs.velocity_j) + torque_i * pairs.spin_i + torque_j * pairs.spin_j
    return parts.sum(axis=1)


def spring_of(pairs):
    return across(pairs.normal, GENERATOR.normal(size=(len(pairs), 3)))


class Lubrication(unittest.TestCase):
    def test_of_equal_spheres_has_the_resistances_of_printed_tables(self):
        # Expected (Kim & Karrila), in units of 6 pi eta a: 1/(4 xi) + 9/40 ln(1/xi) and ln(1/xi)/6.
        for xi, squeeze, shear in ((1e-3, 251.55, 1.1513), (0.05, 5.674, 0.4993), (0.5, 0.6560, 0.11553)):
            found = lubrication.resistances(some_pairs(1, 1, 1, xi), 1.0, INNER)
            self.assertAlmostEqual(found[0][0] / (6 * np.pi), squeeze, delta=1e-4 * squeeze)
            self.assertAlmostEqual(found[1][0] / (6 * np.pi), shear, delta=1e-4 * shear)

    def test_matrix_is_symmetric_and_positive_with_five_modes(self):
        for matrix in lubrication.resistance_matrix(some_pairs(50), VISCOSITY, INNER):
            scale = abs(matrix).max()
            self.assertLess(abs(matrix - matrix.T).max(), 1e-14 * scale)
            values = np.linalg.eigvalsh(matrix)
            self.assertLess(abs(values[:7]).max(), 1e-13 * values[-1])
            self.assertGreater(values[7], 1e-9 * values[-1])

    def test_noise_has_the_covariance_of_the_resistance(self):
        pairs = some_pairs(50)
        root = lubrication.noise_matrix(pairs, VISCOSITY, INNER)
        matrix = lubrication.resistance_matrix(pairs, VISCOSITY, INNER)
        scale = abs(matrix).max(axis=(1, 2), keepdims=True)
        self.assertLess((abs(root @ root.transpose(0, 2, 1) - matrix) / scale).max(), 1e-13)

    def test_does_not_resist_a_rigid_motion(self):
        pairs = rigidly_moved(some_pairs(50))
        loads = lubrication.lubrication(pairs, VISCOSITY, INNER)
        typical = lubrication.lubrication(some_pairs(50), VISCOSITY, INNER)
        for load, other in zip(loads, typical):
            self.assertLess(abs(load).max(), 1e-12 * abs(other).max())

    def test_takes_energy_away(self):
        pairs = some_pairs(200)
        self.assertLess(power(pairs, *lubrication.lubrication(pairs, VISCOSITY, INNER)).max(), 0)

    def test_holds_back_spheres_that_are_parted(self):
        pairs = some_pairs(1)
        pairs.velocity_i, pairs.velocity_j = 0 * pairs.normal, pairs.normal
        pairs.spin_i = pairs.spin_j = 0 * pairs.normal
        force, *_ = lubrication.lubrication(pairs, VISCOSITY, INNER)
        self.assertGreater(np.sum(force * pairs.normal), 0)


class LubricationInAFlow(unittest.TestCase):
    """The form with strain rates."""

    sizes = GENERATOR.uniform(0.3, 7, (2, 50))
    g = strained_lubrication.mari_coefficients(*sizes)

    def test_its_coefficients_obey_the_identities_of_the_other_form(self):
        total = self.sizes.sum(axis=0)
        for strain, motion, factor in (("XG", "XA", 1), ("YG", "YA", 0.5), ("YH", "YB", -0.5)):
            for places in ((0, 2), (1, 3)):
                found = sum(self.g[strain][place] for place in places)
                # Forces on j are opposite; for torques Y_B of j is the one with index ji.
                row = 2 if places == (1, 3) and motion == "YB" else places[0]
                np.testing.assert_allclose(found, factor * total * self.g[motion][row], rtol=1e-12)

    def test_exchanging_the_spheres_exchanges_the_indices(self):
        for name, values in strained_lubrication.mari_coefficients(*self.sizes[::-1]).items():
            # The normal is reversed, so functions odd in it change sign.
            sign = -1 if name in ("YB", "XG", "YG") else 1
            np.testing.assert_allclose(values[0], sign * self.g[name][3])
            np.testing.assert_allclose(values[1], sign * self.g[name][2])

    def test_near_contact_it_is_the_other_form_in_any_shear(self):
        # They differ by terms of order xi. Squeezing, 1 / xi stronger, is compared by itself.
        pairs = some_pairs(50, gap=1e-6)
        shear = flow.Flow({"shear_rate": 0.7}, 10.0)
        ours, other = strained_lubrication.mari_lubrication(pairs, VISCOSITY, 0.0, shear), lubrication.lubrication(
            pairs, VISCOSITY, 1e-8
        )
        parts = [(along(pairs.normal, ours[0]), along(pairs.normal, other[0]))]
        parts += [(across(pairs.normal, a), across(pairs.normal, b)) for a, b in zip(ours, other)]
        for a, b in parts:
            self.assertLess(abs(a - b).max(), 1e-4 * abs(b).max())

    def test_spheres_that_turn_with_the_fluid_feel_nothing_but_its_strain(self):
        shear = flow.Flow({"shear_rate": 0.7}, 10.0)
        pairs = some_pairs(50, gap=0.01)
        pairs.velocity_i, pairs.velocity_j = shear.velocity(pairs.height_i), shear.velocity(pairs.height_j)
        pairs.spin_i, pairs.spin_j = shear.spin(pairs.height_i), shear.spin(pairs.height_j)
        force, *_ = strained_lubrication.mari_lubrication(pairs, VISCOSITY, 1e-3, shear)
        approach = 0.7 * pairs.normal[:, 0] * pairs.normal[:, 1]  # n.E.n: positive if they separate
        self.assertTrue(np.all(np.sign(np.sum(force * pairs.normal, axis=1)) == np.sign(approach)))


class Flows(unittest.TestCase):
    waves = flow.Flow(MONTI["flow"], 10.0)
    height = np.linspace(-3, 12, 7)

    def test_gradient_is_that_of_the_velocity(self):
        step = 1e-5
        numeric = (self.waves.speed(self.height + step) - self.waves.speed(self.height - step)) / (2 * step)
        np.testing.assert_allclose(self.waves.gradient(self.height), numeric, rtol=1e-8)

    def assert_mean(self, of, weight):
        """Compares with a mean over a small sphere: of a function of y alone, over heights, by Gauss-Legendre
        in 8 points. The next term of the series is about (k a)^2 / 20 of this one."""
        nodes, weights = np.polynomial.legendre.leggauss(8)
        radius = 0.1
        correction = of(self.height[:, None] + radius * nodes) @ (weights * weight(nodes)) - of(self.height)
        found = of(self.height, radius) - of(self.height)
        np.testing.assert_allclose(found, correction, rtol=0, atol=4e-3 * abs(correction).max())

    def test_drag_is_by_the_mean_over_the_surface(self):
        self.assert_mean(self.waves.speed, lambda height: 0.5)  # all heights have equal areas

    def test_stresslets_are_by_the_mean_over_the_volume(self):
        self.assert_mean(self.waves.gradient, lambda height: 0.75 * (1 - height**2))

    def test_shear_alone_has_no_curvature(self):
        shear = flow.Flow({"shear_rate": 0.7, "faxen": True}, 10.0)
        np.testing.assert_allclose(shear.speed(self.height, 3.0), 0.7 * self.height)
        np.testing.assert_allclose(shear.gradient(self.height, 3.0), 0.7)

    def test_waves_come_back_after_the_edge_of_the_box(self):
        np.testing.assert_allclose(self.waves.speed(self.height + 10), self.waves.speed(self.height) + 7)


class Contact(unittest.TestCase):
    pairs = some_pairs(200, gap=-0.01)

    def test_normal_force_parts_the_spheres_by_stiffness_times_overlap(self):
        pairs = some_pairs(3, 1, 3, -0.01)  # overlap 0.01 (1 + 3) / 2
        force = contact.contact_normal(pairs, 1e4)
        np.testing.assert_allclose(force, -200 * pairs.normal, rtol=1e-10)

    def test_damping_takes_energy_away(self):
        self.assertLess(power(self.pairs, contact.contact_damping(self.pairs, 1.3)).max(), 1e-15)

    def test_a_rigid_motion_neither_slips_nor_rolls(self):
        moved = rigidly_moved(self.pairs)
        self.assertLess(abs(contact.slip_velocity(moved)).max(), 1e-12)
        self.assertLess(abs(contact.rolling_velocity(moved)).max(), 1e-12)

    def test_a_spring_that_is_turned_keeps_its_length(self):
        spring = GENERATOR.normal(size=(200, 3))
        held = contact.held_spring(self.pairs, spring, 0 * spring, 0.0, np.full(200, np.inf))
        np.testing.assert_allclose(np.linalg.norm(held, axis=1), np.linalg.norm(spring, axis=1))
        self.assertLess(abs(np.sum(held * self.pairs.normal, axis=1)).max(), 1e-14)

    def test_a_spring_is_no_longer_than_coulomb_lets_it_be(self):
        spring = spring_of(self.pairs)
        held = contact.held_spring(self.pairs, spring, spring, 1.0, np.full(200, 0.1))
        np.testing.assert_allclose(held, 0.1 * spring / np.linalg.norm(spring, axis=1, keepdims=True))

    def test_a_dashpot_dissipates_within_what_coulomb_lets_it_and_the_spring_do(self):
        spring, velocity, limit = 0.1 * spring_of(self.pairs), contact.slip_velocity(self.pairs), np.full(200, 300.0)
        stuck = contact.held_spring(self.pairs, spring, 0 * spring, 0.0, limit / 1e3)
        for damping in (1.0, 100.0, 1e4):
            force, *_ = contact.friction(self.pairs, stuck, 1e3, damping, limit)
            both = 1e3 * stuck + damping * velocity
            length = np.linalg.norm(both, axis=1, keepdims=True)
            np.testing.assert_allclose(force, np.where(length > 300, 300 / length, 1) * both)
            self.assertGreater(np.sum((force - 1e3 * stuck) * velocity, axis=1).min(), 0)

    def test_friction_and_rolling_slow_down_what_stretched_their_springs(self):
        for velocity, law in ((contact.slip_velocity, contact.friction), (contact.rolling_velocity, contact.rolling)):
            spring = 1e-3 * velocity(self.pairs)
            self.assertLess(power(self.pairs, *law(self.pairs, spring, 1e3)).max(), 0)


class AllLawsOfPairs(unittest.TestCase):
    pairs = some_pairs(100, gap=-0.01)
    spring = spring_of(pairs)
    theta, chi = GENERATOR.normal(size=(2, 100, 3))

    def loads(self, pairs, spring, theta, chi):
        nothing = np.zeros_like(pairs.normal)
        yield contact.contact_normal(pairs, 1e4), nothing, nothing
        yield contact.contact_damping(pairs, 1.3), nothing, nothing
        yield contact.friction(pairs, spring, 1e3)
        yield contact.rolling(pairs, spring, 1e3)
        yield lubrication.lubrication(pairs, VISCOSITY, INNER)
        yield lubrication.lubrication_noise(pairs, VISCOSITY, INNER, 3.0, theta, chi)
        yield surface_forces.exponential_repulsion(pairs, 0.17, 0.01, 20), nothing, nothing
        yield surface_forces.screened_repulsion(pairs, 1.06, 0.02, 1.0, 20), nothing, nothing
        yield surface_forces.attraction(pairs, 6.7e-5, 0.01, 1.0), nothing, nothing

    def test_conserve_angular_momentum(self):
        for force, torque_i, torque_j in self.loads(self.pairs, self.spring, self.theta, self.chi):
            # The force on j is -F_i and acts at r.
            total = torque_i + torque_j - np.cross(self.pairs.separation, force)
            self.assertLess(abs(total).max(), 1e-12 * (abs(force).max() + abs(torque_i).max()))

    def test_turn_with_the_pair(self):
        rotation, _ = np.linalg.qr(GENERATOR.normal(size=(3, 3)))
        rotation *= np.linalg.det(rotation)
        before = self.loads(self.pairs, self.spring, self.theta, self.chi)
        vectors = (v @ rotation.T for v in (self.spring, self.theta, self.chi))
        for load, other in zip(before, self.loads(turned(self.pairs, rotation), *vectors)):
            for a, b in zip(load, other):
                self.assertLess(abs(a @ rotation.T - b).max(), 1e-12 * (abs(a).max() or 1))


class Stress(unittest.TestCase):
    def test_of_a_pair_that_the_flow_presses_together_is_positive(self):
        pairs = some_pairs(1, 1, 1, -0.01)
        pairs.separation = 1.99 * np.array([[1, -1, 0]]) / np.sqrt(2)
        tensor = stress.pair_stress(pairs, contact.contact_normal(pairs, 1e4), 1.0)
        self.assertGreater(tensor[0, 1], 0)
        self.assertLess(np.trace(tensor), 0)

    def test_stresslets_of_all_spheres_are_two_and_a_half_times_their_share(self):
        radius, volume = np.array([1.0, 1.4, 3.0]), 1000.0
        share = 4 / 3 * np.pi * np.sum(radius**3) / volume
        found = stress.stresslet(radius, 0 * radius, 0.1, flow.Flow({"shear_rate": 0.7}, 10.0), volume)
        ratio = found[0, 1] / stress.solvent_stress(0.1, 0.7)[0, 1]
        self.assertAlmostEqual(ratio, 2.5 * share)


if __name__ == "__main__":
    unittest.main()
