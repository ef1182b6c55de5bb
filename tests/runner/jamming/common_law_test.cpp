// One exponent for several curves: exact points, refusals, and how often its intervals hold the truth.
#include "runner/jamming/common_law.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "runner/statistics/statistics.h"

namespace peclet::runner {
namespace {

struct CommonTruth {
  double fraction, prefactor, exponent = 1.8;
  double at(double phi) const { return prefactor * std::pow(1 - phi / fraction, -exponent); }
};

const std::vector<CommonTruth> truths{{0.58, 0.7}, {0.64, 1.4}, {0.71, 1.0}, {0.76, 3.0}};
const std::vector<double> shares{0.80, 0.86, 0.91, 0.94, 0.96};

LawCurve exact(const CommonTruth& truth, double relative = 0.01) {
  LawCurve curve{{}, shares.back() * truth.fraction};
  for (const double share : shares) {
    const double phi = share * truth.fraction;
    curve.points.push_back({phi, truth.at(phi), relative * truth.at(phi), 16});
  }
  return curve;
}

std::vector<LawCurve> all_exact(double relative = 0.01) {
  std::vector<LawCurve> curves;
  curves.reserve(truths.size());
  for (const CommonTruth& truth : truths) curves.push_back(exact(truth, relative));
  return curves;
}

TEST(CommonLaw, ExactPointsGiveTheLawsBack) {
  const CommonAnswer answer = fit_common_law(all_exact(), {});
  ASSERT_TRUE(answer.common) << answer.obstacle;
  EXPECT_NEAR(answer.common->exponent.value, 1.8, 1e-4);
  EXPECT_EQ(answer.common->curves, 4);
  EXPECT_EQ(answer.common->degrees, 4 * (5 - 2) - 1);
  EXPECT_LT(answer.common->chi_squared, 1e-6);
  for (std::size_t k = 0; k < truths.size(); ++k) {
    ASSERT_TRUE(answer.laws[k].law) << answer.laws[k].obstacle;
    EXPECT_NEAR(answer.laws[k].law->fraction.value, truths[k].fraction, 1e-5);
    EXPECT_NEAR(answer.laws[k].law->prefactor.value, truths[k].prefactor, 1e-3);
    EXPECT_EQ(answer.laws[k].law->exponent.standard_error, answer.common->exponent.standard_error);
  }
}

// Curves alike tell the exponent as one with that many seeds does: its error falls with the root of their
// number. Each phi_m keeps the larger part of its own error, and is known better than with an exponent of its
// own.
TEST(CommonLaw, ManyCurvesKnowTheExponentBetterThanOne) {
  const CommonTruth truth{0.64, 1.4};
  const LawCurve one = exact(truth, 1e-4);
  const LawAnswer alone = fit_law(one.points, {}, one.flowing);
  const CommonAnswer together = fit_common_law(std::vector<LawCurve>(9, one), {});
  ASSERT_TRUE(alone.law && together.common);
  EXPECT_NEAR(alone.law->exponent.standard_error / together.common->exponent.standard_error, 3, 0.1);
  LawForm given;
  given.exponent = 1.8;
  const double known = fit_law(one.points, given, one.flowing).law->fraction.standard_error;
  const double own = alone.law->fraction.standard_error;
  // var(phi_m) = var given beta + (d phi_m / d beta)^2 var(beta), whose second part is a ninth of what it
  // was.
  const double expected = std::sqrt(known * known + (own * own - known * known) / 9);
  EXPECT_NEAR(together.laws[0].law->fraction.standard_error / expected, 1, 0.02);
}

TEST(CommonLaw, SaysThatItDoesNotDescribeUnlikeCurves) {
  std::vector<LawCurve> curves = all_exact();
  curves.push_back(exact({0.62, 1.0, 2.6}));
  const CommonAnswer answer = fit_common_law(curves, {});
  ASSERT_TRUE(answer.common) << answer.obstacle;
  EXPECT_GT(answer.common->chi_squared, 3 * answer.common->degrees);
}

TEST(CommonLaw, CurvesThatNoExponentDescribesTakeNoPart) {
  std::vector<LawCurve> curves = all_exact();
  LawCurve falling = exact(truths[0]);
  for (LawPoint& point : falling.points) point.value = 100 / point.value;
  curves.insert(curves.begin(), falling);
  const CommonAnswer answer = fit_common_law(curves, {});
  ASSERT_TRUE(answer.common) << answer.obstacle;
  EXPECT_EQ(answer.common->curves, 4);
  ASSERT_EQ(answer.laws.size(), 5U);
  EXPECT_FALSE(answer.laws[0].law);
  EXPECT_NEAR(answer.laws[1].law->fraction.value, truths[0].fraction, 1e-5);
  const CommonAnswer one = fit_common_law({exact(truths[0]), falling}, {});
  EXPECT_FALSE(one.common);
  EXPECT_EQ(one.obstacle, "no exponent from 0.25 to 6 describes two curves or more together");
  EXPECT_EQ(one.laws[0].obstacle, one.obstacle);
}

// With errors of half the value the steepest exponent is as good as the true one.
TEST(CommonLaw, IsRefusedWhereThePointsDoNotBoundTheExponent) {
  const CommonAnswer answer = fit_common_law({exact(truths[0], 0.5), exact(truths[1], 0.5)}, {});
  EXPECT_FALSE(answer.common);
  EXPECT_EQ(
      answer.obstacle,
      "the points do not bound the common exponent: smaller errors, or points nearer to jamming, would");
  ASSERT_EQ(answer.laws.size(), 2U);
  EXPECT_EQ(answer.laws[1].obstacle, answer.obstacle);
}

// Binomial bounds that chance leaves once in a thousand, of 4 curves in 100 campaigns, whose errors hang
// together by the exponent: as if 100 were independent, 0.95 - 3.3 sqrt(0.95 0.05 / 100) and 0.683 - 3.3
// sqrt(0.22 / 100).
TEST(CommonLaw, IntervalsHoldTheTruth) {
  std::mt19937_64 random(21);
  std::normal_distribution<double> normal;
  int held = 0, within_error = 0, exponents = 0;
  constexpr int campaigns = 100, seeds = 6;
  for (int k = 0; k < campaigns; ++k) {
    std::vector<LawCurve> curves = all_exact();
    for (std::size_t c = 0; c < curves.size(); ++c) {
      for (LawPoint& point : curves[c].points) {
        RunningEstimate found;
        for (int seed = 0; seed < seeds; ++seed) {
          found.add(truths[c].at(point.fraction) * (1 + 0.04 * normal(random)));
        }
        const Estimate estimate = found.estimate();
        point = {point.fraction, estimate.mean, estimate.standard_error, estimate.count};
      }
    }
    const CommonAnswer answer = fit_common_law(curves, {});
    ASSERT_TRUE(answer.common) << answer.obstacle;
    const Measured& exponent = answer.common->exponent;
    exponents += std::abs(exponent.value - 1.8) <= z_95 * exponent.standard_error ? 1 : 0;
    for (std::size_t c = 0; c < curves.size(); ++c) {
      ASSERT_TRUE(answer.laws[c].law) << answer.laws[c].obstacle;
      const Law& law = *answer.laws[c].law;
      held += law.low <= truths[c].fraction && truths[c].fraction <= law.high ? 1 : 0;
      within_error +=
          std::abs(law.fraction.value - truths[c].fraction) <= law.fraction.standard_error ? 1 : 0;
    }
  }
  RecordProperty("held", held);
  RecordProperty("exponents", exponents);
  EXPECT_GE(exponents, 100 * (0.95 - 0.072));
  EXPECT_GE(held, 400 * (0.95 - 0.072));
  EXPECT_GE(within_error, 400 * (0.683 - 0.155));
  EXPECT_LE(within_error, 400 * (0.683 + 0.155));
}

}  // namespace
}  // namespace peclet::runner
