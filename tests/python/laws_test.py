#!/usr/bin/python3
"""Fits of laws: exact points, independent fits, refusals, coverage of intervals, and the output of `peclet fit`."""
import json
import math
import sys
import unittest
from pathlib import Path

import numpy as np
from scipy.optimize import brentq, curve_fit, lsq_linear
from scipy.stats import chi2

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE.parents[1] / "python"), str(HERE)]
import laws_study
from peclet import laws, spectrum
from peclet.jamming import NotDetermined, fit_law
from peclet.laws_report import answer

FRACTIONS = np.array((0.50, 0.52, 0.54, 0.56, 0.58, 0.59, 0.60, 0.61, 0.62))
RATES = np.geomspace(0.01, 100, 12)
PLANE = [axis.ravel() for axis in np.meshgrid((0.50, 0.54, 0.56), (0.05, 0.1, 0.2, 0.4, 0.8, 2))]
VISCOUS = np.geomspace(0.001, 0.5, 10)


def divergence(x, phi_m=0.65, exponent=1.6, prefactor=1.4):
    return prefactor * (1 - x / phi_m) ** -exponent


def herschel_bulkley(x, yield_stress=2, consistency=5, flow_index=0.6):
    return yield_stress + consistency * x**flow_index


def cross(x, zero=20, infinite=3, time=2, exponent=0.8):
    return infinite + (zero - infinite) / (1 + (time * x) ** exponent)


def wyart_cates(fraction, stress, phi_0=0.65, phi_mu=0.58, onset=0.2, exponent=2, prefactor=1, sharpness=1):
    share = np.exp(-((onset / stress) ** sharpness))
    return prefactor * (1 - fraction / (share * phi_mu + (1 - share) * phi_0)) ** -exponent


def friction(x):
    """Boyer, Guazzelli & Pouliquen (2011), with their numbers."""
    return 0.32 + (0.7 - 0.32) / (1 + 0.005 / x) + x + 2.5 * 0.585 * np.sqrt(x)


class Case(unittest.TestCase):
    def assert_parameters(self, fit, expected, within=1e-5):
        for name, value in expected.items():
            number = {**fit.parameters, **fit.derived}[name]
            self.assertEqual(number.obstacle, "", name)
            self.assertAlmostEqual(number.value / value, 1, delta=within, msg=name)
            if number.interval:
                self.assertLess(number.interval[0], value)
                self.assertGreater(number.interval[1], value)


class ExactPoints(Case):
    """Points on a law give its parameters back."""

    def test_of_the_divergence(self):
        fit = laws.divergence(FRACTIONS, divergence(FRACTIONS), 0.01 * divergence(FRACTIONS), 16)
        self.assert_parameters(fit, {"phi_m": 0.65, "exponent": 1.6, "prefactor": 1.4})
        self.assertEqual(fit.degrees, 6)
        for end in fit.ends.values():
            self.assert_parameters(end, {"phi_m": 0.65, "exponent": 1.6, "prefactor": 1.4})
            self.assertEqual(end.degrees, 5)

    def test_of_herschel_and_bulkley(self):
        y = herschel_bulkley(RATES)
        fit = laws.herschel_bulkley(RATES, y, 0.02 * y, 8)
        self.assert_parameters(fit, {"yield_stress": 2, "consistency": 5, "flow_index": 0.6})
        self.assertRegex(fit.remarks[0], "^no point lies below the yield stress")

    def test_of_cross(self):
        fit = laws.cross(RATES, cross(RATES), 0.02 * cross(RATES), 8)
        expected = {"zero_rate_viscosity": 20, "infinite_rate_viscosity": 3, "time": 2, "exponent": 0.8}
        self.assert_parameters(fit, expected)

    def test_of_wyart_and_cates(self):
        y = wyart_cates(*PLANE)
        fit = laws.wyart_cates(*PLANE, y, 0.02 * y, 8)
        self.assert_parameters(fit, {"phi_0": 0.65, "phi_mu": 0.58, "onset_stress": 0.2})
        y = wyart_cates(*PLANE, 0.66, 0.57, 0.3, 1.7, 1.2, 1.3)
        fit = laws.wyart_cates(*PLANE, y, 0.002 * y, 8, free=["exponent", "prefactor", "sharpness"])
        expected = {"phi_0": 0.66, "phi_mu": 0.57, "onset_stress": 0.3, "exponent": 1.7, "prefactor": 1.2}
        self.assert_parameters(fit, expected | {"sharpness": 1.3}, 1e-4)

    def test_of_the_viscous_number(self):
        fraction, mu = 0.585 / (1 + np.sqrt(VISCOUS)), friction(VISCOUS)
        fit = laws.mu_of_j(fraction, VISCOUS, 0.01 * VISCOUS, mu, 0.01 * mu, 8)
        self.assert_parameters(fit, {"phi_m": 0.585, "mu_1": 0.32, "mu_2": 0.7, "I_0": 0.005})
        self.assertEqual(fit.degrees, 2 * 10 - 4)
        both = fit.curve(VISCOUS)[0]
        np.testing.assert_allclose(both, np.concatenate([mu, fraction]), rtol=1e-5)

    def test_of_given_parameters(self):
        fit = laws.divergence(FRACTIONS, divergence(FRACTIONS), 0.01 * divergence(FRACTIONS), 8, {"prefactor": 1.4})
        self.assert_parameters(fit, {"phi_m": 0.65, "exponent": 1.6})
        self.assertEqual(fit.parameters["prefactor"], laws.Number(1.4, 0.0, None))
        self.assertEqual(fit.degrees, 7)


class NoisyPoints(Case):
    def test_the_divergence_is_that_of_the_jamming_point(self):
        y = divergence(FRACTIONS) * np.exp(0.02 * np.random.default_rng(2).standard_normal(9))
        fit = laws.divergence(FRACTIONS, y, 0.02 * y, 8)
        law = fit_law([(phi, value, 0.02 * value, 8) for phi, value in zip(FRACTIONS, y)], FRACTIONS[-1])
        self.assertEqual(fit.parameters["phi_m"].value, law.phi_m[0])
        self.assertEqual(fit.parameters["exponent"].value, law.exponent[0])
        self.assertEqual(fit.chi_squared, law.chi_squared)
        # The profile of chi^2 and 400 redraws are two estimates of one interval.
        width, profile = np.diff(fit.parameters["phi_m"].interval)[0], np.diff(law.interval)[0]
        self.assertAlmostEqual(width / profile, 1, delta=0.2)

    def test_agree_with_another_minimiser_and_its_covariance(self):
        """For small errors redraws have the covariance of the normal equations, (J^T W J)^-1."""
        error = 0.004 * math.sqrt(7 / 5)  # c^2 of 8 seeds
        y = cross(RATES) * np.exp(error * np.random.default_rng(5).standard_normal(12))
        fit = laws.cross(RATES, y, 0.004 * y, 8, draws=2000)
        given = {"p0": (20, 3, 2, 0.8), "sigma": np.full(12, error), "absolute_sigma": True}
        best, covariance = curve_fit(lambda x, *p: np.log(cross(x, *p)), RATES, np.log(y), **given)
        # 8 seeds, 12 values and 4 parameters: the factor of estimated weights is 1 + 2/7 (1 - 4/12).
        wider = math.sqrt(max(1, fit.chi_squared / fit.degrees) * (1 + 2 / 7 * (1 - 4 / 12)))
        for number, value, variance in zip(fit.parameters.values(), best, np.diag(covariance)):
            self.assertAlmostEqual(number.value / value, 1, delta=1e-4)
            # A standard deviation of 2000 draws has an error of 1.6 %, the range of 68 % one of 2.4 %.
            self.assertAlmostEqual(number.standard_error / (wider * math.sqrt(variance)), 1, delta=0.1)
        residuals = (np.log(y) - np.log(cross(RATES, *best))) / error
        self.assertAlmostEqual(fit.chi_squared, residuals @ residuals, delta=1e-5)
        self.assertAlmostEqual(fit.p_value, chi2.sf(residuals @ residuals, 8), delta=1e-5)

    def test_give_the_same_numbers_again(self):
        y = cross(RATES) * np.exp(0.02 * np.random.default_rng(6).standard_normal(12))
        fits = [laws.cross(RATES, y, 0.02 * y, 8, seed=seed) for seed in (1, 1, 2)]
        self.assertEqual(fits[0].parameters, fits[1].parameters)
        self.assertNotEqual(fits[0].parameters, fits[2].parameters)
        self.assertEqual(fits[0].parameters["time"].value, fits[2].parameters["time"].value)

    def test_that_do_not_show_where_they_diverge_leave_all_parameters_open(self):
        # These contacts are too soft: no divergence describes the points.
        points = ((0.45, 8.612, 0.21), (0.5, 14.152, 0.268), (0.53, 17.922, 0.317), (0.56, 27.761, 0.962))
        fit = laws.divergence(*np.transpose([*points, (0.58, 42.275, 1.483)]), 8)
        self.assertIn("its interval reaches 1", fit.parameters["phi_m"].obstacle)
        for name in ("exponent", "prefactor"):
            self.assertIn("it depends on phi_m", fit.parameters[name].obstacle)

    def test_that_another_law_made_are_named(self):
        y = cross(RATES) * np.where(np.arange(12) % 2, 1.2, 1 / 1.2)
        fit = laws.cross(RATES, y, 0.01 * y, 8)
        self.assertLess(fit.p_value, 1e-6)
        self.assertRegex(fit.remarks[0], "^the law does not describe the points: chi.2 per degree of freedom is ")


class Thickening(Case):
    def test_is_discontinuous_where_the_rate_falls(self):
        """The rate sigma / eta falls over a range of stress from the derived phi on, and not below it."""
        y = wyart_cates(*PLANE)
        onset = laws.wyart_cates(*PLANE, y, 0.02 * y, 8).derived["discontinuous_from"].value
        stress = np.geomspace(1e-3, 1e3, 20001)

        def smallest_rise(phi):
            return np.diff(np.log(stress / wyart_cates(phi, stress))).min()

        self.assertAlmostEqual(onset, brentq(smallest_rise, 0.54, 0.5799), delta=1e-5)
        self.assertAlmostEqual(onset, laws_study.ONSET, delta=1e-5)

    def test_jammed_points_bound_the_law(self):
        y = wyart_cates(*PLANE)
        free = laws.wyart_cates(*PLANE, y, 0.02 * y, 8)
        bound = float(free.curve(0.575, np.array([10.0]))[0][0])
        satisfied = laws.wyart_cates(*PLANE, y, 0.02 * y, 8, [(0.575, 10, 0.1 * bound), (0.60, 10, 1e9)])
        self.assertEqual(satisfied.parameters, free.parameters)
        self.assertEqual(satisfied.degrees, free.degrees)
        moved = laws.wyart_cates(*PLANE, y, 0.02 * y, 8, [(0.575, 10, 1.5 * bound)])
        self.assertGreater(moved.curve(0.575, np.array([10.0]))[0][0], 1.02 * bound)
        self.assertGreater(moved.chi_squared, 1)
        self.assertEqual(free.curve(0.60, np.array([10.0]))[0][0], math.inf)


class Refusals(Case):
    def test_too_few_points(self):
        with self.assertRaisesRegex(NotDetermined, "^4 points with an error for 4 parameters: at least 5 are needed"):
            laws.cross(RATES[:4], cross(RATES[:4]), 0.02 * cross(RATES[:4]), 8)

    def test_a_yield_stress_that_the_points_do_not_bound(self):
        y = 5 * RATES**0.6
        fit = laws.herschel_bulkley(RATES, y, 0.03 * y, 8)
        self.assertRegex(fit.parameters["yield_stress"].obstacle, "^its interval reaches 0, .* it is at most 0.0")
        self.assertIsNone(fit.parameters["yield_stress"].value)

    def test_plateaus_that_no_point_is_near_and_what_depends_on_them(self):
        """A power law determines one combination of time and zero-rate viscosity."""
        y = 17 / RATES**0.8
        fit = laws.cross(RATES, y, 0.03 * y, 8)
        self.assertRegex(fit.parameters["infinite_rate_viscosity"].obstacle, "^its interval reaches")
        obstacles = [fit.parameters[name].obstacle for name in ("time", "zero_rate_viscosity")]
        self.assertTrue(any("the end of its search" in one for one in obstacles))
        self.assertTrue(all(obstacles))

    def test_arguments_that_are_no_points(self):
        y = cross(RATES)
        for wrong, said in (
            (lambda: laws.cross(RATES, y, 0.02 * y, 3), "^seeds: must be 4 or more"),
            (lambda: laws.cross(RATES, -y, 0.02 * y, 8), "^viscosity: must be a list of finite numbers > 0"),
            (lambda: laws.cross(RATES, y, 0 * y, 8), "^errors of viscosity: must be"),
            (lambda: laws.cross(RATES[1:], y, 0.02 * y, 8), "^rate: must be 12 numbers"),
            (lambda: laws.cross(RATES, y, 0.02 * y, 8, {"m": 1}), "is no parameter of cross; there are zero_rate"),
            (lambda: laws.cross(RATES, y, 0.02 * y, 8, {"exponent": 9}), "must be 0.1 to 6"),
        ):
            with self.assertRaisesRegex(ValueError, said):
                wrong()


class Spectra(Case):
    def moduli(self, frequency, modes=laws_study.MODES):
        x = frequency[:, None] * [time for _, time in modes]
        return (part @ [g for g, _ in modes] for part in (x * x / (1 + x * x), x / (1 + x * x)))

    def test_sums_of_exact_moduli(self):
        frequency = np.geomspace(0.01, 100, 20)
        storage, loss = self.moduli(frequency)
        loss = loss + 0.02 * frequency
        scale = 0.005 * np.hypot(storage, loss)
        fit = spectrum.maxwell_of_frequency(frequency, storage, scale, loss, scale, 16)
        expected = {"plateau_modulus": 6, "zero_shear_viscosity": 7.57, "infinite_frequency_viscosity": 0.02}
        self.assert_parameters(fit, expected, 0.02)
        time = np.geomspace(0.003, 40, 40)
        modulus = sum(g * np.exp(-time / tau) for g, tau in laws_study.MODES)
        fit = spectrum.maxwell_of_time(time, modulus, 0.01 + 0 * time, 16)
        self.assert_parameters(fit, {"plateau_modulus": 6, "zero_shear_viscosity": 7.55}, 0.02)

    def test_chi_squared_is_that_of_bounded_least_squares(self):
        generator, time = np.random.default_rng(4), np.geomspace(0.01, 30, 30)
        modulus = sum(g * np.exp(-time / tau) for g, tau in laws_study.MODES) + 0.05 * generator.standard_normal(30)
        fit = spectrum.maxwell_of_time(time, modulus, 0.05 + 0 * time, 8)
        error = 0.05 * math.sqrt(7 / 5)
        found = lsq_linear(np.exp(-time[:, None] / fit.times) / error, modulus / error, (0, np.inf), tol=1e-14)
        self.assertAlmostEqual(fit.chi_squared, 2 * found.cost, delta=1e-6 * found.cost)
        # The penalty adds one for each mode in use.
        residuals = (np.exp(-time[:, None] / fit.times) @ fit.weights - modulus) / error
        self.assertAlmostEqual(residuals @ residuals - fit.chi_squared, 30 - fit.degrees, delta=0.01)
        self.assertTrue((fit.weights >= 0).all())

    def test_a_viscosity_beyond_the_data_is_refused(self):
        frequency = np.geomspace(3, 100, 12)
        storage, loss = self.moduli(frequency, ((3, 0.05), (2, 0.7), (1, 50)))
        scale = 0.02 * np.hypot(storage, loss)
        fit = spectrum.maxwell_of_frequency(frequency, storage, scale, loss, scale, 8)
        self.assertRegex(fit.derived["zero_shear_viscosity"].obstacle, "comes from times beyond the data, above 0.3333")


class Coverage(unittest.TestCase):
    """Intervals of 8 seeds a point. Binomial bound at one in a thousand: 95 - 3.3 sqrt(95 5 / 200) = 95 - 5.1 %."""

    def test_intervals_hold_the_truth(self):
        for name in laws_study.LAWS:
            for row in laws_study.coverage(name, 8, 200):
                self.assertGreaterEqual(float(row["holds"]), 95 - 5.1, row)
                self.assertGreaterEqual(row["determined"], 190, row)


def point(value, mean, count=8, jammed=False, **more):
    settings = {"/peclet": value} | {"/" + key: number for key, number in more.items()}
    known = {"mean": None, "standard_error": None, "half_width": None}
    if mean is not None:
        known = {"mean": mean, "standard_error": 0.02 * abs(mean), "half_width": 0.05 * abs(mean)}
    label = f"peclet={value:g}"
    return {"label": label, "settings": settings, "count": count, "jammed": jammed, "state": "converged"} | known


def document(points, law="cross", **options):
    parameters = [{"pointer": key, "words": "", "symbol": "", "unit": ""} for key in points[0]["settings"]]
    quantity = {"path": "relative_viscosity", "name": "relative_viscosity", "element": "", "symbol": "η_r", "unit": ""}
    data = {"campaign": "flow", "quantities": [quantity], "parameters": parameters, "points": points}
    form = {"fixed": {}, "free": [], "from": None, "to": None, "json": False, "beside": ""}
    head = {"law": law, "campaign": "flow", "over": "/peclet", "quantities": [data]}
    return {**head, **form, **options}


POINTS = [point(x, cross(x)) for x in RATES]


class Answers(unittest.TestCase):
    def test_people_read_a_table(self):
        lines = answer(document([*POINTS, point(200, 3, count=3), point(300, None, jammed=True)]))["text"].splitlines()
        self.assertEqual(lines[0], "flow: relative_viscosity over /peclet, 1 curve")
        self.assertRegex(lines[4], r"^zero_rate_viscosity +20.00 ± 0.\d\d +1\d.\d\d to 2\d.\d\d +20.0")
        self.assertIn("chi^2/degrees 0.00/8 (p = 1), 12 of 14 points", lines)
        self.assertIn("left out, no error yet, 4 seeds with a value are needed: peclet=200", lines)
        self.assertIn("left out, jammed: peclet=300", lines)

    def test_programs_read_the_keys_that_the_page_of_the_schema_lists(self):
        read = json.loads(answer(document(POINTS, json=True))["text"])
        self.assertEqual((read["law"], read["quantities"], read["over"]), ("cross", ["relative_viscosity"], "/peclet"))
        law = read["curves"][0]["law"]
        self.assertAlmostEqual(law["parameters"]["time"]["value"], 2, delta=1e-5)
        self.assertEqual(set(law["parameters"]["time"]), {"value", "standard_error", "interval", "obstacle"})
        self.assertEqual(law["degrees"], 8)
        self.assertEqual(set(law["ends"]), {"without the lowest", "without the highest"})

    def test_each_curve_has_its_law(self):
        points = [
            point(x, factor * cross(x), volume_fraction=phi) for phi, factor in ((0.4, 1), (0.5, 2)) for x in RATES
        ]
        read = json.loads(answer(document(points, json=True))["text"])
        viscosities = [c["law"]["parameters"]["zero_rate_viscosity"]["value"] for c in read["curves"]]
        np.testing.assert_allclose(viscosities, [20, 40], rtol=1e-5)
        self.assertEqual(
            [c["settings"] for c in read["curves"]], [{"/volume_fraction": 0.4}, {"/volume_fraction": 0.5}]
        )
        figure = answer(document(points))["figure"]
        self.assertEqual(len(figure["panels"][0]["lines"]), 2)

    def test_the_range_of_the_axis_is_chosen(self):
        read = json.loads(answer(document(POINTS, json=True, **{"from": 0.02, "to": 50}))["text"])
        self.assertEqual(len(read["curves"][0]["points"]), sum((RATES >= 0.02) & (RATES <= 50)))

    def test_a_viscosity_times_the_rate_is_a_stress(self):
        points = [point(x, herschel_bulkley(x) / x) for x in RATES]
        read = json.loads(answer(document(points, "herschel-bulkley", json=True))["text"])
        self.assertAlmostEqual(read["curves"][0]["law"]["parameters"]["yield_stress"]["value"], 2, delta=1e-5)

    def test_curves_that_are_not_determined_say_why(self):
        text = answer(document(POINTS[:4]))["text"]
        self.assertIn("not determined, 4 points with an error for 4 parameters: at least 5 are needed", text)
        self.assertIsNone(answer(document(POINTS[:4]))["figure"])

    def test_refusals_name_the_option(self):
        refused = answer(document(POINTS, fixed={"m": 2}))["refused"]
        self.assertEqual(refused[:2], ("--fix", "m=2"))
        self.assertEqual(answer(document(POINTS, free=["m"]))["refused"][:2], ("--free", "m"))
        beside = answer(document(POINTS, "wyart-cates", beside="/flow/stress"))["refused"]
        self.assertRegex(beside[2], "the sweep must have /flow/stress")


if __name__ == "__main__":
    unittest.main()
