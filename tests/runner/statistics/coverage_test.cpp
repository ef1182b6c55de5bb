// Tests how often the interval that the stop rule reports holds the true mean.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "runner/statistics/cohorts.h"
#include "tests/runner/population.h"

namespace peclet::runner {
namespace {

struct Coverage {
  double covered;          // share of intervals that hold the true mean
  double mean_stop_tests;  // number of stop tests up to the deciding one
  double bias;             // of the reported mean, in its standard errors
};

// Simulates points with seeds of a distribution of mean 1. A control variate of standard deviation `hidden`
// is subtracted from each value, so that value + control has the distribution.
template <class Distribution>
Coverage simulate(int replications, Distribution seeds, double tolerance, unsigned start, double hidden = 0) {
  std::mt19937_64 random(start);
  std::normal_distribution<double> noise(0, 1);
  const Target target{"relative_viscosity", tolerance, 0.95};
  int covered = 0;
  double stop_tests_made = 0, deviation = 0;
  for (int replication = 0; replication < replications; ++replication) {
    std::vector<std::optional<Outcome>> outcomes;
    std::vector<StopTest> stop_tests;
    for (const int seeds_wanted : stop_test_schedule(10, 400)) {
      while (std::ssize(outcomes) < seeds_wanted) {
        const double control = hidden > 0 ? hidden * noise(random) : 0;
        outcomes.emplace_back(Outcome{{seeds(random) - control, control}});
      }
      stop_tests = replay_stop_tests(outcomes, target, 10, 400);
      if (stop_tests.back().verdict != Verdict::more) break;
    }
    const StopTest& last = stop_tests.back();
    EXPECT_EQ(last.verdict, Verdict::converged);
    if (std::abs(last.controlled.mean - 1) <= last.controlled_half_width) ++covered;
    stop_tests_made += static_cast<double>(stop_tests.size());
    deviation += (last.controlled.mean - 1) / last.controlled.standard_error;
  }
  return {static_cast<double>(covered) / replications, stop_tests_made / replications,
          deviation / replications};
}

std::normal_distribution<double> normal_of(double spread) {
  return std::normal_distribution<double>(1, spread);
}

// A spread of 20 % and a tolerance of 7 % need about 34 seeds, so any of the stop tests at 10, 13, 17, 22,
// 28, 35, 44 ... may decide. Stopping when the interval happens to be narrow costs coverage: this rule is
// known to have about 93.7 % instead of 95 %. With 4000 replications the share has a standard error of 0.38
// %, so the band is left by chance less than once in 10^5 (4.5 and 6 standard errors). The seed is fixed.
TEST(Coverage, OfTheStopRuleStaysNearItsNominalValue) {
  const Coverage coverage = simulate(4000, normal_of(0.20), 0.07, 20260101);
  EXPECT_GT(coverage.mean_stop_tests, 4);
  EXPECT_GT(coverage.covered, 0.92);
  EXPECT_LT(coverage.covered, 0.96);
  // The tolerance is relative, so cohorts with a too large mean stop a little earlier: a bias of about 0.05
  // standard errors. The mean of 4000 scores has a standard error of 0.017; the bound is 9 of these away.
  EXPECT_LT(std::abs(coverage.bias), 0.2);
}

// The plain values have three times the variance of value + control. Stop tests and coverage must be those of
// value + control.
TEST(Coverage, OfTheControlledEstimateIsTheSame) {
  const Coverage coverage = simulate(4000, normal_of(0.20), 0.07, 20260103, 0.20 * std::sqrt(2));
  EXPECT_GT(coverage.mean_stop_tests, 4);
  EXPECT_LT(coverage.mean_stop_tests, 8);  // 9 to 10 if the plain estimate decided
  EXPECT_GT(coverage.covered, 0.92);
  EXPECT_LT(coverage.covered, 0.96);
  EXPECT_LT(std::abs(coverage.bias), 0.2);
}

// If the first stop test always meets the tolerance, the rule is Student's interval, which is exact: 95 %
// with a standard error of 0.34 %. The band is left by chance less than once in 10^4 (4 standard errors).
TEST(Coverage, WithoutRepeatedStopTestsIsStudents) {
  const Coverage coverage = simulate(4000, normal_of(0.02), 0.20, 20260102);
  EXPECT_EQ(coverage.mean_stop_tests, 1);
  EXPECT_NEAR(coverage.covered, 0.95, 0.0138);
}

// Means of squares, such as zero_shear_viscosity, have a gamma population whose skewness is twice its spread.
// Campaigns that lack large values stop early, so the coverage may be below that of normal seeds. The band
// allows a loss of 1 %: a coverage of 93 % passes by 2.6 standard errors of 0.38 %.
TEST(Coverage, OfMeansOfSquaresStaysNearItsNominalValueToo) {
  const Coverage coverage = simulate(4000, gamma_of(0.20), 0.07, 20260106);
  EXPECT_GT(coverage.mean_stop_tests, 4);
  EXPECT_GT(coverage.covered, 0.92);
  EXPECT_LT(coverage.covered, 0.96);
  EXPECT_LT(std::abs(coverage.bias), 0.25);
}

// The number of points with a verdict, and of those whose interval holds the mean.
struct OfVerdict {
  int count = 0, covered = 0;
  double share(int of) const { return static_cast<double>(count) / of; }
  double coverage() const { return static_cast<double>(covered) / count; }
};

struct Verdicts {
  OfVerdict all, early, near_maximum, capped;
};

Verdicts simulate_near_maximum(int replications, double needed, int maximum, unsigned start) {
  std::mt19937_64 random(start);
  const double tolerance = 0.05;
  std::normal_distribution<double> seeds(1, tolerance * std::sqrt(needed) / 1.959964);
  const Target target{"relative_viscosity", tolerance, 0.95};
  Verdicts verdicts;
  for (int replication = 0; replication < replications; ++replication) {
    std::vector<std::optional<Outcome>> outcomes(static_cast<std::size_t>(maximum));
    for (std::optional<Outcome>& outcome : outcomes) outcome = Outcome{{seeds(random), 0}};
    const StopTest last = replay_stop_tests(outcomes, target, 8, maximum).back();
    for (OfVerdict* of : {&verdicts.all, last.verdict == Verdict::capped ? &verdicts.capped
                                         : last.near_maximum             ? &verdicts.near_maximum
                                                                         : &verdicts.early}) {
      ++of->count;
      of->covered += std::abs(last.controlled.mean - 1) <= last.controlled_half_width ? 1 : 0;
    }
  }
  return verdicts;
}

// With 4000 replications a coverage of 95 % has a standard error of 0.34 %. The intervals of all points
// together hold the mean as often as they say: capped points balance those that stopped early.
TEST(Coverage, NearTheMaximumHoldsOfAllPointsTogether) {
  constexpr int replications = 4000;
  for (const auto& [needed, maximum] : {std::pair(6.0, 20), {10.0, 20}, {15.0, 20}, {25.0, 50}, {30.0, 20}}) {
    const Verdicts verdicts = simulate_near_maximum(replications, needed, maximum, 20260104);
    EXPECT_GT(verdicts.all.coverage(), 0.935) << needed << " of " << maximum;
  }
}

// Converged points are a selection of small spreads: at most 2 Phi(1.96 sqrt(20 / 30)) - 1 = 89 % of the
// intervals within the tolerance hold the mean.
TEST(Coverage, NextToNothingConvergesUnmarkedThatNeedsMoreSeedsThanAreAllowed) {
  constexpr int replications = 4000;
  const Verdicts verdicts = simulate_near_maximum(replications, 30, 20, 20260105);
  EXPECT_LT(verdicts.early.share(replications), 0.01);
  EXPECT_GT(verdicts.near_maximum.share(replications), 0.02);
  EXPECT_LT(verdicts.near_maximum.coverage(), 0.89);
  EXPECT_GT(verdicts.capped.coverage(), 0.935);
}

}  // namespace
}  // namespace peclet::runner
