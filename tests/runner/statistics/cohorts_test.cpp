// Tests when stop tests happen, their results, and that these depend on the outcomes alone.
#include "runner/statistics/cohorts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <random>

namespace peclet::runner {
namespace {

using Outcomes = std::vector<std::optional<Outcome>>;

const Target five_percent{"relative_viscosity", 0.05, 0.95};

Outcome value(double number, double control = 0) { return {{number, control}}; }
Outcome lost() { return {}; }

// Returns values mean - spread, mean + spread in turn. For even n their standard error is
// spread / sqrt(n - 1).
Outcomes alternating(int count, double mean, double spread) {
  Outcomes outcomes;
  for (int seed = 0; seed < count; ++seed) {
    outcomes.emplace_back(value(seed % 2 == 0 ? mean - spread : mean + spread));
  }
  return outcomes;
}

Outcomes all_lost(int count) { return Outcomes(static_cast<std::size_t>(count), lost()); }

TEST(Cohorts, StopTestsAreAtTheMinimumThenAQuarterMoreRoundedUpAndLastAtTheMaximum) {
  EXPECT_EQ(stop_test_schedule(10, 800),
            (std::vector<int>{10,  13,  17,  22,  28,  35,  44,  55,  69,  87,
                              109, 137, 172, 215, 269, 337, 422, 528, 660, 800}));
  EXPECT_EQ(stop_test_schedule(2, 7), (std::vector<int>{2, 3, 4, 5, 7}));
  EXPECT_EQ(stop_test_schedule(8, 10), (std::vector<int>{8, 10}));
  EXPECT_EQ(stop_test_schedule(6, 6), (std::vector<int>{6}));
}

TEST(Cohorts, ThereIsNoStopTestBeforeEverySeedOfTheCohortHasEnded) {
  Outcomes outcomes = alternating(10, 10, 0.1);
  outcomes[3].reset();
  EXPECT_TRUE(replay_stop_tests(outcomes, five_percent, 10, 100).empty());
  outcomes.resize(9);
  outcomes[3] = value(10);
  EXPECT_TRUE(replay_stop_tests(outcomes, five_percent, 10, 100).empty());
  EXPECT_TRUE(replay_stop_tests({}, five_percent, 2, 2).empty());
}

TEST(Cohorts, APointConvergesAtTheFirstStopTestWithinTheTolerance) {
  // At 95.7 % t(9) = 2.354: the half-width is 2.354 * 0.3 / 3 = 0.2354 at n = 10, mean 10.
  const std::vector<StopTest> stop_tests = replay_stop_tests(alternating(40, 10, 0.3), five_percent, 10, 100);
  ASSERT_EQ(stop_tests.size(), 1U);
  EXPECT_EQ(stop_tests[0].verdict, Verdict::converged);
  EXPECT_EQ(stop_tests[0].seeds, 10);
  EXPECT_DOUBLE_EQ(stop_tests[0].estimate.mean, 10);
  EXPECT_NEAR(stop_tests[0].half_width, 0.2354, 1e-4);
}

TEST(Cohorts, APointGoesOnUntilAStopTestIsWithinTheTolerance) {
  // Half-width over mean 2.354 * 0.1 / 3 = 7.8 % at n = 10; with 22 seeds 2.154 * 0.1 / sqrt(21) = 4.7 %.
  const std::vector<StopTest> stop_tests = replay_stop_tests(alternating(22, 10, 1), five_percent, 10, 100);
  ASSERT_EQ(stop_tests.size(), 4U);  // 10, 13, 17, 22
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(stop_tests[i].verdict, Verdict::more);
  EXPECT_EQ(stop_tests[3].seeds, 22);
  EXPECT_EQ(stop_tests[3].verdict, Verdict::converged);
}

TEST(Cohorts, ANegativeMeanIsJudgedByItsSize) {
  EXPECT_EQ(replay_stop_tests(alternating(10, -10, 0.3), five_percent, 10, 100).at(0).verdict,
            Verdict::converged);
}

TEST(Cohorts, AMeanOfZeroNeverConverges) {
  EXPECT_EQ(replay_stop_tests(alternating(10, 0, 1), five_percent, 10, 10).at(0).verdict, Verdict::capped);
  EXPECT_EQ(replay_stop_tests(alternating(10, 0, 0), five_percent, 10, 10).at(0).verdict, Verdict::capped);
}

TEST(Cohorts, APointThatIsNotWithinTheToleranceAtTheMaximumIsCapped) {
  const std::vector<StopTest> stop_tests = replay_stop_tests(alternating(13, 10, 5), five_percent, 10, 13);
  ASSERT_EQ(stop_tests.size(), 2U);
  EXPECT_EQ(stop_tests[1].verdict, Verdict::capped);
}

TEST(Cohorts, LostSeedsCountInTheCohortButNotInTheEstimate) {
  Outcomes outcomes = alternating(10, 10, 0.1);
  outcomes[0] = outcomes[1] = lost();
  const StopTest stop_test = replay_stop_tests(outcomes, five_percent, 10, 100).at(0);
  EXPECT_EQ(stop_test.verdict, Verdict::converged_with_losses);
  EXPECT_EQ(stop_test.seeds, 10);
  EXPECT_EQ(stop_test.lost, 2);
  EXPECT_EQ(stop_test.estimate.count, 8);
  EXPECT_DOUBLE_EQ(stop_test.estimate.mean, 10);
  EXPECT_NEAR(stop_test.half_width, 2.467 * 0.1 / std::sqrt(7), 1e-4);  // t(7) at 95.7 %
}

TEST(Cohorts, APointThatLosesItsWholeFirstCohortHasFailed) {
  const std::vector<StopTest> stop_tests = replay_stop_tests(all_lost(50), five_percent, 10, 100);
  ASSERT_EQ(stop_tests.size(), 1U);
  EXPECT_EQ(stop_tests[0].verdict, Verdict::failed);
  EXPECT_EQ(stop_tests[0].lost, 10);
}

TEST(Cohorts, OneValueCannotConvergeAndIsNoResultAtTheMaximum) {
  Outcomes outcomes = all_lost(13);
  outcomes[4] = value(10);
  const std::vector<StopTest> stop_tests = replay_stop_tests(outcomes, five_percent, 10, 13);
  ASSERT_EQ(stop_tests.size(), 2U);
  EXPECT_EQ(stop_tests[0].verdict, Verdict::more);
  EXPECT_TRUE(std::isnan(stop_tests[0].half_width));
  EXPECT_EQ(stop_tests[1].verdict, Verdict::failed);
}

TEST(Cohorts, TheControlVariateIsAddedSeedBySeed) {
  // Control and value are opposite up to a constant, so their sum has no spread at all.
  Outcomes outcomes;
  for (int seed = 0; seed < 10; ++seed) {
    const double noise = seed % 2 == 0 ? 0.25 : -0.25;
    outcomes.emplace_back(value(10 + noise, -noise));
  }
  const StopTest stop_test = replay_stop_tests(outcomes, five_percent, 10, 10).at(0);
  EXPECT_EQ(stop_test.controlled.mean, 10);
  EXPECT_EQ(stop_test.controlled.standard_error, 0);
  EXPECT_DOUBLE_EQ(stop_test.estimate.standard_error, 0.25 / 3);
}

// Student's half-width of ten values 10 +- s at 95.7 % is 2.354 s / 3: 7.8 % for s = 1, 0.78 % for s = 0.1.
TEST(Cohorts, TheControlledEstimateDecides) {
  Outcomes narrow, wide;
  for (int seed = 0; seed < 10; ++seed) {
    const double sign = seed % 2 == 0 ? 1 : -1;
    narrow.emplace_back(value(10 + sign, -0.9 * sign));
    wide.emplace_back(value(10 + 0.1 * sign, 0.9 * sign));
  }
  const StopTest converged = replay_stop_tests(narrow, five_percent, 10, 20).at(0);
  EXPECT_EQ(converged.verdict, Verdict::converged);
  EXPECT_NEAR(relative_width(converged), 0.00785, 1e-5);
  const StopTest open = replay_stop_tests(wide, five_percent, 10, 20).at(0);
  EXPECT_EQ(open.verdict, Verdict::more);
  EXPECT_NEAR(relative_width(open), 0.0785, 1e-4);
}

// For ten values 10 +- 0.6, w = 2.354 * 0.6 / 30 = 4.708 % at 95.7 %. With chi^2_0.05(9) = 3.325 (f = 2.707),
// up to 10 (4.708 / 5)^2 2.707 = 24.0 seeds may be needed.
TEST(Cohorts, AStopTestWithinTheToleranceConvergesAndIsMarkedNearTheMaximum) {
  const Outcomes outcomes = alternating(10, 10, 0.6);
  for (const int maximum : {11, 23, 25, 1000}) {
    const StopTest stop_test = replay_stop_tests(outcomes, five_percent, 10, maximum).at(0);
    EXPECT_EQ(stop_test.verdict, Verdict::converged);
    EXPECT_EQ(stop_test.near_maximum, maximum < 24) << maximum;
    EXPECT_NEAR(stop_test.controlled_half_width, 0.4708, 1e-4);
  }
  const StopTest open = replay_stop_tests(alternating(10, 10, 1), five_percent, 10, 11).at(0);
  EXPECT_EQ(open.verdict, Verdict::more);
  EXPECT_FALSE(open.near_maximum);
}

// With a single stop test t(9, 0.975) = 2.262 and w = 2.262 s / 30: 5 % at s = 0.663.
TEST(Cohorts, TheLastStopTestIsConvergedOrCapped) {
  const auto last = [](double spread) {
    return replay_stop_tests(alternating(10, 10, spread), five_percent, 10, 10).at(0);
  };
  EXPECT_EQ(last(0.66).verdict, Verdict::converged);
  EXPECT_TRUE(last(0.66).near_maximum);
  EXPECT_EQ(last(0.67).verdict, Verdict::capped);
  EXPECT_FALSE(last(0.67).near_maximum);
  EXPECT_NEAR(last(0.67).controlled_half_width, 2.262 * 0.67 / 3, 1e-3);
  // 10 (w / 5 %)^2 2.707 <= 10 up to w = 3.04 %, s = 0.403.
  EXPECT_FALSE(last(0.40).near_maximum);
  EXPECT_TRUE(last(0.41).near_maximum);
}

// A share of the mean is meaningless for values 0 +- s. Their half-width is 2.354 s / 3.
TEST(Cohorts, AnAbsoluteToleranceNeedsNoMean) {
  const Target half{"first_normal_stress_difference", Tolerance::absolute(0.5), 0.95};
  const Outcomes outcomes = alternating(10, 0, 0.6);
  EXPECT_EQ(replay_stop_tests(outcomes, five_percent, 10, 32).at(0).verdict, Verdict::more);
  const StopTest stop_test = replay_stop_tests(outcomes, half, 10, 32).at(0);
  EXPECT_EQ(stop_test.verdict, Verdict::converged);
  EXPECT_NEAR(stop_test.controlled_half_width, 0.4708, 1e-4);
  EXPECT_EQ(replay_stop_tests(alternating(10, 0, 0.65), half, 10, 32).at(0).verdict, Verdict::more);
}

// Compares all stop tests of several populations, for relative and absolute tolerances from those that the
// first stop test meets to those that none meets.
TEST(Cohorts, NoIntervalDependsOnTheTolerance) {
  const auto alone = [](double tolerance) { return Target{"x", tolerance, 0.95}; };
  std::vector<Target> targets;
  for (const double tolerance : {1e-9, 0.01, 0.03, 0.05, 0.06, 0.1, 0.2, 0.5, 0.9}) {
    targets.push_back(alone(tolerance));
    targets.push_back({"x", Tolerance::absolute(tolerance), 0.95});
  }
  std::mt19937_64 random(20261127);
  std::normal_distribution<double> normal(1, 0.2);
  std::lognormal_distribution<double> lognormal(0, 0.8);
  std::bernoulli_distribution share(0.9);
  for (const auto& [minimum, maximum] : {std::pair(8, 60), {10, 800}, {16, 16}}) {
    for (int replication = 0; replication < 30; ++replication) {
      Outcomes outcomes;
      for (int seed = 0; seed < maximum; ++seed) {
        outcomes.emplace_back(value(replication % 3 == 0   ? normal(random)
                                    : replication % 3 == 1 ? lognormal(random)
                                                           : static_cast<double>(share(random))));
      }
      const std::vector<StopTest> all = replay_stop_tests(outcomes, alone(1e-9), minimum, maximum);
      ASSERT_EQ(all.size(), stop_test_schedule(minimum, maximum).size());
      for (const Target& target : targets) {
        const std::vector<StopTest> stop_tests = replay_stop_tests(outcomes, target, minimum, maximum);
        for (std::size_t i = 0; i < stop_tests.size(); ++i) {
          EXPECT_EQ(std::bit_cast<std::uint64_t>(stop_tests[i].controlled_half_width),
                    std::bit_cast<std::uint64_t>(all[i].controlled_half_width));
          EXPECT_EQ(std::bit_cast<std::uint64_t>(stop_tests[i].half_width),
                    std::bit_cast<std::uint64_t>(all[i].half_width));
        }
      }
    }
  }
}

// The half-width is t(15, 0.975) = 2.131 (NIST) times spread / sqrt(15).
TEST(Cohorts, TheIntervalOfASingleStopTestIsStudents) {
  for (const double spread : {0.2, 0.5, 1.0}) {
    for (const double tolerance : {0.06, 0.1, 1.0}) {
      const Target target{"x", tolerance, 0.95};
      const StopTest stop_test = replay_stop_tests(alternating(16, 10, spread), target, 16, 16).at(0);
      EXPECT_NEAR(stop_test.controlled_half_width, 2.131 * spread / std::sqrt(15), 1e-3 * spread);
    }
  }
}

TEST(Cohorts, EqualValuesHaveNoIntervalAndNeverConverge) {
  const Target absolute{"x", Tolerance::absolute(1), 0.95};
  for (const double number : {10.0, 0.1, 0.0, 1.0, -3e-7}) {
    for (const Target& target : {five_percent, absolute}) {
      const std::vector<StopTest> stop_tests = replay_stop_tests(Outcomes(20, value(number)), target, 8, 20);
      EXPECT_EQ(stop_tests.back().seeds, 20);
      EXPECT_EQ(stop_tests.back().verdict, Verdict::capped);
      EXPECT_EQ(stop_tests.back().controlled.mean, number);
      EXPECT_TRUE(std::isnan(stop_tests.back().controlled_half_width));
      EXPECT_EQ(without_interval(stop_tests.back(), target), (std::vector<std::string>{target.observable}));
    }
  }
  // Sums of the same numbers in different order.
  Outcomes rounded(20, value(0.1 + 0.2 + 0.3));
  rounded[3] = value(0.3 + 0.2 + 0.1);
  EXPECT_NE(rounded[3]->value, rounded[2]->value);
  EXPECT_EQ(replay_stop_tests(rounded, five_percent, 8, 20).back().verdict, Verdict::capped);
  // Values that a control variate makes equal.
  Outcomes controlled;
  for (int seed = 0; seed < 8; ++seed) controlled.emplace_back(value(10 + 0.25 * seed, -0.25 * seed));
  const StopTest stop_test = replay_stop_tests(controlled, five_percent, 8, 8).at(0);
  EXPECT_TRUE(std::isnan(stop_test.controlled_half_width));
  EXPECT_GT(stop_test.half_width, 0);
  // Two different values have a spread, and so have values of which one differs.
  EXPECT_GT(replay_stop_tests({value(10), value(10.1)}, five_percent, 2, 2).at(0).half_width, 0);
  Outcomes but_one(8, value(10));
  but_one[5] = value(10.1);
  EXPECT_NEAR(replay_stop_tests(but_one, five_percent, 8, 8).at(0).half_width, 2.365 * 0.1 / 8, 1e-4);
}

Outcome share(int number) {
  Outcome outcome = value(number);
  outcome.is_share = true;
  return outcome;
}

// The interval of 8 ones in 8 is 0.025^(1/8) = 0.6306 to 1; that of 0 in 10 is 0 to 1 - 0.025^(1/10) =
// 0.3085. With a single stop test a tolerance of 0.1 needs 36 equal values: 0.025^(1/36) = 0.9026.
TEST(Cohorts, SharesHaveAnIntervalOfShares) {
  const Target tenth{"flowing", Tolerance::absolute(0.1), 0.95};
  const auto single = [&](const Outcomes& outcomes) {
    const int seeds = static_cast<int>(outcomes.size());
    return replay_stop_tests(outcomes, tenth, seeds, seeds).at(0);
  };
  EXPECT_NEAR(single(Outcomes(8, share(1))).controlled_half_width, 1 - 0.6306, 1e-4);
  EXPECT_EQ(single(Outcomes(8, share(1))).verdict, Verdict::capped);
  EXPECT_NEAR(single(Outcomes(10, share(0))).controlled_half_width, 0.3085, 1e-4);
  EXPECT_EQ(single(Outcomes(35, share(1))).verdict, Verdict::capped);
  EXPECT_EQ(single(Outcomes(36, share(1))).verdict, Verdict::converged);
  // 5 ones in 10: 0.187 to 0.813 (Clopper and Pearson's chart). Values of both 0 and 1 are always a share.
  Outcomes both;
  for (int seed = 0; seed < 10; ++seed) both.emplace_back(value(seed % 2));
  EXPECT_NEAR(single(both).controlled_half_width, 0.3129, 1e-4);
  EXPECT_TRUE(std::isnan(single(Outcomes(8, value(1))).controlled_half_width));
}

// 59 ones in 60 are far from a normal population, but the interval of a share does not need one.
TEST(Cohorts, ASkewedShareIsNotMarked) {
  Outcomes outcomes(60, share(1));
  outcomes[7] = share(0);
  const Target tenth{"flowing", Tolerance::absolute(0.1), 0.95};
  const StopTest stop_test = replay_stop_tests(outcomes, tenth, 60, 60).at(0);
  EXPECT_GT(std::abs(stop_test.skewness), 5);
  EXPECT_FALSE(is_skewed(stop_test, 0.95));
  // The stored estimate is recognised as a share.
  Estimate stored{stop_test.controlled.count, stop_test.controlled.mean, stop_test.controlled.standard_error};
  EXPECT_EQ(stored_values(stored, stop_test.controlled_half_width), Estimate::Values::share);
}

// The variance of 1e-13 +- 1e-14 differs from that of a share of 1e-13 by less than the rounding of 1.
TEST(Cohorts, SmallNumbersAreNoShares) {
  EXPECT_EQ(stored_values({8, 1e-13, 1e-14 / std::sqrt(7)}, 1e-14), Estimate::Values::spread);
  EXPECT_EQ(stored_values({8, 0.25, std::sqrt(0.25 * 0.75 / 7)}, 0.4), Estimate::Values::share);
  EXPECT_EQ(stored_values({8, 0, 0}, 0.4), Estimate::Values::share);
  EXPECT_EQ(stored_values({8, 1, 0}, 0.4), Estimate::Values::share);
}

TEST(Cohorts, SeedsThatEndInOneStateAreNotIndependent) {
  Outcomes outcomes = alternating(12, 10, 0.1);
  for (std::size_t seed = 0; seed < outcomes.size(); ++seed) outcomes[seed]->final_state = 1 + seed % 3;
  const StopTest stop_test = replay_stop_tests(outcomes, five_percent, 12, 12).at(0);
  EXPECT_EQ(stop_test.verdict, Verdict::capped);
  EXPECT_EQ(stop_test.repeated, (std::vector<int>{3, 4, 5, 6, 7, 8, 9, 10, 11}));
  EXPECT_TRUE(std::isnan(stop_test.controlled_half_width));
  EXPECT_TRUE(std::isnan(stop_test.half_width));
  for (std::size_t seed = 0; seed < outcomes.size(); ++seed) outcomes[seed]->final_state = 1 + seed;
  EXPECT_EQ(replay_stop_tests(outcomes, five_percent, 12, 12).at(0).verdict, Verdict::converged);
  for (std::optional<Outcome>& outcome : outcomes) outcome->final_state = 0;  // not known
  EXPECT_TRUE(replay_stop_tests(outcomes, five_percent, 12, 12).at(0).repeated.empty());
}

TEST(Cohorts, IntervalsAreWidenedForRepeatedStopTestsOnly) {
  EXPECT_DOUBLE_EQ(adjusted_confidence(0.95, 10, 100), 0.957);
  EXPECT_DOUBLE_EQ(adjusted_confidence(0.90, 14, 100), 0.91);
  EXPECT_DOUBLE_EQ(adjusted_confidence(0.95, 10, 10), 0.95);
  // t(9, 0.975) = 2.262
  EXPECT_NEAR(replay_stop_tests(alternating(10, 10, 0.3), five_percent, 10, 10).at(0).half_width, 0.2262,
              1e-4);
}

// Seven equal values and one other have g = 2.268 (moments 1/8 and 7/8). The standard deviation of g is 0.752
// for 8 normal values. The loss is 2 * 0.0584 * 1.96 * 19.44 * 2.268^2 / (18 * 8) = 0.159.
TEST(Cohorts, ASkewedPopulationIsNoticed) {
  Outcomes skewed(8, value(10)), even = alternating(8, 10, 1);
  skewed[5] = value(11);
  const StopTest stop_test = replay_stop_tests(skewed, five_percent, 8, 8).at(0);
  EXPECT_NEAR(stop_test.skewness, 2.268, 1e-3);
  EXPECT_TRUE(is_skewed(stop_test, 0.95));
  EXPECT_FALSE(is_skewed(replay_stop_tests(even, five_percent, 8, 8).at(0), 0.95));
  EXPECT_FALSE(is_skewed(replay_stop_tests(Outcomes(8, value(10)), five_percent, 8, 8).at(0), 0.95));
  // Among many values this skewness costs little: 0.247 * 2.268^2 / 200 = 0.6 %.
  Outcomes many;
  for (int i = 0; i < 25; ++i) many.insert(many.end(), skewed.begin(), skewed.end());
  EXPECT_FALSE(is_skewed(replay_stop_tests(many, five_percent, 200, 200).at(0), 0.95));
}

TEST(Cohorts, OutcomesBeyondTheDecidingStopTestChangeNothing) {
  const std::vector<StopTest> few = replay_stop_tests(alternating(10, 10, 0.3), five_percent, 10, 100);
  Outcomes more = alternating(10, 10, 0.3);
  for (int i = 0; i < 30; ++i) more.emplace_back(i % 3 == 0 ? lost() : value(1000));
  const std::vector<StopTest> many = replay_stop_tests(more, five_percent, 10, 100);
  ASSERT_EQ(many.size(), few.size());
  EXPECT_EQ(many[0].estimate.mean, few[0].estimate.mean);
}

// Seeds end in 200 random orders, and the stop tests are replayed after each seed. Every order ends with the
// same stop tests, bit for bit, and no stop test is ever withdrawn or changed.
TEST(Cohorts, AnswerDoesNotDependOnTheOrderOfArrival) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal(10, 2.5);
  Outcomes truth;
  for (int seed = 0; seed < 60; ++seed) truth.emplace_back(value(normal(random)));
  truth[5] = lost();
  const std::vector<StopTest> expected = replay_stop_tests(truth, five_percent, 10, 60);
  ASSERT_GE(expected.size(), 5U);

  std::vector<std::size_t> order(truth.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  for (int trial = 0; trial < 200; ++trial) {
    std::shuffle(order.begin(), order.end(), random);
    Outcomes known;
    std::size_t before = 0;
    for (const std::size_t seed : order) {
      known.resize(std::max(known.size(), seed + 1));
      known[seed] = truth[seed];
      const std::vector<StopTest> stop_tests = replay_stop_tests(known, five_percent, 10, 60);
      ASSERT_GE(stop_tests.size(), before);
      before = stop_tests.size();
      for (std::size_t i = 0; i < stop_tests.size(); ++i) {
        ASSERT_EQ(stop_tests[i].estimate.mean, expected[i].estimate.mean);
        ASSERT_EQ(stop_tests[i].half_width, expected[i].half_width);
        ASSERT_EQ(stop_tests[i].verdict, expected[i].verdict);
      }
    }
    ASSERT_EQ(before, expected.size());
  }
}

// The target of a campaign with a fixed number of realisations.
const Target no_tolerance{"relative_viscosity", Tolerance::none(), 0.95};

// scipy.stats.t.ppf(0.975, 4) = 2.776445; the values 1 to 5 have the variance 5/2.
TEST(FixedNumber, HasOneStopTestWithStudentsInterval) {
  Outcomes outcomes;
  for (int seed = 0; seed < 5; ++seed) {
    EXPECT_TRUE(replay_stop_tests(outcomes, no_tolerance, 5, 5).empty());
    outcomes.emplace_back(value(seed + 1));
  }
  const std::vector<StopTest> stop_tests = replay_stop_tests(outcomes, no_tolerance, 5, 5);
  ASSERT_EQ(stop_tests.size(), 1U);
  EXPECT_EQ(stop_tests[0].verdict, Verdict::complete);
  EXPECT_DOUBLE_EQ(stop_tests[0].controlled.mean, 3);
  EXPECT_NEAR(stop_tests[0].controlled_half_width, 2.776445 * std::sqrt(2.5 / 5), 1e-6);
  EXPECT_FALSE(stop_tests[0].near_maximum);
  EXPECT_EQ(replay_stop_tests(alternating(9, 10, 3), no_tolerance, 5, 5).size(), 1U)
      << "later seeds do not count";
}

// scipy.stats.t.ppf(0.975, 3) = 3.182446; 1, 2, 4 and 5 have the variance 10/3.
TEST(FixedNumber, LeavesOutLostSeedsAndSaysSo) {
  Outcomes outcomes{value(1), value(2), lost(), value(4), value(5)};
  const StopTest stop_test = replay_stop_tests(outcomes, no_tolerance, 5, 5).at(0);
  EXPECT_EQ(stop_test.verdict, Verdict::complete_with_losses);
  EXPECT_EQ(stop_test.lost, 1);
  EXPECT_NEAR(stop_test.controlled_half_width, 3.182446 * std::sqrt(10.0 / 3 / 4), 1e-6);
  EXPECT_EQ(replay_stop_tests(all_lost(5), no_tolerance, 5, 5).at(0).verdict, Verdict::failed);
}

TEST(FixedNumber, OfOneHasAMeanWithoutAnInterval) {
  const StopTest stop_test = replay_stop_tests({value(7)}, no_tolerance, 1, 1).at(0);
  EXPECT_EQ(stop_test.verdict, Verdict::complete);
  EXPECT_EQ(stop_test.controlled.mean, 7);
  EXPECT_FALSE(std::isfinite(stop_test.controlled_half_width));
}

TEST(FixedNumber, GivesEachObservableThatIsShownItsInterval) {
  Target both = no_tolerance;
  both.also = {{"pressure", Tolerance::none()}};
  Outcomes outcomes;
  for (int seed = 0; seed < 5; ++seed) {
    outcomes.emplace_back(value(seed + 1));
    outcomes.back()->further = {{seed == 2 ? std::nan("") : 10.0 * (seed + 1)}};
  }
  const StopTest stop_test = replay_stop_tests(outcomes, both, 5, 5).at(0);
  ASSERT_EQ(stop_test.each.size(), 2U);
  EXPECT_EQ(stop_test.each[0].verdict, Verdict::complete);
  EXPECT_NEAR(stop_test.each[0].half_width, 2.776445 * std::sqrt(2.5 / 5), 1e-6);
  EXPECT_EQ(stop_test.each[1].verdict, Verdict::complete_with_losses);
  EXPECT_NEAR(stop_test.each[1].half_width, 31.82446 * std::sqrt(10.0 / 3 / 4), 1e-5);
  EXPECT_EQ(stop_test.verdict, Verdict::complete_with_losses);
}

}  // namespace
}  // namespace peclet::runner
