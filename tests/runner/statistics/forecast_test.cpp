#include "runner/statistics/forecast.h"

#include <gtest/gtest.h>

#include <cmath>

#include "runner/campaign/number_text.h"
#include "runner/owner/progress.h"

namespace peclet::runner {
namespace {

const Target ten_percent{"relative_viscosity", 0.1, 0.95};

StopTest stop_test(int seeds, double mean, double half_width) {
  StopTest made;
  made.seeds = seeds;
  made.controlled = {seeds, mean, half_width / 2};
  made.controlled_half_width = half_width;
  return made;
}

TEST(Forecast, ExpectsTheMinimumBeforeTheFirstStopTest) {
  EXPECT_EQ(expected_seeds({}, ten_percent, 10, 100), 10);
}

// The half-width is 2 and may be 1, which needs 40 seeds: the stop test at 44, of 10, 13, 17, 22, 28, 35, 44.
TEST(Forecast, FourTimesTheSeedsHalveTheInterval) {
  EXPECT_EQ(expected_seeds({stop_test(10, 10, 2)}, ten_percent, 10, 1000), 44);
}

TEST(Forecast, NeverExpectsMoreThanTheMaximumOrLessThanTheNextStopTest) {
  EXPECT_EQ(expected_seeds({stop_test(10, 10, 50)}, ten_percent, 10, 100), 100);
  EXPECT_EQ(expected_seeds({stop_test(10, 10, 1.001)}, ten_percent, 10, 1000), 13);
}

TEST(Forecast, SaysNothingBeforeAnythingHasEnded) {
  EXPECT_EQ(time_to_go({PointForecast{}}, ten_percent, 10, 100, 2), std::nullopt);
}

PointForecast five_of_six_seconds() {
  PointForecast point;
  for (int i = 0; i < 5; ++i) point.cost.add(6);
  point.ended = 5;
  point.all_seeds = {{5, 10, 0.01}};
  return point;
}

// Two workers run five more seeds of 6 s in three rounds. Only the speed of the machine is uncertain.
TEST(Forecast, EqualCostsShareTheWorkers) {
  const std::optional<TimeToGo> left = time_to_go({five_of_six_seconds()}, ten_percent, 10, 100, 2);
  ASSERT_TRUE(left);
  EXPECT_DOUBLE_EQ(left->likely, 3 * 6);
  EXPECT_DOUBLE_EQ(left->lower, 3 * 6 / machine_allowance);
  EXPECT_DOUBLE_EQ(left->upper, 3 * 6 * machine_allowance);
}

TEST(Forecast, ScatteredCostsWidenTheRange) {
  PointForecast scattered = five_of_six_seconds();
  scattered.cost = {};
  for (const double seconds : {2.0, 10.0, 6.0, 3.0, 9.0}) scattered.cost.add(seconds);
  const std::optional<TimeToGo> sure = time_to_go({five_of_six_seconds()}, ten_percent, 10, 100, 1);
  const std::optional<TimeToGo> left = time_to_go({scattered}, ten_percent, 10, 100, 1);
  ASSERT_TRUE(left);
  EXPECT_DOUBLE_EQ(left->likely, sure->likely);
  EXPECT_LT(left->lower, sure->lower);
  EXPECT_GT(left->upper, sure->upper);
}

// Kaplan and Meier's estimate by hand: two seeds have ended after 2 and 4 s, one has run for 3 s. The share
// of seeds that last longer is 1 until 2 s, then 2/3 until 4 s.
TEST(Forecast, ARunningSeedCountsAsLongerThanItHasTaken) {
  Cost ended;
  ended.add(4);
  ended.add(2);
  EXPECT_DOUBLE_EQ(mean_cost(ended, {{3, {}}}), 2 + 2 * 2.0 / 3);
  EXPECT_DOUBLE_EQ(mean_cost(ended, {}), 3);
}

// Two of eight seeds have jammed after a minute. The six others have made a thirteenth of their steps in two
// minutes, so three quarters of the seeds take 26 minutes.
TEST(Forecast, SeedsThatEndFirstDoNotSpeakForTheOthers) {
  PointForecast point;
  for (int i = 0; i < 2; ++i) point.cost.add(60);
  point.ended = 2;
  point.running = 6;
  point.unfinished.assign(6, {120, 1560});
  const double mean = 0.25 * 60 + 0.75 * 1560;
  EXPECT_DOUBLE_EQ(mean_cost(point.cost, point.unfinished), mean);
  const std::optional<TimeToGo> left = time_to_go({point}, ten_percent, 10, 100, 6);
  ASSERT_TRUE(left);
  EXPECT_NEAR(left->likely, 1.5 * mean, 1e-9);  // eight more seeds in two rounds, half of one round done
  EXPECT_LE(left->lower, 1560);
  EXPECT_GE(left->upper, 2 * 1560);
}

// A running seed without a known rate counts as long as the longest running one.
TEST(Forecast, ASeedWithoutARateIsTakenForAsLongAsTheOthers) {
  Cost ended;
  ended.add(10);
  EXPECT_DOUBLE_EQ(mean_cost(ended, {{20, 100}, {20, {}}}), (10 + 100 + 100) / 3.0);
  EXPECT_DOUBLE_EQ(mean_cost(ended, {{20, {}}}), 15);
}

// A running seed is not done: the last seed may have just begun.
TEST(Forecast, SeedsThatRunAreStillToCome) {
  PointForecast point = five_of_six_seconds();
  point.ended = 9;
  point.running = 1;
  const std::optional<TimeToGo> left = time_to_go({point}, ten_percent, 10, 100, 4);
  ASSERT_TRUE(left);
  EXPECT_DOUBLE_EQ(left->likely, 3);
  EXPECT_LE(left->lower, 1);
  EXPECT_GE(left->upper, 6);
}

// Ten values have a half-width of about 16 %, and 10 % is the tolerance: 26 seeds are likely. The true
// variance may be 9 / 4.17 = 2.2 or 9 / 14.7 = 0.61 times that of the ten values.
TEST(Forecast, TheNumberOfSeedsIsNotKnownBetterThanTheSpread) {
  PointForecast point;
  for (int i = 0; i < 10; ++i) point.cost.add(6);
  point.ended = 10;
  point.all_seeds = {{10, 10, 0.7}};
  const std::optional<TimeToGo> left = time_to_go({point}, ten_percent, 10, 1000, 1);
  ASSERT_TRUE(left);
  EXPECT_GT(left->upper / left->likely, 2 * machine_allowance);
  EXPECT_GT(left->likely / left->lower, 1.5 * machine_allowance);
}

TEST(Forecast, BeforeTwoValuesAnyNumberOfSeedsMayBeNeeded) {
  PointForecast point;
  point.cost.add(6);
  point.ended = 1;
  point.all_seeds = {{1, 10, std::nan("")}};
  EXPECT_GE(time_to_go({point}, ten_percent, 10, 100, 1)->upper, 99 * 6);
}

TEST(Forecast, DecidedPointsCostNothing) {
  PointForecast decided;
  decided.cost.add(1000);
  decided.decided = true;
  EXPECT_EQ(time_to_go({decided}, ten_percent, 10, 100, 1)->likely, 0);
}

TEST(Forecast, IsOneTextAndOneJson) {
  EXPECT_EQ(to_string(TimeToGo{720, 600, 1080}), "12 min to go (10 min to 18 min)");
  EXPECT_EQ(to_string(TimeToGo{}), "");
  EXPECT_EQ(to_json(TimeToGo{3, 2, 4}), Json({{"likely", 3.0}, {"low", 2.0}, {"high", 4.0}}));
  EXPECT_EQ(to_json(std::optional<TimeToGo>()), nullptr);
}

TEST(Progress, SaysDurationsAsPeopleDo) {
  EXPECT_EQ(duration_text(0), "0 s");
  EXPECT_EQ(duration_text(45.4), "45 s");
  EXPECT_EQ(duration_text(720), "12 min");
  EXPECT_EQ(duration_text(12000), "3 h 20 min");
  EXPECT_EQ(duration_text(187200), "2 d 4 h");
}

TEST(Progress, LineHoldsTheBudget) {
  RunReport report;
  report.spent_seconds = 1800;
  report.budget_seconds = 7200;
  EXPECT_EQ(progress_line(report), "points 0/0 converged | seeds 0/0 | budget 0.5 of 2 h");
}

TEST(Progress, LineHoldsPointsSeedsRateAndTimeToGo) {
  RunReport report;
  report.points = 6;
  report.decided = 3;
  report.converged = 2;
  report.seeds_ended = 143;
  report.seeds_wanted = 210;
  report.results = 20;
  report.elapsed = 120;
  report.workers = 2;
  report.busy = 1;
  report.to_go = TimeToGo{720, 600, 1080};
  EXPECT_EQ(
      progress_line(report),
      "points 2/6 converged, 1 not | seeds 143/210 | 10/min | 12 min to go (10 min to 18 min) | workers 1/2");
}

}  // namespace
}  // namespace peclet::runner
