// Tests the prediction of the number of seeds of a point from its first seeds.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "runner/statistics/forecast.h"

namespace peclet::runner {
namespace {

using Outcomes = std::vector<std::optional<Outcome>>;

Target target(double tolerance) { return {"relative_viscosity", tolerance, 0.95}; }

// Returns values of mean 1 with this sample standard deviation, for even `count`.
Outcomes values(int count, double deviation) {
  const double step = deviation * std::sqrt((count - 1.0) / count);
  Outcomes outcomes;
  for (int seed = 0; seed < count; ++seed) {
    outcomes.emplace_back(Outcome{{seed % 2 == 0 ? 1 + step : 1 - step}});
  }
  return outcomes;
}

struct Record {
  // Shares of the campaigns whose deciding stop test lay within the range, not above and not below the likely
  // one.
  double held = 0, not_above = 0, not_below = 0;
};

// Predicts points with normal seeds of mean 1 from their pilots, and runs them by the stop rule.
Record judge(int campaigns, int pilot, double spread, double tolerance, unsigned start) {
  constexpr int minimum = 8, maximum = 4000;
  std::mt19937_64 random(start);
  std::normal_distribution<double> value(1, spread);
  Record counts;
  for (int judged = 0; judged < campaigns;) {
    Outcomes outcomes;
    const auto stop_tests_up_to = [&](int seeds) {
      while (std::ssize(outcomes) < seeds) outcomes.emplace_back(Outcome{{value(random)}});
      return replay_stop_tests(outcomes, target(tolerance), minimum, maximum);
    };
    const std::vector<StopTest> first = stop_tests_up_to(pilot);
    if (!first.empty() && first.back().verdict != Verdict::more) continue;
    const Prediction made = predict(outcomes, target(tolerance), minimum, maximum);
    int actual = 0;
    for (const int seeds : stop_test_schedule(minimum, maximum)) {
      actual = seeds;
      if (stop_tests_up_to(seeds).back().verdict != Verdict::more) break;
    }
    ++judged;
    counts.held += made.seeds.lower <= actual && actual <= made.seeds.upper ? 1 : 0;
    counts.not_above += actual <= made.seeds.likely ? 1 : 0;
    counts.not_below += actual >= made.seeds.likely ? 1 : 0;
  }
  return {counts.held / campaigns, counts.not_above / campaigns, counts.not_below / campaigns};
}

// About 43 seeds are needed. With 600 campaigns the share that a range of 95 % holds is below 91 % with a
// probability of 1e-5 (4.5 standard errors). It is more than 95 % because stop tests are discrete: 96 to 98 %
// after a pilot of four, 98 to 99.7 % after one of eight, with the seeds 1 to 20. A range that always holds
// fails after four. The likely number is a median: half of the campaigns or more do not end above it, and
// half or more not below; 41 % is 4.5 standard errors less. The seeds are fixed.
TEST(Prediction, RangeAndMedianHoldTheDecidingStopTestAsOftenAsTheySay) {
  for (const int pilot : {4, 8}) {
    const Record record = judge(600, pilot, 0.2, 0.06, 20260201);
    EXPECT_GT(record.held, 0.91) << pilot;
    if (pilot == 4) {
      EXPECT_LT(record.held, 0.995);
    }
    EXPECT_GT(record.not_above, 0.41) << pilot;
    EXPECT_GT(record.not_below, 0.41) << pilot;
  }
}

// (1.96 * 0.2 / 0.03)^2 = 171 seeds are between the stop tests at 155 and 194. The variance of 40 values is
// known to 2 sqrt(2 / 39) = 45 %, which gives 94 to 248 seeds. The bounds are one stop test wider.
TEST(Prediction, ManyPilotSeedsGiveTheSeedsOfTheFormula) {
  const Prediction made = predict(values(40, 0.2), target(0.03), 40, 2000);
  EXPECT_GE(made.seeds.likely, 155);
  EXPECT_LE(made.seeds.likely, 194);
  EXPECT_GE(made.seeds.lower, 79);
  EXPECT_LE(made.seeds.upper, 305);
  EXPECT_EQ(made.pilot, 40);
  EXPECT_EQ(made.capped, 0);
}

TEST(Prediction, FewPilotSeedsSayLess) {
  const Prediction four = predict(values(4, 0.2), target(0.03), 8, 4000);
  const Prediction eight = predict(values(8, 0.2), target(0.03), 8, 4000);
  EXPECT_LT(four.seeds.lower, eight.seeds.lower);
  EXPECT_GT(four.seeds.upper, eight.seeds.upper);
}

TEST(Prediction, EqualValuesTellNoSpread) {
  const Prediction made = predict(values(4, 0), target(0.03), 8, 100);
  EXPECT_EQ(made.obstacle, Obstacle::no_spread);
}

TEST(Prediction, ATargetOutOfReachEndsAtTheMaximumWithoutConvergence) {
  const Prediction made = predict(values(4, 0.2), target(1e-5), 8, 100);
  EXPECT_EQ(made.seeds.lower, 100);
  EXPECT_NEAR(made.capped, 1, 1e-9);
}

TEST(Prediction, TheControlledEstimateIsPredicted) {
  Outcomes hidden = values(4, 0.2);
  double left = 1e-3;
  for (std::optional<Outcome>& outcome : hidden) outcome->control = 1 - outcome->value + (left = -left);
  EXPECT_EQ(predict(hidden, target(0.03), 8, 100).seeds.upper, 8);
}

TEST(Prediction, WhereHalfTheSeedsAreLostTwiceAsManyAreNeeded) {
  Outcomes with_losses;
  for (const std::optional<Outcome>& outcome : values(20, 0.2)) {
    with_losses.push_back(outcome);
    with_losses.emplace_back(Outcome{});
  }
  const double all = predict(values(20, 0.2), target(0.03), 40, 4000).seeds.likely;
  const Prediction half = predict(with_losses, target(0.03), 40, 4000);
  EXPECT_EQ(half.lost, 20);
  EXPECT_NEAR(half.seeds.likely / all, 2, 0.5);  // one stop test more or less
}

// scipy.stats.chi2.ppf([0.025, 0.5, 0.975], 3) = 0.2158, 2.366, 9.348; for 30 degrees 16.79 and 46.98.
TEST(Prediction, VariancesAreThoseThatTheDegreesOfFreedomLeaveOpen) {
  EXPECT_NEAR(truth_at(3, 0.025).variance, 3 / 9.348, 1e-4);
  EXPECT_NEAR(truth_at(3, 0.5).variance, 3 / 2.366, 1e-3);
  EXPECT_NEAR(truth_at(3, 0.975).variance, 3 / 0.2158, 1e-2);
  EXPECT_NEAR(truth_at(30, 0.025).variance, 30 / 46.98, 1e-4);
  EXPECT_NEAR(truth_at(30, 0.975).variance, 30 / 16.79, 1e-3);
  EXPECT_EQ(truth_at(std::nan(""), 0.975).variance, 1);
}

// scipy.stats.beta.ppf(0.025, 8.5, 0.5) = 0.7384: if 0.74 of the seeds flow, a half-width of 0.05 needs about
// 300 seeds. If all flow, Clopper and Pearson's interval is narrow enough with 0.025^(1/n) = 0.95, n = 72.
TEST(Prediction, AShareMayBeFartherFromCertainThanTheSeedsSay) {
  Outcome one{{1}};
  one.is_share = true;
  const Outcomes flowing(8, one);
  const Prediction made = predict(flowing, {"flowing", Tolerance::absolute(0.05), 0.95}, 8, 4000);
  EXPECT_EQ(made.obstacle, Obstacle::none);
  EXPECT_GE(made.seeds.lower, 72);
  EXPECT_LE(made.seeds.lower, 90);
  EXPECT_GE(made.seeds.upper, 250);
  EXPECT_LE(made.seeds.upper, 430);
}

TEST(Prediction, AFixedNumberOfSeedsIsSure) {
  const Prediction made = predict({}, {"relative_viscosity", Tolerance::none(), 0.95}, 16, 16);
  EXPECT_EQ(made.obstacle, Obstacle::none);
  EXPECT_EQ(made.seeds.lower, 16);
  EXPECT_EQ(made.seeds.likely, 16);
  EXPECT_EQ(made.seeds.upper, 16);
  EXPECT_EQ(made.capped, 0);
}

TEST(Prediction, SaysWhyThereIsNone) {
  Outcomes one = values(4, 0.2);
  one[1].reset();  // seeds after it do not count
  EXPECT_EQ(predict(one, target(0.03), 8, 100).obstacle, Obstacle::too_few);
  const Prediction lost = predict(Outcomes(4, Outcome{}), target(0.03), 8, 100);
  EXPECT_EQ(lost.obstacle, Obstacle::lost);
  EXPECT_EQ(obstacle_text(lost), "4 of 4 seeds are lost");
  // Two standard errors of four values are their standard deviation.
  EXPECT_EQ(predict(values(4, 0.99), target(0.03), 8, 100).obstacle, Obstacle::none);
  EXPECT_EQ(predict(values(4, 1.01), target(0.03), 8, 100).obstacle, Obstacle::near_zero);
}

}  // namespace
}  // namespace peclet::runner
