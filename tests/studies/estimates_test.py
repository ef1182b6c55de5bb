#!/usr/bin/python3
"""Numbers with standard errors, and fits, compared with printed tables and formulas."""
import math
import os
import sys
import tempfile
import unittest
import unittest.mock
from pathlib import Path
from statistics import NormalDist

import numpy as np

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.path.insert(0, os.path.join(ROOT, "results"))
from studies.estimates import (
    difference,
    estimate,
    jackknife,
    logarithm,
    over,
    propagated,
    quotient,
    relative_difference,
    scaled,
    student_quantile,
    weighted_mean,
)
from studies.at_rest import SLOW_SHEAR, fit_with_errors, fitted, rows_at_rest
from studies.fits import decades_of_rise, divergence, jammed_and_exponent, line_through, lines, log_minimum
from studies.fits import log_of_share, multiples, thickening_decades
from studies.published import JAMMED_AT_REST, diverging, gap_of, linear_mixture, mari_fit, rod_lengths, rods
from studies.tables import columns_of, markdown_head, markdown_row, number_text


class Means(unittest.TestCase):
    def test_quantiles_are_those_of_printed_tables(self):
        for degrees, quantile in ((1, 12.706), (4, 2.776), (7, 2.365), (31, 2.040), (120, 1.980)):
            self.assertAlmostEqual(student_quantile(degrees, 0.975), quantile, delta=6e-4)
        for degrees, quantile in ((1, 636.619), (9, 4.781), (30, 3.646)):  # two-sided 0.999
            self.assertAlmostEqual(student_quantile(degrees, 0.9995), quantile, delta=6e-4)
        self.assertEqual(student_quantile(0, 0.975), math.inf)

    def test_the_error_of_1_to_n_is_the_root_of_n_plus_1_over_12(self):
        # The variance of 1 ... n about its mean is n (n + 1) / 12 with n - 1 in the denominator.
        for n in (2, 5, 100):
            mean, error = estimate(range(1, n + 1))
            self.assertAlmostEqual(mean, (n + 1) / 2)
            self.assertAlmostEqual(error, math.sqrt((n + 1) / 12))

    def test_a_single_value_has_no_error(self):
        self.assertEqual(estimate([3]), (3, math.inf))

    def test_weights_are_inverse_variances(self):
        # Errors of 1 and 2: weights 4/5 and 1/5, error sqrt(1 / (1 + 1/4)).
        mean, error = weighted_mean([10, 20], [1, 2])
        self.assertAlmostEqual(mean, 12)
        self.assertAlmostEqual(error, math.sqrt(0.8))


class Functions(unittest.TestCase):
    def test_errors_add_in_quadrature(self):
        self.assertEqual(difference((5, 3), (2, 4)), (3, 5))

    def test_a_factor_has_no_error(self):
        self.assertEqual(scaled((2, 0.5), -3), (-6, 1.5))

    def test_relative_errors_of_a_quotient_add_in_quadrature(self):
        for sign in (1, -1):
            value, error = quotient((sign * 6, 0.18), (2, 0.08))
            self.assertEqual(value, sign * 3)
            self.assertAlmostEqual(error, 3 * 0.05)  # 3 % and 4 %

    def test_exact_factors_scale_errors(self):
        self.assertEqual(over((6, 0.5), -2), (-3, 0.25))
        self.assertEqual(logarithm((math.e, 0.1 * math.e)), (1, 0.1))

    def test_pairs_of_seeds_hide_what_they_share(self):
        reference, values = {1: 10, 2: 20, 3: 30}, {1: 11, 2: 21, 3: 31, 4: 1000}
        value, error, degrees = relative_difference(values, reference, paired=True)
        self.assertAlmostEqual(value, 0.05)
        self.assertAlmostEqual(error, 0)
        self.assertEqual(degrees, 2)

    def test_without_pairs_both_scatters_count(self):
        value, error, degrees = relative_difference({1: 11, 2: 13}, {3: 9, 4: 11, 5: 10}, paired=False)
        self.assertAlmostEqual(value, 0.2)
        # 12 +- 1 over 10 +- 1/sqrt(3)
        self.assertAlmostEqual(error, 1.2 * math.hypot(1 / 12, 1 / math.sqrt(3) / 10))
        self.assertEqual(degrees, 1)

    def test_propagated_errors_of_a_sum_are_those_of_the_formula(self):
        value, error = propagated([(1, 3), (2, 4)], sum)
        self.assertEqual(value, 3)
        # 400 draws give a standard deviation to 1 / sqrt(800) = 3.5 %. The seed is fixed.
        self.assertAlmostEqual(error, 5, delta=0.5)

    def test_propagated_errors_of_several_numbers_come_from_the_same_draws(self):
        values, errors = propagated([(1, 0.1)], lambda drawn: (drawn[0], 2 * drawn[0]))
        self.assertEqual(values, (1, 2))
        self.assertAlmostEqual(errors[1], 2 * errors[0])


class Jackknife(unittest.TestCase):
    values = np.array([2.0, 3.0, 5.0, 7.0, 11.0])

    def test_of_a_mean_has_the_error_of_the_mean(self):
        value, error = jackknife(lambda chosen: self.values[chosen].mean(), 5)
        self.assertAlmostEqual(value, 5.6)
        self.assertAlmostEqual(error, math.sqrt(12.8 / 5))  # their variance is 12.8

    def test_of_several_numbers_has_an_error_for_each(self):
        _, (first, second) = jackknife(lambda chosen: (self.values[chosen].mean(), 3 * self.values[chosen].mean()), 5)
        self.assertAlmostEqual(second, 3 * first)


class Fits(unittest.TestCase):
    def test_a_line_is_found_exactly_and_its_slope_has_the_error_of_the_formula(self):
        x = np.array([1.0, 2.0, 4.0])
        intercept, slope, error = line_through(x, 3 - 2 * x, [0.5, 0.5, 0.5])
        self.assertAlmostEqual(intercept, 3)
        self.assertAlmostEqual(slope, -2)
        # sigma / sqrt(sum (x - mean)^2): the squares about 7/3 are 14/3.
        self.assertAlmostEqual(error, 0.5 / math.sqrt(14 / 3))

    def test_weights_draw_a_line_to_points_with_small_errors(self):
        # Two exact points and one without weight.
        _, slope, _ = line_through([0, 1, 2], [0, 1, 50], [1e-3, 1e-3, 1e6])
        self.assertAlmostEqual(slope, 1)

    def test_multiples_and_lines_leave_what_least_squares_leaves(self):
        shapes = np.array([[1.0, 2.0, 3.0], [1.0, 1.0, 2.0]])
        factors, left = multiples(shapes, np.array([2.0, 4.0, 6.0]))
        self.assertAlmostEqual(factors[0], 2)
        self.assertAlmostEqual(left[0], 0)
        self.assertAlmostEqual(factors[1], 3)  # 18 / 6
        self.assertAlmostEqual(left[1], 2)  # 56 - 18^2 / 6
        constants, slopes, left = lines(shapes, [7, 9, 11])
        self.assertAlmostEqual(constants[0], 5)
        self.assertAlmostEqual(slopes[0], 2)
        self.assertAlmostEqual(left[0], 0)
        # Means 4/3 and 9; sum of products 2, of squares 2/3, of squared values 8.
        self.assertAlmostEqual(slopes[1], 3)
        self.assertAlmostEqual(constants[1], 5)
        self.assertAlmostEqual(left[1], 2)

    def test_the_minimum_of_a_parabola_in_logarithms_is_its_vertex(self):
        x = [1, 3, 20, 100]
        values = [math.exp((math.log10(a) - 0.7) ** 2) for a in x]
        self.assertAlmostEqual(log_minimum(x, values), 0.7)

    def test_the_minimum_at_an_end_is_that_point(self):
        self.assertEqual(log_minimum([1, 10, 100], [1, 2, 3]), 0)
        self.assertEqual(log_minimum([1, 10, 100], [3, 2, 1]), 2)

    def test_thickening_is_from_the_minimum_to_most_of_the_rise(self):
        # The vertex is at 10. ln rises from 0 to 3, and reaches 2.85 after 0.85 of the last decade.
        values = np.exp([2, 0, 2, 3])
        self.assertAlmostEqual(log_of_share([1, 10, 100, 1000], values, 0.95), 2.85)
        self.assertAlmostEqual(thickening_decades([1, 10, 100, 1000], values, 0.95), 1.85)
        # ln is 0.3 after 0.15 of the second decade, and 2.7 after 0.7 of the last.
        self.assertAlmostEqual(decades_of_rise([1, 10, 100, 1000], values), 1.55)

    def test_a_divergence_is_found_with_the_errors_that_redrawing_gives(self):
        fractions = np.array([0.3, 0.4, 0.45, 0.5, 0.55])
        values = diverging(fractions, 0.66, 1.6) * 1.4
        exact = divergence(fractions, [(v, 0.01 * v) for v in values], (1, 0.62, 2))
        for (found, _), true in zip(exact, (1.4, 0.66, 1.6)):
            self.assertAlmostEqual(found, true, delta=1e-4 * true)
        draws = np.random.default_rng(1).normal(values, 0.01 * values, (300, 5))
        for k, (_, error) in enumerate(exact):
            weighted = [
                divergence(fractions, [(v, 0.01 * w) for v, w in zip(d, values)], (1.4, 0.66, 1.6)) for d in draws
            ]
            self.assertAlmostEqual(np.std([w[k][0] for w in weighted]) / error, 1, delta=0.2)

    def test_a_divergence_that_is_none_has_wider_errors(self):
        fractions, bent = [0.3, 0.4, 0.5, 0.55, 0.57], [3, 6, 20, 30, 200]
        narrow, exact = (
            divergence(fractions, [(v, 0.01 * v) for v in values], (1, 0.6, 2))
            for values in (bent, diverging(np.array(fractions), 0.6, 2))
        )
        self.assertGreater(narrow[1][1], 3 * exact[1][1])

    def test_a_relaxing_viscosity_is_found_between_the_points_of_the_grid(self):
        times = np.geomspace(1e-3, 10, 200)
        viscosity, tau = fitted(times, 5 * (1 - np.exp(-times / 0.3)))
        self.assertAlmostEqual(tau, 0.3, delta=0.3 * math.log(10) / 8000)  # a hundredth of a step
        self.assertAlmostEqual(viscosity, 5, delta=0.001)

    def test_errors_of_that_fit_follow_the_scatter_of_the_seeds(self):
        times = np.geomspace(1e-3, 10, 200)
        scales = np.array([4.0, 5.0, 6.0, 5.0])
        (viscosity, _), (error, tau_error) = fit_with_errors(times, scales[:, None] * (1 - np.exp(-times / 0.3)))
        self.assertAlmostEqual(viscosity, 5, delta=0.05)
        self.assertAlmostEqual(error, estimate(scales)[1], delta=0.01)
        self.assertAlmostEqual(tau_error, 0)

    def test_errors_of_many_seeds_are_not_those_of_the_grid(self):
        times = np.geomspace(1e-3, 10, 200)
        taus = 0.3 + 0.015 * np.array([NormalDist().inv_cdf((k + 0.5) / 100) for k in range(100)])
        (_, tau), (_, error) = fit_with_errors(times, 1 - np.exp(-times / taus[:, None]))
        self.assertAlmostEqual(tau, 0.3, delta=0.002)
        self.assertAlmostEqual(error / estimate(taus)[1], 1, delta=0.1)


class Jamming(unittest.TestCase):
    def test_has_the_place_and_the_power_of_the_form(self):
        fractions = [0.4, 0.5, 0.55]
        jammed, exponent = jammed_and_exponent(fractions, [(1 - f / 0.6) ** -1.5 for f in fractions])
        self.assertAlmostEqual(jammed, 0.6)
        self.assertAlmostEqual(exponent, 1.5)


class Packings(unittest.TestCase):
    """The packing models, compared with the starting values printed in their papers."""

    RADII = 1, 1.4, 5, 7

    def shares(self, alpha):
        return ((1 - alpha) / 2,) * 2 + (alpha / 2,) * 2

    def test_a_group_alone_packs_as_given(self):
        for alpha, dense in ((0, 0.6), (1, 0.64)):
            self.assertAlmostEqual(linear_mixture(alpha, 0.2, 0.6, 0.64), dense)

    def test_small_spheres_that_fit_into_any_hole_take_no_place(self):
        # Ratio 0: 1 / phi = 1 / 0.64 less the small volume; the maximum is phi_m + phi_m (1 - phi_m).
        self.assertAlmostEqual(linear_mixture(0.9, 0, 0.64, 0.64), 0.64 / 0.9)
        best = 0.64 / (0.64 + 0.36 * 0.64)
        self.assertAlmostEqual(linear_mixture(best, 0, 0.64, 0.64), 0.64 + 0.36 * 0.64)

    def test_rods_of_one_size_have_the_gap_in_print(self):
        # Farr & Groot (2009): 0.7654 for 0.6435.
        self.assertAlmostEqual(gap_of((1,), (1,), 0.6435), 0.7654, delta=2e-4)
        self.assertAlmostEqual(rods((3,), (1,), 0.7654), 0.6435, delta=2e-4)

    def test_rods_do_not_care_for_units_nor_for_equal_species(self):
        one = rods(self.RADII, self.shares(0.5), 0.7654, 2000)
        self.assertAlmostEqual(rods([3 * r for r in self.RADII], self.shares(0.5), 0.7654, 2000), one, delta=1e-5)
        again = rods((*self.RADII, 7), (0.25, 0.25, 0.25, 0.125, 0.125), 0.7654, 2000)
        self.assertAlmostEqual(again, one, delta=1e-5)

    def test_chords_are_as_long_as_four_volumes_over_surface(self):
        # Cauchy: 4 V / S = 4 R / 3 for a sphere, and for all spheres together.
        numbers = [share / r**3 for share, r in zip(self.shares(0.5), self.RADII)]
        mean = 4 / 3 * sum(n * r**3 for n, r in zip(numbers, self.RADII))
        mean /= sum(n * r**2 for n, r in zip(numbers, self.RADII))
        self.assertAlmostEqual(rod_lengths(self.RADII, self.shares(0.5), 20000).mean(), mean, delta=1e-3)


class AtRest(unittest.TestCase):
    """Results at rest, from the study or from slow shear if the study lacks a row."""

    def rows(self, tables):
        with tempfile.TemporaryDirectory() as folder:
            for name, text in tables.items():
                os.mkdir(os.path.join(folder, name))
                with open(os.path.join(folder, name, "table.csv"), "w") as f:
                    f.write(text)
            with unittest.mock.patch("studies.at_rest.RESULTS", Path(folder)):
                return rows_at_rest()

    SLOW = (
        "method,count,fraction,peclet,seeds,pairs,pairs_error\n"
        "implicit,1000,0.45,0.046,16,5.5,0.4\nimplicit,1000,0.45,0.01,8,4.4,1.3\nimplicit,250,0.45,0.046,8,9,1\n"
        "explicit,1000,0.45,0.046,8,9,1\n"
    )
    EXACT = (
        "fraction,count,step,by,seeds,viscosity,viscosity_error\n0.5,100,automatic,momentum,60,15.25,0.5\n"
        "0.5,250,automatic,momentum,8,14,1\n0.5,100,half of it,momentum,60,15,0.25\n"
        "0.5,100,automatic,correlation,60,15,0.25\n0.4,100,automatic,momentum,60,4,0.25\n"
    )

    def test_is_of_linear_response_with_the_usual_step_and_less_the_solvent(self):
        rows, how = self.rows({"flow-curve": self.SLOW.replace("0.45", "0.5"), "at-rest": self.EXACT})
        self.assertEqual(how, "linear response")
        # 15.25 - 1 - 2.5 0.5; 4 - 1 - 2.5 0.4.
        self.assertEqual({f: (r["pairs"], r["pairs_error"]) for f, r in rows.items()}, {0.5: (13, 0.5), 0.4: (2, 0.25)})

    def test_is_of_slow_shear_at_the_lowest_known_peclet_number_elsewhere(self):
        rows, how = self.rows({"flow-curve": self.SLOW, "at-rest": self.EXACT})
        self.assertEqual(how, f"linear response; φ = 0.45: {SLOW_SHEAR}")
        self.assertEqual((rows[0.45]["pairs"], rows[0.45]["pairs_error"]), (5.5, 0.4))


class Published(unittest.TestCase):
    def test_fits_have_their_values(self):
        self.assertAlmostEqual(mari_fit(0.495, 0), 1.4 * 4**1.6)  # 1 - 0.75
        self.assertAlmostEqual(mari_fit(0.43125, 1), 0.71 * 4**2.3)
        self.assertAlmostEqual(diverging(0.75 * JAMMED_AT_REST, JAMMED_AT_REST), 8)


class Tables(unittest.TestCase):
    def test_errors_have_columns_of_their_own(self):
        self.assertEqual(columns_of("a", "b"), ["a", "a_error", "b", "b_error"])

    def test_lines_of_a_page(self):
        self.assertEqual(markdown_head(["a", "b"]), "| a | b |\n|---|---|")
        self.assertEqual(markdown_row(["x", "", 0]), "| x | | 0 |")
        self.assertEqual(number_text((1.25, 0.004), 2), "1.25 ± 0.00")


if __name__ == "__main__":
    unittest.main()
