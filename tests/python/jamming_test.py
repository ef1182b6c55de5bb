#!/usr/bin/python3
"""Fits of the jamming point: exact points, refusals, coverage of intervals, and proposals."""
import collections
import json
import math
import sys
import unittest
from pathlib import Path

import numpy as np
from scipy.stats import t as student

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "python"))
from peclet.jamming import (
    NotDetermined,
    Refused,
    added_to_sweep,
    estimate_all,
    find_steepest,
    fit_common_law,
    fit_law,
    next_fraction,
    propose,
)
from peclet.jamming_report import answer

DENSE = (0.50, 0.52, 0.54, 0.56, 0.58, 0.59, 0.60, 0.61, 0.62)
GRID = (0.45, 0.50, 0.54, 0.57, 0.60, 0.62, 0.66)


class Truth(collections.namedtuple("Truth", "fraction exponent prefactor", defaults=(0.65, 1.6, 1.4))):
    def at(self, phi):
        return self.prefactor * (1 - phi / self.fraction) ** -self.exponent

    def exact(self, fractions=DENSE, relative=0.01):
        return [(phi, self.at(phi), relative * self.at(phi), 16) for phi in fractions]


def refusal(function, *arguments, **options):
    try:
        function(*arguments, **options)
    except NotDetermined as why:
        return str(why)
    return ""


def scattered(truth, points, chi_squared):
    """Returns the points with residuals in ln eta of this chi^2. The residuals are a zigzag without its part
    along g, 1 and x (see the normal equations), so that least squares finds the same law."""
    phi = np.array([point[0] for point in points])
    gap = truth.fraction - phi
    columns = np.stack([-truth.exponent * phi / (truth.fraction * gap), np.ones(len(phi)), -np.log(gap)], axis=1)
    zigzag = (-1.0) ** np.arange(len(phi))
    residuals = zigzag - columns @ np.linalg.lstsq(columns, zigzag, rcond=None)[0]
    s = points[0][2] / points[0][1] * math.sqrt(15 / 13)  # standard deviation of Student's t of 15 degrees
    residuals *= s * math.sqrt(chi_squared / (residuals @ residuals))
    return [(p[0], p[1] * math.exp(r), *p[2:]) for p, r in zip(points, residuals)]


class TheLaw(unittest.TestCase):
    def assert_near(self, numbers, expected, within):
        for number, wanted in zip(numbers, expected):
            self.assertAlmostEqual(number, wanted, delta=within)

    def test_exact_points_give_it_back(self):
        for truth in (Truth(), Truth(0.587, 1.5, 1), Truth(0.575, 2.3, 0.71), Truth(0.78, 2, 3)):
            fractions = [share * truth.fraction for share in (0.75, 0.8, 0.85, 0.9, 0.93, 0.96)]
            law = fit_law(truth.exact(fractions), fractions[-1])
            self.assert_near([law.phi_m[0], law.exponent[0], law.prefactor[0]], truth, 1e-6)
            self.assertLess(law.chi_squared, 1e-8)
            self.assertEqual(law.degrees, 3)

    def test_a_given_exponent_and_prefactor_are_kept(self):
        points = Truth(0.642, 1.5, 1).exact()
        for exponent, unit, degrees in ((1.5, False, 7), (None, True, 7), (1.5, True, 8)):
            law = fit_law(points, 0.62, exponent, unit)
            self.assert_near([law.phi_m[0], law.exponent[0], law.prefactor[0]], (0.642, 1.5, 1), 1e-6)
            self.assertEqual((law.exponent[1] == 0, law.prefactor[1] == 0), (exponent is not None, unit))
            self.assertEqual(law.degrees, degrees)
        # Another exponent shifts the divergence, and chi^2 shows that the points do not follow it.
        steeper = fit_law(points, 0.62, 3)
        self.assertGreater(steeper.phi_m[0], 0.66)
        self.assertGreater(steeper.chi_squared / steeper.degrees, 4)

    def test_small_errors_are_those_of_the_normal_equations(self):
        """For small errors the profile is a parabola. With the columns g = -beta phi / (phi_m (phi_m - phi)),
        1 and x the covariance is (J^T W J)^-1."""
        truth, phi = Truth(), np.array(DENSE)
        gap = truth.fraction - phi
        jacobian = np.stack([-truth.exponent * phi / (truth.fraction * gap), np.ones(9), -np.log(gap / truth.fraction)])
        expected = np.sqrt(np.diag(np.linalg.inv(jacobian @ jacobian.T / (1e-8 * 15 / 13))))
        law = fit_law(truth.exact(relative=1e-4), 0.62)
        errors = law.phi_m[1], law.prefactor[1] / truth.prefactor, law.exponent[1]
        self.assert_near(errors / expected, (1, 1, 1), 0.01)
        self.assert_near([(law.interval[1] - law.interval[0]) / (2 * 1.96 * expected[0])], [1], 0.01)

    def test_scatter_of_three_times_the_errors_gives_three_times_the_errors(self):
        truth = Truth()
        smooth = truth.exact(relative=1e-4)
        alone, law = fit_law(smooth, 0.62), fit_law(scattered(truth, smooth, 9 * 6), 0.62)
        self.assert_near([law.chi_squared / law.degrees], [9], 0.05)
        for name in ("phi_m", "exponent", "prefactor"):
            self.assert_near([getattr(law, name)[1] / getattr(alone, name)[1]], [3], 0.05)
        self.assert_near([np.diff(law.interval)[0] / np.diff(alone.interval)[0]], [3], 0.05)

    def test_is_refused_where_the_points_do_not_bound_it(self):
        truth = Truth()
        self.assertEqual(refusal(fit_law, truth.exact(DENSE[:3]), 0.60), "3 of the 4 points that a fit needs")
        # Far from jamming and with errors of 10 % any phi_m fits.
        far = refusal(fit_law, truth.exact((0.40, 0.42, 0.44, 0.46), 0.1), 0.46)
        self.assertRegex(far, "^the points do not bound it from above")
        # A flowing point lies beyond the divergence of the others.
        beyond = refusal(fit_law, truth.exact(), 0.66)
        self.assertRegex(beyond, "^the points rise more steeply than any power law that diverges above 0.66, which")
        falling = [(phi, 100 / value, 1 / value, 16) for phi, value, _, _ in truth.exact()]
        self.assertTrue(refusal(fit_law, falling, 0.62))


def sampled(generator, mean, seeds, deviation=0.06):
    """Returns mean, standard error and number of seeds with this relative standard deviation."""
    values = mean * (1 + deviation * generator.standard_normal(seeds))
    return values.mean(), values.std(ddof=1) / math.sqrt(seeds), seeds


def until_known(generator, mean):
    """Samples 8, 10, 12 ... 64 seeds until the 95 % interval is narrower than 3 %. Points with a small sample
    spread by chance get fewer seeds."""
    values = mean * (1 + 0.06 * generator.standard_normal(64))
    for seeds in range(8, 65, 2):
        own = values[:seeds]
        error = own.std(ddof=1) / math.sqrt(seeds)
        if student.ppf(0.975, seeds - 1) * error <= 0.03 * own.mean():
            break
    return own.mean(), error, seeds


class Coverage(unittest.TestCase):
    """Coverage of intervals from points whose spread is estimated from their seeds."""

    def coverage(self, point_of, curves=1000):
        """Returns the shares of intervals and of standard errors that contain the truth; refuses no curve."""
        truth, generator = Truth(), np.random.default_rng(20)
        held = within = 0
        for _ in range(curves):
            law = fit_law([(phi, *point_of(generator, truth.at(phi))) for phi in DENSE], DENSE[-1])
            held += law.interval[0] <= truth.fraction <= law.interval[1]
            within += abs(law.phi_m[0] - truth.fraction) <= law.phi_m[1]
        return held / curves, within / curves

    # Binomial bounds at a probability of one in a thousand: 0.95 ± 3.3 sqrt(0.95 0.05 / 1000) = ± 0.023, and
    # 0.683 ± 0.049 for one standard error. The factor max(1, chi^2 / degrees) adds up to 0.01 and 0.05.
    def test_of_eight_seeds(self):
        held, within = self.coverage(lambda generator, mean: sampled(generator, mean, 8))
        self.assertTrue(0.95 - 0.023 <= held <= 0.95 + 0.033, held)
        self.assertTrue(0.683 - 0.049 <= within <= 0.683 + 0.099, within)

    # Without a correction for the uncertain spread of four seeds the coverage is 88 %.
    def test_of_four_seeds(self):
        self.assertGreaterEqual(self.coverage(lambda generator, mean: sampled(generator, mean, 4))[0], 0.95 - 0.023)

    def test_of_seeds_that_a_stop_rule_has_chosen(self):
        held, within = self.coverage(until_known)
        self.assertGreaterEqual(held, 0.95 - 0.023)
        self.assertGreaterEqual(within, 0.683 - 0.049)

    # 4 curves in 100 campaigns have errors correlated by the exponent. The bounds are those of 100
    # independent ones: 0.95 - 3.3 sqrt(0.95 0.05 / 100) and 0.683 - 3.3 sqrt(0.22 / 100).
    def test_of_a_common_exponent(self):
        generator = np.random.default_rng(21)
        held = within = exponents = 0
        for _ in range(100):
            curves = [
                ([(p[0], *sampled(generator, p[1], 6, 0.04)) for p in points], flowing)
                for points, flowing in ALL_CURVES
            ]
            common, laws = fit_common_law(curves)
            exponents += abs(common.exponent[0] - 1.8) <= 1.96 * common.exponent[1]
            for truth, law in zip(TRUTHS, laws):
                held += law.interval[0] <= truth.fraction <= law.interval[1]
                within += abs(law.phi_m[0] - truth.fraction) <= law.phi_m[1]
        self.assertGreaterEqual(exponents / 100, 0.95 - 0.072)
        self.assertGreaterEqual(held / 400, 0.95 - 0.072)
        self.assertTrue(0.683 - 0.155 <= within / 400 <= 0.683 + 0.155, within / 400)


TRUTHS = [Truth(fraction, 1.8, prefactor) for fraction, prefactor in ((0.58, 0.7), (0.64, 1.4), (0.71, 1), (0.76, 3))]


def curve_of(truth, relative=0.01):
    fractions = [share * truth.fraction for share in (0.80, 0.86, 0.91, 0.94, 0.96)]
    return truth.exact(fractions, relative), fractions[-1]


ALL_CURVES = [curve_of(truth) for truth in TRUTHS]


class ACommonExponent(unittest.TestCase):
    def test_exact_points_give_the_laws_back(self):
        common, laws = fit_common_law(ALL_CURVES)
        self.assertAlmostEqual(common.exponent[0], 1.8, delta=1e-4)
        self.assertEqual((common.curves, common.degrees), (4, 4 * (5 - 2) - 1))
        self.assertLess(common.chi_squared, 1e-6)
        for truth, law in zip(TRUTHS, laws):
            self.assertAlmostEqual(law.phi_m[0], truth.fraction, delta=1e-5)
            self.assertAlmostEqual(law.prefactor[0], truth.prefactor, delta=1e-3)
            self.assertEqual(law.exponent, common.exponent)

    def test_many_curves_know_it_better_than_one(self):
        """Equal curves determine the exponent like one curve with more seeds: its error falls as the root of
        their number. Each phi_m keeps the larger part of its error, and is known better than with an exponent
        of its own:
            var(phi_m) = var given beta + (d phi_m / d beta)^2 var(beta),
        whose second term is a ninth of its value for one curve."""
        points, flowing = curve_of(Truth(0.64, 1.8, 1.4), 1e-4)
        alone, (common, laws) = fit_law(points, flowing), fit_common_law([(points, flowing)] * 9)
        self.assertAlmostEqual(alone.exponent[1] / common.exponent[1], 3, delta=0.1)
        known, own = fit_law(points, flowing, 1.8).phi_m[1], alone.phi_m[1]
        expected = math.sqrt(known**2 + (own**2 - known**2) / 9)
        self.assertAlmostEqual(laws[0].phi_m[1] / expected, 1, delta=0.02)

    def test_scatter_of_three_times_the_errors_gives_three_times_its_error(self):
        truth = Truth()
        smooth, degrees = truth.exact(relative=1e-4), 2 * (9 - 2) - 1
        alone, _ = fit_common_law([(smooth, 0.62)] * 2)
        common, _ = fit_common_law([(scattered(truth, smooth, 9 * degrees / 2), 0.62)] * 2)
        self.assertAlmostEqual(common.exponent[1] / alone.exponent[1], 3, delta=0.05)

    def test_it_is_said_that_it_does_not_describe_unlike_curves(self):
        common, _ = fit_common_law([*ALL_CURVES, curve_of(Truth(0.62, 2.6, 1))])
        self.assertGreater(common.chi_squared, 3 * common.degrees)

    def test_curves_that_no_exponent_describes_take_no_part(self):
        falling = [(phi, 100 / value, error, count) for phi, value, error, count in ALL_CURVES[0][0]]
        falling = falling, ALL_CURVES[0][1]
        common, laws = fit_common_law([falling, *ALL_CURVES])
        self.assertEqual(common.curves, 4)
        self.assertIsInstance(laws[0], NotDetermined)
        self.assertAlmostEqual(laws[1].phi_m[0], TRUTHS[0].fraction, delta=1e-5)
        why, laws = fit_common_law([ALL_CURVES[0], falling])
        self.assertEqual(str(why), "no exponent from 0.25 to 6 describes two curves or more together")
        self.assertEqual(laws, [why, why])

    # With errors of half the value the steepest exponent fits as well as the true one.
    def test_is_refused_where_the_points_do_not_bound_it(self):
        why, laws = fit_common_law([curve_of(truth, 0.5) for truth in TRUTHS[:2]])
        self.assertRegex(str(why), "^the points do not bound the common exponent: smaller errors, or points nearer")
        self.assertEqual(laws, [why, why])


class TheSteepestRise(unittest.TestCase):
    def step(self, middle, error):
        """Returns a smooth step of height 100 at `middle`, with a fixed error."""
        fractions = [0.5 + 0.005 * i for i in range(21)]
        return [(phi, 20 + 50 * (1 + math.tanh((phi - middle) / 0.004)), error, 8) for phi in fractions]

    def test_is_the_middle_of_the_step_with_the_error_of_the_grid(self):
        found = find_steepest(self.step(0.5275, 0.01))
        self.assertAlmostEqual(found.phi_m[0], 0.5275, delta=1e-12)
        self.assertAlmostEqual(found.width, 0.005, delta=1e-12)
        self.assertAlmostEqual(found.phi_m[1], 0.005 / math.sqrt(12), delta=1e-9)
        self.assertFalse(found.to_jammed)

    def test_errors_of_the_values_make_it_wider(self):
        """Midway between two intervals both have equal slopes, so a draw picks the other one half of the
        time. The mean square is spacing^2 / 2, within five times its error, sqrt(0.25 / 2000)."""
        found = find_steepest(self.step(0.53, 2))
        squares = (found.phi_m[1] / 0.005) ** 2 - 1 / 12
        self.assertAlmostEqual(squares, 0.5, delta=5 * math.sqrt(0.25 / 2000))
        self.assertEqual(find_steepest(self.step(0.53, 2)), found)

    def test_a_rise_up_to_the_last_point_is_bounded_by_what_is_jammed(self):
        points = [(phi, (1 - phi / 0.64) ** -2, 0.1, 8) for phi in (0.5, 0.55, 0.6)]
        self.assertEqual(refusal(find_steepest, points), "the viscosity rises most steeply up to the last point")
        found = find_steepest(points, 0.66)
        self.assertTrue(found.to_jammed)
        self.assertAlmostEqual(found.phi_m[0], 0.63, delta=1e-12)
        self.assertAlmostEqual(found.phi_m[1], 0.06 / math.sqrt(12), delta=1e-12)
        self.assertEqual(refusal(find_steepest, points[:2], 0.66), "2 of the 3 points that it needs")


def point(phi, state="flowing", mean=None, relative=0.01, **more):
    """Returns a point of a curve in the program's format."""
    numbers = {"mean": mean, "standard_error": mean and relative * mean, "count": 8 if mean else 0}
    seeds = {"seeds": 8, "jammed": 8 if state == "jammed" else 0, "cpu_seconds": 10}
    overlaps = {"overlap": 1e-4 if mean else None, "largest_overlap": 5e-3 if mean else None}
    return {"label": f"{phi}", "fraction": phi, "state": state, **numbers, **seeds, **overlaps, **more}


def curve(points, name="", settings=()):
    return {"name": name, "settings": dict(settings), "points": points}


def law_and_jam(truth=Truth()):
    """Returns six points of the law and a jammed one."""
    return [*(point(phi, mean=truth.at(phi)) for phi in GRID[:-1]), point(GRID[-1], "jammed")]


LAW_KEYS = {"phi_m", "interval", "exponent", "prefactor", "chi_squared", "degrees"}


def one_estimate(points, **options):
    return estimate_all([curve(points)], **options)[0][0]


def said(estimate):
    return "\n".join(f"{place}: {what}" for what, place in estimate.remarks)


class Estimates(unittest.TestCase):
    def test_each_curve_gives_its_law_back(self):
        truths = Truth(0.65, 1.6, 1.4), Truth(0.63, 2.1, 1.2)
        made, _ = estimate_all([curve(law_and_jam(truth)) for truth in truths])
        for truth, found in zip(truths, made):
            self.assertEqual((found.flowing, found.largest_flowing), (6, 0.62))
            self.assertEqual(found.smallest_stuck["fraction"], 0.66)
            self.assertAlmostEqual(found.law.phi_m[0], truth.fraction, delta=1e-6)
            self.assertTrue(found.steepest.to_jammed)
            self.assertAlmostEqual(found.steepest.phi_m[0], 0.64, delta=1e-12)
            self.assertEqual(found.remarks, [])

    def test_the_law_is_of_flowing_points_above_the_bound(self):
        # 1.4 (1 - 0.45 / 0.65)^-1.6 = 9.22 is below 10; 0.50 gives 14.6.
        self.assertEqual(len(one_estimate(law_and_jam()).fitted), 5)
        self.assertEqual(len(one_estimate(law_and_jam(), above=9).fitted), 6)
        few = "3 of the 4 flowing points with a viscosity above 25 that it needs"
        self.assertEqual(str(one_estimate(law_and_jam(), above=25).law), few)

    def test_points_that_do_not_flow_are_no_part_of_the_law(self):
        truth = Truth()
        found = one_estimate(
            [
                point(0.45, mean=truth.at(0.45)),
                point(0.50, mean=truth.at(0.50)),
                point(0.54, "soft", mean=1000, overlap=0.0011),  # far from the law
                point(0.57, "jammed"),
                point(0.60, "partly jammed", mean=50, jammed=1),
                point(0.62, "lost"),
                point(0.66, "open"),
            ]
        )
        self.assertEqual(len(found.fitted), 1)
        self.assertEqual(found.smallest_stuck["fraction"], 0.54)
        self.assertIn("0.54 (overlap 0.0011): left out, soft, a larger", said(found))
        self.assertIn("0.6 (1 of 8): left out, some seeds jammed", said(found))
        self.assertIn("0.62: left out, half of the seeds or more were lost", said(found))
        self.assertIn("0.66: left out, no seed has ended yet", said(found))
        self.assertNotIn("0.57", said(found))  # jammed points have a column
        largest = point(0.5, "soft", mean=20, overlap=None, largest_overlap=0.0101)
        self.assertIn("0.5 (overlap 0.01 at most): left out, soft", said(one_estimate([largest])))

    # A volume fraction at which some seeds flow is below phi_m.
    def test_a_point_needs_four_seeds_and_a_spread(self):
        found = one_estimate([point(0.62, mean=50, count=3)])
        self.assertEqual((found.flowing, found.largest_flowing, found.fitted), (1, 0.62, []))
        self.assertIn("0.62 (3): left out, no error yet, 4 seeds with a value are needed", said(found))

    def test_contradictions_are_said(self):
        above = one_estimate(law_and_jam(Truth(0.70, 1.6, 1.4)))
        self.assertIn("0.66: the law diverges above a fraction that is jammed", said(above))
        mixed = [point(phi, mean=10 + k) for k, phi in enumerate(GRID[:-1])]
        mixed[3] = point(0.57, "jammed")
        self.assertIn("0.57 (below 0.62): jammed, although a larger fraction flows", said(one_estimate(mixed)))

    def test_one_exponent_for_all_curves(self):
        truths = Truth(0.70, 1.9, 1.2), Truth(0.68, 1.9, 1.2)
        curves = [curve([point(phi, mean=truth.at(phi)) for phi in GRID]) for truth in truths]
        made, common = estimate_all([*curves, curve([point(phi, "open") for phi in GRID])], common_exponent=True)
        self.assertAlmostEqual(common.exponent[0], 1.9, delta=1e-3)
        self.assertEqual(common.curves, 2)
        for truth, found in zip(truths, made):
            self.assertAlmostEqual(found.law.phi_m[0], truth.fraction, delta=1e-4)
        self.assertEqual(str(made[2].law), "0 of the 4 flowing points with a viscosity above 10 that it needs")


def flowing_and_jammed(flowing, jammed, truth=Truth()):
    flows = [point(phi, mean=truth.at(phi), count=16) for phi in flowing]
    return one_estimate([*flows, *(point(phi, "jammed") for phi in jammed)])


class Proposals(unittest.TestCase):
    def assert_next(self, estimate, proposed, expected):
        self.assertAlmostEqual(next_fraction(estimate, proposed)[0], expected, delta=1e-12)

    def test_halve_what_is_between_flowing_and_jammed(self):
        estimate = flowing_and_jammed([0.56, 0.60], [0.66, 0.70])
        self.assert_next(estimate, [], 0.63)
        # The widest remaining gap, the lower one first.
        self.assert_next(estimate, [0.63], 0.615)
        self.assert_next(estimate, [0.63, 0.615], 0.645)

    def test_go_on_where_all_flows_or_nothing_does(self):
        self.assert_next(flowing_and_jammed([0.40, 0.42], []), [], 0.44)
        self.assert_next(flowing_and_jammed([0.40, 0.42], []), [0.44], 0.46)
        self.assert_next(flowing_and_jammed([], [0.66, 0.70]), [], 0.64)
        self.assertIsNone(next_fraction(flowing_and_jammed([], [0.01])))

    def test_lessen_the_error_of_the_law_most(self):
        """Compares with the best fraction by trial: fits with a further point of equal error."""
        flowing = [0.50, 0.53, 0.56, 0.58, 0.60]
        found, _ = next_fraction(flowing_and_jammed(flowing, [0.66]))

        def error_with(phi):
            return fit_law(Truth().exact([*flowing, phi], 1e-4), max(0.60, phi)).phi_m[1]

        # The proposal is at most midway between 0.60 and 0.65.
        self.assertLessEqual(found, 0.625 + 1e-9)
        for phi in np.arange(0.502, 0.6245, 0.004):
            self.assertLessEqual(error_with(found), 1.001 * error_with(phi), phi)
        self.assertLess(error_with(found), 0.6 * error_with(0.55))

    def test_are_as_many_as_the_budget_pays(self):
        estimates = [flowing_and_jammed([0.5, 0.6], [0.66]), flowing_and_jammed([0.4, 0.5], [0.60])]
        points, cost, _ = propose(estimates)
        self.assertEqual([phi for phi, _ in points], [0.63, 0.55])  # one per curve
        self.assertEqual(cost, 20)  # the most expensive point of both curves
        self.assertEqual(len(propose(estimates, 79)[0]), 3)
        self.assertLessEqual(len(propose(estimates, 1e9)[0]), 20)
        points, _, obstacle = propose(estimates, 19)
        self.assertEqual(points, [])
        self.assertIn("more than the budget", obstacle)

    def test_change_the_entry_of_the_sweep(self):
        sweep = [{"set": "/peclet", "values": [1, 10]}, {"set": "/volume_fraction", "values": [0.5, 0.6]}]
        patch, changed = added_to_sweep(sweep, "/volume_fraction", [0.63, 0.55])
        values = [0.5, 0.6, 0.63, 0.55]  # the file may have a range there, to which no value can be added
        self.assertEqual(patch, [{"op": "replace", "path": "/sweep/1/values", "value": values}])
        self.assertEqual(changed, [sweep[0], {"set": "/volume_fraction", "values": values}])
        listed = [{"set": ["/volume_fraction"], "values": [[0.5]]}]
        self.assertEqual(added_to_sweep(listed, "/volume_fraction", [0.63])[1][0]["values"], [[0.5], [0.63]])
        in_step = [{"set": ["/volume_fraction", "/particles/count"], "values": [[0.5, 100]]}]
        with self.assertRaisesRegex(Refused, "/sweep/0/set.*add the rows by hand"):
            added_to_sweep(in_step, "/volume_fraction", [0.63])


class Answers(unittest.TestCase):
    def document(self, curves, **options):
        head = {"campaign": "jam", "quantity": "relative_viscosity", "over": "/volume_fraction", "softest": 0.001}
        form = {"by": "", "exponent": None, "common_exponent": False, "unit_prefactor": False, "above": 10}
        rest = {"propose": False, "budget": None, "json": False, "sweep": []}
        return {**head, **form, **rest, "curves": curves, **options}

    def text(self, curves, **options):
        return answer(self.document(curves, **options))["text"]

    def test_people_read_a_table(self):
        lines = self.text([curve(law_and_jam())]).splitlines()
        self.assertEqual(lines[0], "jam: relative_viscosity over /volume_fraction, 1 curve")
        self.assertRegex(lines[3], r"^ +6   0.62  0.66 jammed  0.6500 ± 0.00\d+  0.6\d+ to 0.6\d+  1.600 ± 0.0\d+ ")
        self.assertRegex(lines[3], r"0.00/2 +0.640 ± 0.012 \*$")
        self.assertEqual(lines[-1], "does: sweep the stiffness.")
        self.assertNotIn("steepest", self.text([curve(law_and_jam())], by="law"))

    def test_what_is_true_of_many_curves_is_told_once(self):
        soft = [point(phi, "soft", mean=9.2, overlap=0.002) for phi in GRID[:2]]
        curves = [
            curve([*soft, *(point(phi, "open") for phi in GRID[2:])], "μ = 0"),
            curve([{**soft[0], "overlap": 0.003}, *(point(phi, "open") for phi in GRID[1:])], "μ = 0.5"),
            curve([point(phi, "open") for phi in GRID], "μ = 1"),
        ]
        table = self.text(curves)
        self.assertIn(
            "phi_m by law is not determined, 0 of the 4 flowing points with a viscosity above 10 that it needs:\n"
            "every curve\n",
            table,
        )
        self.assertIn(
            "left out, soft, a larger normal_stiffness makes spheres harder:\n"
            "  μ = 0: 0.45 (overlap 0.002), 0.5 (overlap 0.002)\n  μ = 0.5: 0.45 (overlap 0.003)\n",
            table,
        )

    def test_the_common_exponent_is_told(self):
        truths = Truth(0.70, 1.9, 1.2), Truth(0.68, 1.9, 1.2)
        curves = [curve([point(phi, mean=t.at(phi)) for phi in GRID], f"{k}") for k, t in enumerate(truths)]
        self.assertRegex(self.text(curves, common_exponent=True), "\nexponent: common to 2 curves, 1.900?0? ± ")

    def test_programs_read_the_keys_that_the_page_of_the_schema_lists(self):
        read = json.loads(self.text([curve(law_and_jam())], json=True))["curves"][0]
        self.assertEqual(read["smallest_stuck"], {"fraction": 0.66, "state": "jammed"})
        self.assertEqual(set(read["law"]), {*LAW_KEYS, "obstacle"})
        self.assertEqual(set(read["steepest"]), {"phi_m", "width", "to_jammed", "obstacle"})
        self.assertEqual([one["fitted"] for one in read["points"]], [False, *[True] * 5, False])
        self.assertIsNone(read["law"]["obstacle"])
        without = json.loads(self.text([curve(law_and_jam())], json=True, above=25, by="law"))["curves"][0]
        self.assertEqual(without["law"]["phi_m"], None)
        self.assertNotIn("steepest", without)

    def test_refusals_name_the_place(self):
        sweep = [{"set": ["/volume_fraction", "/count"], "values": [[0.5, 100]]}]
        refused = answer(self.document([curve(law_and_jam())], propose=True, sweep=sweep))["refused"]
        self.assertEqual(refused[:2], ("/sweep/0/set", '["/volume_fraction","/count"]'))


if __name__ == "__main__":
    unittest.main()
