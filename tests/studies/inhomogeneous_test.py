#!/usr/bin/python3
"""Bins of inhomogeneous flows, maps learned from them and solved profiles, by examples with known answers."""
import math
import os
import sys
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "results"))
from studies.inhomogeneous import (
    MEAN_VOLUME,
    VISCOSITY,
    Flow,
    bin_rows,
    distinct_bins,
    growth,
    profile_of,
    rows_by_seed,
    symmetric,
    symmetric_bin_rows,
    symmetric_rows_by_seed,
    symmetries,
    wave,
    waves_of,
)
from studies.learned_maps import ratio_of_means
from studies.learning import LawOfFraction, Published, left_out, relative_error
from studies.profile_solver import DRAG, Law, drag_by_share, rates_of, solve, spread, stress_of_drag, velocity_of

import numpy as np

FLOW = Flow("one", [wave(0.3)], 50, 0.5, 40, 100)


def profiles_of(fraction, velocity, stress, variance):
    """Returns profiles in the format of a result."""
    return {
        "volume_fraction": fraction,
        "velocity": {"flux": (fraction * velocity).tolist(), "volume_fraction": fraction},
        "velocity_variance": np.tile(variance, (3, 1)).tolist(),
        "volume_fraction_by_radius": [(0.4 * fraction).tolist(), (0.6 * fraction).tolist()],
        "stress": {"pairs": stress.tolist()},
    }


class Bins(unittest.TestCase):
    def test_a_flow_has_its_driving_and_its_spheres(self):
        self.assertEqual(FLOW.bins, 25)
        self.assertAlmostEqual(FLOW.largest_rate(), 0.3 * 2 * math.pi / 50, places=6)
        y = 0.5 + np.arange(25) * 2 + 0.5
        half = math.sin(math.pi / 25) / (math.pi / 25)  # the mean of a sine over a bin
        for k in range(25):
            self.assertAlmostEqual(FLOW.driving_of_bins()[k], 0.3 * half * math.sin(2 * math.pi * y[k] / 50), places=4)
        settings = FLOW.settings()
        self.assertEqual(settings["/particles/count"], round(0.5 * 17.7**2 * 50 / MEAN_VOLUME))
        self.assertAlmostEqual(settings["/duration/production/time"] * FLOW.largest_rate(), 100, places=2)

    def test_waves_go_through_the_velocities_that_were_given(self):
        t = 2 * math.pi * np.arange(32) / 32
        (first, third) = waves_of(0.1 * np.sin(t) ** 3)  # (3 sin t - sin 3 t) / 4
        for found, periods, sine in ((first, 1, 0.075), (third, 3, -0.025)):
            self.assertEqual(found["periods"], periods)
            self.assertAlmostEqual(found["sine"], sine)
            self.assertAlmostEqual(found["cosine"], 0)
        for count in (8, 9):
            values = np.array([3, 1, 4, -1, -5, 2, -6, 2, 0][:count], float)
            values -= values.mean()
            y = np.arange(count) * 20 / count
            driven = Flow("table", waves_of(values), 20, 0.5, 1, 1)
            np.testing.assert_allclose(driven.driving(y), values, atol=1e-12)
        with self.assertRaises(ValueError):
            waves_of([1.0, 2.0, 3.0])

    def test_local_quantities_are_those_of_their_formulas(self):
        fraction = np.full(25, 0.5)
        velocity = 0.2 * np.sin(2 * math.pi * (2 * np.arange(25) + 1) / 50)
        stress = np.array([np.full(25, s) for s in (-3.0, -2.0, -1.0, 0.5)])
        (row, *_) = bin_rows(FLOW, [profile_of(FLOW, profiles_of(fraction, velocity, stress, np.full(25, 0.04)))] * 2)
        # Central differences of a sine over two bins of width 2.
        rate = 0.2 * math.cos(2 * math.pi / 50) * math.sin(4 * math.pi / 50) / 2
        self.assertAlmostEqual(row["rate"], rate)
        self.assertAlmostEqual(row["pressure"], 2)
        self.assertAlmostEqual(row["J"], VISCOSITY * rate / 2)
        self.assertAlmostEqual(row["mu"], 0.25)
        self.assertAlmostEqual(row["Theta"], VISCOSITY * 0.2 / 2)
        self.assertAlmostEqual(row["lag"], (row["driving"] - velocity[0]) / (row["driving"] + 1e-5))
        self.assertEqual(row["mu_error"], 0)
        self.assertAlmostEqual(row["largest share"], 0.6)

    def test_symmetries_are_those_of_the_driving(self):
        # A sine: half a turn about zeros, reflection at crests, change of sign after half its length.
        self.assertEqual(len(symmetries(FLOW.driving_of_bins())), 2)  # crests of 25 bins are off-centre
        sine = Flow("sine", [wave(0.1)], 16, 0.5, 1, 1).driving_of_bins()  # 8 bins
        found = {(tuple(image.tolist()), sign, shear) for image, sign, shear in symmetries(sine)}
        self.assertEqual(
            found,
            {
                ((0, 1, 2, 3, 4, 5, 6, 7), 1, 1),
                ((4, 5, 6, 7, 0, 1, 2, 3), -1, -1),
                ((7, 6, 5, 4, 3, 2, 1, 0), -1, 1),
                ((3, 2, 1, 0, 7, 6, 5, 4), 1, -1),
            },
        )
        self.assertEqual(distinct_bins(sine), [0, 1])
        # sin(2 pi y / 16 + 3 pi / 8) has crests at the centres of bins 0 and 4, where the rate is zero.
        crests = Flow("crests", [wave(math.cos(3 * math.pi / 8), 1, math.sin(3 * math.pi / 8))], 16, 0.5, 1, 1)
        self.assertEqual(len(symmetries(crests.driving_of_bins())), 4)
        self.assertEqual(distinct_bins(crests.driving_of_bins()), [1, 2])
        both = Flow("two", [wave(0.1), wave(0.07, 2)], 16, 0.5, 1, 1).driving_of_bins()
        self.assertEqual([(sign, shear) for _, sign, shear in symmetries(both)], [(1, 1), (-1, 1)])
        none = Flow("none", [wave(0.1), wave(0.07, 2, 0.03)], 16, 0.5, 1, 1).driving_of_bins()
        self.assertEqual(len(symmetries(none)), 1)

    def test_a_mean_over_symmetries_keeps_what_obeys_them_and_halves_what_does_not(self):
        sine = Flow("sine", [wave(0.1)], 16, 0.5, 1, 1)
        y = 2 * math.pi * (np.arange(8) + 0.5) / 8
        stress = np.array([-2 + 0.1 * np.cos(2 * y), -1.5 + 0 * y, -1 - 0.2 * np.cos(2 * y), 0.3 * np.cos(y)])
        obeys = profiles_of(0.5 + 0.1 * np.cos(4 * y), 0.08 * np.sin(y), stress, 0.04 + 0.01 * np.cos(2 * y))
        for found, given in zip(
            symmetric(profile_of(sine, obeys)).columns().items(), profile_of(sine, obeys).columns().items()
        ):
            np.testing.assert_allclose(found[1], given[1], rtol=1e-12, atol=1e-15, err_msg=found[0])
        bump = np.array([0.04, 0, 0, 0, 0, 0, 0, 0])
        other = profiles_of(0.5 + bump, 0.08 * np.sin(y) + bump, stress + bump, np.full(8, 0.04))
        mean = symmetric(profile_of(sine, other))
        np.testing.assert_allclose(mean.fraction, [0.51, 0.5, 0.5, 0.51] * 2)
        images = np.array([0.01, 0, 0, 0.01, -0.01, 0, 0, -0.01])
        np.testing.assert_allclose(mean.velocity, 0.08 * np.sin(y) + images, atol=1e-15)
        np.testing.assert_allclose(mean.stress[3], 0.3 * np.cos(y) + [0.01, 0, 0, -0.01, -0.01, 0, 0, 0.01], atol=1e-15)
        self.assertEqual([row["y"] for row in symmetric_bin_rows(sine, [mean, mean])], [1, 3])

    def test_errors_are_those_of_a_mean(self):
        """For linear functions the jackknife gives the standard error of the mean."""
        stress = np.array([np.full(25, s) for s in (-1.0, -1.0, -1.0, 0.5)])
        values = [0.50, 0.52, 0.51, 0.55]
        profiles = [
            profile_of(FLOW, profiles_of(np.full(25, v), np.zeros(25), stress, np.full(25, 0.01))) for v in values
        ]
        (row, *_) = bin_rows(FLOW, profiles)
        self.assertAlmostEqual(row["fraction"], np.mean(values))
        self.assertAlmostEqual(row["fraction_error"], np.std(values, ddof=1) / 2)

    def test_rows_by_seed_are_those_of_each_realisation(self):
        sine = Flow("sine", [wave(0.1)], 16, 0.5, 1, 1)
        stress = np.array([np.full(8, s) for s in (-3.0, -2.0, -1.0, 0.5)])
        bump = np.array([0.04, 0, 0, 0, 0, 0, 0, 0])
        profiles = [
            profile_of(sine, profiles_of(0.5 + k * bump, np.zeros(8), k * stress, np.full(8, 0.04))) for k in (1, 2)
        ]
        rows = list(rows_by_seed(sine, profiles))
        self.assertEqual([(r["seed"], r["y"]) for r in rows], [(k, 2 * n + 1) for k in (0, 1) for n in range(8)])
        self.assertEqual([r["fraction"] for r in rows[::8]], [0.54, 0.58])
        self.assertAlmostEqual(rows[8]["Theta"], 0.5 * rows[0]["Theta"])  # eta du / (a P) at twice the pressure
        # The four images of bin 0 share its bump.
        distinct = list(symmetric_rows_by_seed(sine, profiles))
        self.assertEqual([(r["seed"], r["y"]) for r in distinct], [(0, 1), (0, 3), (1, 1), (1, 3)])
        np.testing.assert_allclose([r["fraction"] for r in distinct], [0.51, 0.5, 0.52, 0.5])

    def test_a_profile_that_grows_is_told_from_noise(self):
        shape = np.cos(np.arange(20) * 2 * math.pi / 20)
        halves = np.array([1, 1, 1.1, 1.1])
        seeds = [0.5 + halves[:, None] * shape * (1 + e) for e in (-0.1, 0.1)]
        # Growth by a tenth of the first half, which is 1 / 1.05 of the mean: (0.1 * 0.9, 0.1 * 1.1) / 1.05.
        value, error = growth(seeds)
        self.assertAlmostEqual(value, 0.1 / 1.05)
        self.assertAlmostEqual(error, 0.01 / 1.05)
        other = np.sin(np.arange(20) * 2 * math.pi / 20)  # another shape, only in the last quarter
        noisy = [one + np.outer([0, 0, 0, 1], e * other) for one, e in zip(seeds, (3.0, -3.0))]
        self.assertAlmostEqual(growth(noisy)[0], 0.1 / 1.05)


class Maps(unittest.TestCase):
    def test_the_error_is_a_ratio_of_norms_of_scaled_values(self):
        # Scaled: 0.1 off 0.5 and 0.1 off 1; norms of (0.1, 0.1) and (0.5, 1).
        self.assertAlmostEqual(relative_error([1.6, 1.9], [1.5, 2.0], 1.0, 2.0), math.sqrt(0.02 / 1.25))

    def test_flows_are_left_out_whole(self):
        found = {name: (own.tolist(), others.tolist()) for name, own, others in left_out(np.array(["a", "b", "a"]))}
        self.assertEqual(found, {"a": ([True, False, True], [False, True, False]), "b": ([0, 1, 0], [1, 0, 1])})

    def test_a_law_of_two_parameters_is_found_exactly(self):
        fraction, j = np.array([0.5, 0.55, 0.6, 0.52]), np.array([1e-3, 2e-3, 1e-4, 5e-2])
        table = {"fraction": fraction, "J": j, "mean": fraction, "mu": j / (3 * (0.66 - fraction) ** 2)}
        model = LawOfFraction(("J", "fraction", "mean"), "mu").fit(table)
        new = {"fraction": np.array([0.58]), "J": np.array([1e-2]), "mean": np.array([0.58])}
        self.assertAlmostEqual(model.predict(new)[0], 1e-2 / (3 * 0.08**2), places=6)
        # The training range of ln J is 1e-4 to 5e-2.
        beyond = model.beyond({"fraction": np.array([0.55]), "J": np.array([5e-1]), "mean": np.array([0.55])})
        self.assertAlmostEqual(beyond[0], math.log(10) / math.log(500))

    def test_a_ratio_of_means_has_the_error_of_its_jackknife(self):
        value, error = ratio_of_means([(1, 1), (2, 2), (3, 1)])
        self.assertAlmostEqual(value, 6 / 4)
        left = np.array([5 / 3, 4 / 2, 3 / 3])
        self.assertAlmostEqual(error, math.sqrt(2 / 3 * np.sum((left - left.mean()) ** 2)))

    def test_trees_give_back_what_they_were_shown(self):
        table = {name: np.linspace(1, 2, 40) for name in ("J", "fraction", "mean", "mu")}
        found = Published(("J", "fraction", "mean"), "mu").fit(table).predict(table)
        self.assertLess(np.max(np.abs(found - table["mu"])), 0.02)


class Solver(unittest.TestCase):
    Y = (np.arange(50) + 0.5) * 2

    def test_what_spreads_loses_its_short_waves(self):
        wave_number = 2 * math.pi * 3 / 100
        found = spread(1 + np.cos(wave_number * self.Y), 100, 2.5)
        expected = 1 + np.cos(wave_number * self.Y) / (1 + (2.5 * wave_number) ** 2)
        np.testing.assert_allclose(found, expected, atol=1e-12)

    def test_a_fluid_of_one_viscosity_lags_by_its_momentum_balance(self):
        """eta u'' = -c phi (u_driving - u), with second differences in place of u''."""
        wave_number, viscosity, fraction = 2 * math.pi / 100, 1.7, 0.5
        driving = np.sin(wave_number * self.Y)
        found = velocity_of(driving, np.full(50, fraction), np.full(50, viscosity), 2.0)
        bend = (2 / 2.0 * math.sin(wave_number * 2.0 / 2)) ** 2
        np.testing.assert_allclose(found, driving / (1 + viscosity * bend / (DRAG * fraction)), rtol=1e-10)

    def test_rates_are_central_differences_around_the_box(self):
        np.testing.assert_allclose(rates_of(np.array([0.0, 1.0, 4.0, 9.0]), 0.5), [-8, 4, 8, -4])

    def test_drag_follows_from_the_spheres_of_a_bin(self):
        self.assertAlmostEqual(drag_by_share(1.4**3 / (1 + 1.4**3)), DRAG)  # equal numbers
        self.assertAlmostEqual(drag_by_share(0.0), 4.5 * VISCOSITY)  # 6 pi eta / (4 pi / 3)

    def test_the_shear_stress_is_the_integral_of_the_drag(self):
        """d sigma / dy = -c phi a sin ky; by trapezia c phi a w cos ky / (2 tan(k w / 2)), or 0."""
        wave_number = 2 * math.pi / 100
        table = {
            "largest share": np.full(50, 0.6),
            "fraction": np.full(50, 0.5),
            "driving": 0.3 * np.sin(wave_number * self.Y),
            "velocity": 0.2 * np.sin(wave_number * self.Y),
            "rate": np.cos(wave_number * self.Y),
        }
        expected = drag_by_share(0.6) * 0.5 * 0.1 * 2 * np.cos(wave_number * self.Y) / (2 * math.tan(wave_number))
        np.testing.assert_allclose(stress_of_drag(table, 2.0), expected, atol=1e-12)

    class OfOneViscosity:
        """A law with mu = 3 J and the mean volume fraction everywhere."""

        reach = 1.0

        def source(self, fraction, rate):
            return np.abs(rate)

        def __call__(self, j, theta):
            return 3 * j, np.full(len(j), FLOW.fraction)

    def test_a_law_of_one_viscosity_gives_its_fluid(self):
        """Expected: sigma = mu P = 3 eta du/dy for any pressure."""
        found = solve(FLOW, self.OfOneViscosity())
        bend = (2 / 2.0 * math.sin(2 * math.pi / 50 * 2.0 / 2)) ** 2
        lag = 1 + 3 * VISCOSITY * bend / (DRAG * FLOW.fraction)
        np.testing.assert_allclose(found.velocity, FLOW.driving_of_bins() / lag, atol=1e-6)
        np.testing.assert_allclose(found.fraction, FLOW.fraction)

    def test_what_comes_to_no_end_is_said(self):
        with self.assertRaises(ArithmeticError):
            solve(FLOW, self.OfOneViscosity(), most=3)

    def test_a_law_is_found_with_its_reach(self):
        """Bins whose Theta is spread by 3, with mu and phi of a law of second degree."""
        y = (np.arange(50) + 0.5) * 2
        uniform = {"fraction": np.array([0.4, 0.5, 0.6]), "J": np.full(3, 1e-2)}
        uniform["Theta"] = uniform["J"] * np.exp(1 + 2 * uniform["fraction"])
        uniform["mu"] = np.exp(0.3 + 0.5 * np.log(uniform["J"]) - 0.2 * np.log(uniform["Theta"]))
        tables = []
        for amplitude in (0.1, 0.3):
            rate = amplitude * np.cos(2 * math.pi * y / 100 + 0.03)  # nowhere zero
            table = {"fraction": 0.5 - 0.05 * np.cos(4 * math.pi * y / 100), "rate": rate, "pressure": np.full(50, 2.0)}
            made = spread(np.exp(1 + 2 * table["fraction"]) * np.abs(rate), 100, 3.0)
            table["J"], table["Theta"] = VISCOSITY * np.abs(rate) / 2, VISCOSITY * made / 2
            table["mu"] = np.exp(0.3 + 0.5 * np.log(table["J"]) - 0.2 * np.log(table["Theta"]))
            tables.append(table)
        law = Law(tables, uniform, [100, 100])
        self.assertAlmostEqual(law.reach, 3.0)
        mu, _ = law(tables[0]["J"], tables[0]["Theta"])
        np.testing.assert_allclose(mu, tables[0]["mu"], rtol=1e-8)


if __name__ == "__main__":
    unittest.main()
