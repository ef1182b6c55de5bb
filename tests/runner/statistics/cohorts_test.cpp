// The stop rule: what a look says, when there is one, and that nothing but the outcomes matters.
#include "runner/statistics/cohorts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace peclet::runner {
namespace {

using Outcomes = std::vector<std::optional<Outcome>>;

const Target five_percent{"relative_viscosity", 0.05, 0.95};

Outcome value(double number, double control = 0) { return {Outcome::Kind::value, number, control}; }
Outcome lost() { return {Outcome::Kind::lost, 0, 0}; }

// Alternating mean - spread, mean + spread: the standard error of an even number n is spread / sqrt(n - 1).
Outcomes alternating(int count, double mean, double spread) {
  Outcomes outcomes;
  for (int seed = 0; seed < count; ++seed) {
    outcomes.emplace_back(value(seed % 2 == 0 ? mean - spread : mean + spread));
  }
  return outcomes;
}

Outcomes all_lost(int count) { return Outcomes(static_cast<std::size_t>(count), lost()); }

TEST(Cohorts, LooksAreAtTheMinimumThenAQuarterMoreRoundedUpAndLastAtTheMaximum) {
  EXPECT_EQ(look_schedule(10, 800), (std::vector<int>{10,  13,  17,  22,  28,  35,  44,  55,  69,  87,
                                                      109, 137, 172, 215, 269, 337, 422, 528, 660, 800}));
  EXPECT_EQ(look_schedule(2, 7), (std::vector<int>{2, 3, 4, 5, 7}));
  EXPECT_EQ(look_schedule(8, 10), (std::vector<int>{8, 10}));
  EXPECT_EQ(look_schedule(6, 6), (std::vector<int>{6}));
}

TEST(Cohorts, ThereIsNoLookBeforeEverySeedOfTheCohortHasEnded) {
  Outcomes outcomes = alternating(10, 10, 0.1);
  outcomes[3].reset();
  EXPECT_TRUE(replay_looks(outcomes, five_percent, 10, 100).empty());
  outcomes.resize(9);
  outcomes[3] = value(10);
  EXPECT_TRUE(replay_looks(outcomes, five_percent, 10, 100).empty());
  EXPECT_TRUE(replay_looks({}, five_percent, 2, 2).empty());
}

TEST(Cohorts, APointConvergesAtTheFirstLookWithinTheTolerance) {
  // At 95.7 % t(9) = 2.354: the half-width is 2.354 * 0.3 / 3 = 0.2354 at n = 10, mean 10.
  const std::vector<Look> looks = replay_looks(alternating(40, 10, 0.3), five_percent, 10, 100);
  ASSERT_EQ(looks.size(), 1U);
  EXPECT_EQ(looks[0].verdict, Verdict::converged);
  EXPECT_EQ(looks[0].seeds, 10);
  EXPECT_DOUBLE_EQ(looks[0].estimate.mean, 10);
  EXPECT_NEAR(looks[0].half_width, 0.2354, 1e-4);
}

TEST(Cohorts, APointGoesOnUntilALookIsWithinTheTolerance) {
  // Half-width over mean 2.354 * 0.1 / 3 = 7.8 % at n = 10; with 22 seeds 2.154 * 0.1 / sqrt(21) = 4.7 %.
  const std::vector<Look> looks = replay_looks(alternating(22, 10, 1), five_percent, 10, 100);
  ASSERT_EQ(looks.size(), 4U);  // 10, 13, 17, 22
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(looks[i].verdict, Verdict::more);
  EXPECT_EQ(looks[3].seeds, 22);
  EXPECT_EQ(looks[3].verdict, Verdict::converged);
}

TEST(Cohorts, ANegativeMeanIsJudgedByItsSize) {
  EXPECT_EQ(replay_looks(alternating(10, -10, 0.3), five_percent, 10, 100).at(0).verdict, Verdict::converged);
}

TEST(Cohorts, AMeanOfZeroNeverConverges) {
  EXPECT_EQ(replay_looks(alternating(10, 0, 1), five_percent, 10, 10).at(0).verdict, Verdict::capped);
  EXPECT_EQ(replay_looks(alternating(10, 0, 0), five_percent, 10, 10).at(0).verdict, Verdict::capped);
}

TEST(Cohorts, APointThatIsNotWithinTheToleranceAtTheMaximumIsCapped) {
  const std::vector<Look> looks = replay_looks(alternating(13, 10, 5), five_percent, 10, 13);
  ASSERT_EQ(looks.size(), 2U);
  EXPECT_EQ(looks[1].verdict, Verdict::capped);
}

TEST(Cohorts, LostSeedsCountInTheCohortButNotInTheEstimate) {
  Outcomes outcomes = alternating(10, 10, 0.1);
  outcomes[0] = outcomes[1] = lost();
  const Look look = replay_looks(outcomes, five_percent, 10, 100).at(0);
  EXPECT_EQ(look.verdict, Verdict::converged_with_losses);
  EXPECT_EQ(look.seeds, 10);
  EXPECT_EQ(look.lost, 2);
  EXPECT_EQ(look.estimate.count, 8);
  EXPECT_DOUBLE_EQ(look.estimate.mean, 10);
  EXPECT_NEAR(look.half_width, 2.467 * 0.1 / std::sqrt(7), 1e-4);  // t(7) at 95.7 %
}

TEST(Cohorts, APointThatLosesItsWholeFirstCohortHasFailed) {
  const std::vector<Look> looks = replay_looks(all_lost(50), five_percent, 10, 100);
  ASSERT_EQ(looks.size(), 1U);
  EXPECT_EQ(looks[0].verdict, Verdict::failed);
  EXPECT_EQ(looks[0].lost, 10);
}

TEST(Cohorts, OneValueCannotConvergeAndIsNoResultAtTheMaximum) {
  Outcomes outcomes = all_lost(13);
  outcomes[4] = value(10);
  const std::vector<Look> looks = replay_looks(outcomes, five_percent, 10, 13);
  ASSERT_EQ(looks.size(), 2U);
  EXPECT_EQ(looks[0].verdict, Verdict::more);
  EXPECT_TRUE(std::isnan(looks[0].half_width));
  EXPECT_EQ(looks[1].verdict, Verdict::failed);
}

TEST(Cohorts, TheControlVariateIsAddedSeedBySeed) {
  // Control and value are opposite up to a constant, so their sum has no spread at all.
  Outcomes outcomes;
  for (int seed = 0; seed < 10; ++seed) {
    const double noise = seed % 2 == 0 ? 0.25 : -0.25;
    outcomes.emplace_back(value(10 + noise, -noise));
  }
  const Look look = replay_looks(outcomes, five_percent, 10, 10).at(0);
  EXPECT_EQ(look.controlled.mean, 10);
  EXPECT_EQ(look.controlled.standard_error, 0);
  EXPECT_DOUBLE_EQ(look.estimate.standard_error, 0.25 / 3);
}

// Student's interval of ten values 10 +- s at 95.7 % is 2.354 s / 3: s = 1 gives 7.8 %, s = 0.1 0.78 %.
TEST(Cohorts, TheControlledEstimateDecides) {
  Outcomes narrow, wide;
  for (int seed = 0; seed < 10; ++seed) {
    const double sign = seed % 2 == 0 ? 1 : -1;
    narrow.emplace_back(value(10 + sign, -0.9 * sign));
    wide.emplace_back(value(10 + 0.1 * sign, 0.9 * sign));
  }
  const Look converged = replay_looks(narrow, five_percent, 10, 20).at(0);
  EXPECT_EQ(converged.verdict, Verdict::converged);
  EXPECT_NEAR(relative_width(converged), 0.00785, 1e-5);
  const Look open = replay_looks(wide, five_percent, 10, 20).at(0);
  EXPECT_EQ(open.verdict, Verdict::more);
  EXPECT_NEAR(relative_width(open), 0.0785, 1e-4);
}

// Ten values 10 +- s: w = 2.354 s / 30 at 95.7 %. chi^2_0.02(9) = 2.532 (f = 3.554), chi^2_0.05(9) = 3.325 (f
// = 2.707).
TEST(Cohorts, ALookConvergesOnlyIfALargerSpreadWouldHaveDoneSoWithinTheMaximum) {
  // s = 0.6: w = 4.708 %, 10 (w (1 + w) / 5 %)^2 f = 34.6 seeds.
  const Outcomes outcomes = alternating(10, 10, 0.6);
  EXPECT_EQ(replay_looks(outcomes, five_percent, 10, 35).at(0).verdict, Verdict::converged);
  EXPECT_EQ(replay_looks(outcomes, five_percent, 10, 34).at(0).verdict, Verdict::more);
  // Between the maximum and a third of it the interval is no narrower than the tolerance.
  EXPECT_NEAR(replay_looks(outcomes, five_percent, 10, 35).at(0).controlled_half_width, 0.5, 1e-12);
  EXPECT_NEAR(replay_looks(outcomes, five_percent, 10, 104).at(0).controlled_half_width, 0.4708, 1e-4);
  EXPECT_NEAR(replay_looks(outcomes, five_percent, 10, 35).at(0).half_width, 0.4708, 1e-4);
}

// With a single look t(9, 0.975) = 2.262 and w = 2.262 s / 30.
TEST(Cohorts, TheLastLookIsConvergedNearMaximumOrCapped) {
  const auto last = [](double spread) {
    return replay_looks(alternating(10, 10, spread), five_percent, 10, 10).at(0);
  };
  // w (1 + w) sqrt(2.707) <= 5 % up to w = 2.95 %, s = 0.39.
  EXPECT_EQ(last(0.38).verdict, Verdict::converged);
  EXPECT_EQ(last(0.40).verdict, Verdict::converged_near_maximum);
  EXPECT_FALSE(is_converged(Verdict::converged_near_maximum));
  // w = 3.016 %, w (1 + w) sqrt(3.554) = 5.86 % of the mean.
  EXPECT_NEAR(last(0.40).controlled_half_width, 0.586, 1e-3);
  // Within the tolerance of some mean of the interval: w <= 5 % (1 + w), w <= 5.26 %, s = 0.698.
  EXPECT_EQ(last(0.69).verdict, Verdict::converged_near_maximum);
  EXPECT_EQ(last(0.71).verdict, Verdict::capped);
  EXPECT_NEAR(last(0.71).controlled_half_width, 2.262 * 0.71 / 3, 1e-3);
}

TEST(Cohorts, TheFirstRuleTookEveryLookWithinTheToleranceForConverged) {
  Target target = five_percent;
  target.rule = Target::first_rule;
  const Look look = replay_looks(alternating(10, 10, 0.6), target, 10, 11).at(0);
  EXPECT_EQ(look.verdict, Verdict::converged);
  EXPECT_NEAR(look.controlled_half_width, 0.4708, 1e-4);
}

TEST(Cohorts, IntervalsAreWidenedForRepeatedLooksOnly) {
  EXPECT_DOUBLE_EQ(adjusted_confidence(0.95, 10, 100), 0.957);
  EXPECT_DOUBLE_EQ(adjusted_confidence(0.90, 14, 100), 0.91);
  EXPECT_DOUBLE_EQ(adjusted_confidence(0.95, 10, 10), 0.95);
  // t(9, 0.975) = 2.262
  EXPECT_NEAR(replay_looks(alternating(10, 10, 0.3), five_percent, 10, 10).at(0).half_width, 0.2262, 1e-4);
}

// Seven values of 0 and one of 1: g = 2.268 (moments 1/8 and 7/8). A normal population of 8 shows a skewness
// of 0.752, three times less, and the loss is 2 * 0.0584 * 1.96 * 19.44 * 2.268^2 / (18 * 8) = 0.159.
TEST(Cohorts, ASkewedPopulationIsNoticed) {
  Outcomes skewed(8, value(10)), even = alternating(8, 10, 1);
  skewed[5] = value(11);
  const Look look = replay_looks(skewed, five_percent, 8, 8).at(0);
  EXPECT_NEAR(look.skewness, 2.268, 1e-3);
  EXPECT_TRUE(is_skewed(look, 0.95));
  EXPECT_FALSE(is_skewed(replay_looks(even, five_percent, 8, 8).at(0), 0.95));
  EXPECT_FALSE(is_skewed(replay_looks(Outcomes(8, value(10)), five_percent, 8, 8).at(0), 0.95));
  // The same skewness among many values costs nothing: 0.247 * 2.268^2 / 200 = 0.6 %.
  Outcomes many;
  for (int i = 0; i < 25; ++i) many.insert(many.end(), skewed.begin(), skewed.end());
  EXPECT_FALSE(is_skewed(replay_looks(many, five_percent, 200, 200).at(0), 0.95));
}

TEST(Cohorts, OutcomesBeyondTheDecidingLookChangeNothing) {
  const std::vector<Look> few = replay_looks(alternating(10, 10, 0.3), five_percent, 10, 100);
  Outcomes more = alternating(10, 10, 0.3);
  for (int i = 0; i < 30; ++i) more.emplace_back(i % 3 == 0 ? lost() : value(1000));
  const std::vector<Look> many = replay_looks(more, five_percent, 10, 100);
  ASSERT_EQ(many.size(), few.size());
  EXPECT_EQ(many[0].estimate.mean, few[0].estimate.mean);
}

// Seeds end in 200 random orders; after each one the looks are replayed from what is known by then. Every
// order ends with the same looks, bit for bit, and no look is ever taken back or changed on the way.
TEST(Cohorts, AnswerDoesNotDependOnTheOrderOfArrival) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal(10, 2.5);
  Outcomes truth;
  for (int seed = 0; seed < 60; ++seed) truth.emplace_back(value(normal(random)));
  truth[5] = lost();
  const std::vector<Look> expected = replay_looks(truth, five_percent, 10, 60);
  ASSERT_GE(expected.size(), 5U);

  std::vector<std::size_t> order(truth.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  for (int trial = 0; trial < 200; ++trial) {
    std::shuffle(order.begin(), order.end(), random);
    Outcomes known;
    std::size_t looks_so_far = 0;
    for (const std::size_t seed : order) {
      known.resize(std::max(known.size(), seed + 1));
      known[seed] = truth[seed];
      const std::vector<Look> looks = replay_looks(known, five_percent, 10, 60);
      ASSERT_GE(looks.size(), looks_so_far);
      looks_so_far = looks.size();
      for (std::size_t i = 0; i < looks.size(); ++i) {
        ASSERT_EQ(looks[i].estimate.mean, expected[i].estimate.mean);
        ASSERT_EQ(looks[i].half_width, expected[i].half_width);
        ASSERT_EQ(looks[i].verdict, expected[i].verdict);
      }
    }
    ASSERT_EQ(looks_so_far, expected.size());
  }
}

}  // namespace
}  // namespace peclet::runner
