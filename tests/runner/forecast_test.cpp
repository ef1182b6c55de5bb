#include "runner/forecast.h"

#include <gtest/gtest.h>

#include "runner/progress.h"

namespace peclet::runner {
namespace {

const Target ten_percent{"relative_viscosity", 0.1, 0.95};

Look look(int seeds, double mean, double half_width) {
  Look made;
  made.seeds = seeds;
  made.controlled = {seeds, mean, half_width / 2};
  made.controlled_half_width = half_width;
  return made;
}

TEST(Forecast, ExpectsTheMinimumBeforeTheFirstLook) {
  EXPECT_EQ(expected_seeds({}, ten_percent, 10, 100), 10);
}

// Half-width 2 where 1 is tolerated: four times the seeds, at the first look that has them (50 -> 63 ... of
// 10, 13, 17, 22, 28, 35, 44).
TEST(Forecast, FourTimesTheSeedsHalveTheInterval) {
  EXPECT_EQ(expected_seeds({look(10, 10, 2)}, ten_percent, 10, 100), 44);
}

TEST(Forecast, NeverExpectsMoreThanTheMaximumOrLessThanTheNextLook) {
  EXPECT_EQ(expected_seeds({look(10, 10, 50)}, ten_percent, 10, 100), 100);
  EXPECT_EQ(expected_seeds({look(10, 10, 1.001)}, ten_percent, 10, 100), 13);
}

TEST(Forecast, SaysNothingBeforeAnythingHasEnded) {
  EXPECT_EQ(time_to_go({PointForecast{}}, ten_percent, 10, 100, 2), std::nullopt);
}

TEST(Forecast, EqualCostsShareTheWorkers) {
  PointForecast point;
  for (int i = 0; i < 5; ++i) point.cost.add(6);
  point.begun = 5;
  const std::optional<TimeToGo> left = time_to_go({point}, ten_percent, 10, 100, 2);
  ASSERT_TRUE(left);
  EXPECT_DOUBLE_EQ(left->likely, 5 * 6 / 2.0);
  EXPECT_DOUBLE_EQ(left->low, left->likely);
  EXPECT_DOUBLE_EQ(left->high, left->likely);
}

TEST(Forecast, ScatteredCostsWidenTheRange) {
  PointForecast point;
  for (const double seconds : {2.0, 10.0}) point.cost.add(seconds);
  const std::optional<TimeToGo> left = time_to_go({point}, ten_percent, 10, 100, 1);
  ASSERT_TRUE(left);
  EXPECT_LT(left->low, left->likely);
  EXPECT_GT(left->high, left->likely);
}

TEST(Forecast, DecidedPointsCostNothing) {
  PointForecast decided;
  decided.cost.add(1000);
  decided.decided = true;
  EXPECT_EQ(time_to_go({decided}, ten_percent, 10, 100, 1)->likely, 0);
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
