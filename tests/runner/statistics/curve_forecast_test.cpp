// Tests how many seeds the points of a curve are expected to need.
#include "runner/statistics/curve_forecast.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "runner/statistics/forecast.h"

namespace peclet::runner {
namespace {

constexpr int fewest = 8, most = 800;

Curve six_points() { return {{0, 1, 2, 3, 4, 5}, {0.1, 1, 10, 100, 1000, 1e4}}; }

Target over_peclet(double tolerance) {
  Target target{"viscosity", tolerance, 0.95};
  target.tolerance.over = "/peclet";
  return target;
}

// Points with eight seeds of this relative spread, and a mean of 5.
std::vector<SeedsSoFar> points(double spread, double cost = 1) {
  return std::vector<SeedsSoFar>(6, {{{8, 5, 5 * spread / std::sqrt(8)}}, 8, cost});
}

int alone(double spread, const Target& target) {
  StopRule rule(target, fewest, most);
  return stop_after(points(spread).front().estimates, 8, rule);
}

std::vector<int> seeds_on_curve(const Curve& curve, const std::vector<SeedsSoFar>& known,
                                const Target& target, int minimum, int maximum,
                                const TruthOf& truth_of = {}) {
  return CurveForecast(curve, known, target, minimum, maximum).stops(truth_of);
}

int sum(const std::vector<int>& seeds) { return std::accumulate(seeds.begin(), seeds.end(), 0); }

TEST(CurveForecast, PointsThatAreMetNeedNoMore) {
  EXPECT_EQ(seeds_on_curve(six_points(), points(0.01), over_peclet(0.05), fewest, most),
            std::vector<int>(6, 8));
}

// Were the points a constant and nothing else, all of their seeds would count as one point's: a sixth each.
TEST(CurveForecast, APointNeedsAtMostItsOwnSeedsAndAtLeastItsShareOfAConstant) {
  const Target target = over_peclet(0.05);
  const int seeds = sum(seeds_on_curve(six_points(), points(0.3), target, fewest, most));
  EXPECT_LT(seeds, 6 * alone(0.3, target));
  const double of_a_constant = std::pow(1.96 * 0.3 / 0.05, 2);
  EXPECT_GT(seeds, of_a_constant);
}

// The first point costs as much as a thousand of the others. It is told by its neighbours.
TEST(CurveForecast, ExpensivePointsAreToldByTheirNeighbours) {
  std::vector<SeedsSoFar> one_dear = points(0.3);
  one_dear.front().cost = 1000;
  const std::vector<int> equal = seeds_on_curve(six_points(), points(0.3), over_peclet(0.1), fewest, most);
  const std::vector<int> seeds = seeds_on_curve(six_points(), one_dear, over_peclet(0.1), fewest, most);
  EXPECT_LT(seeds[0], equal[0]);
  EXPECT_GT(seeds[1], equal[1]);
}

TEST(CurveForecast, RefusedCurvesLeaveEachPointToItself) {
  std::vector<SeedsSoFar> jump = points(0.05);
  jump[3].estimates.front().mean = 50;
  jump[3].estimates.front().standard_error *= 10;
  const Target target = over_peclet(0.02);
  EXPECT_EQ(seeds_on_curve(six_points(), jump, target, fewest, most),
            std::vector<int>(6, alone(0.05, target)));
}

TEST(CurveForecast, CriteriaWithoutACurveAreThoseOfThePoints) {
  Target target = over_peclet(0.05);
  target.also.push_back({"pressure", 0.05});
  std::vector<SeedsSoFar> both = points(0.01);
  for (SeedsSoFar& point : both) point.estimates.push_back(points(0.1).front().estimates.front());
  EXPECT_EQ(seeds_on_curve(six_points(), both, target, fewest, most),
            std::vector<int>(6, alone(0.1, Target{"pressure", 0.05, 0.95})));
}

TEST(CurveForecast, PointsThatAreDoneGetNoMore) {
  std::vector<SeedsSoFar> one_done = points(0.3);
  one_done[2].is_done = true;
  EXPECT_EQ(seeds_on_curve(six_points(), one_done, over_peclet(0.05), fewest, most)[2], 8);
}

TEST(CurveForecast, ALargerTrueSpreadNeedsMore) {
  const auto at = [](double quantile) {
    return sum(seeds_on_curve(six_points(), points(0.3), over_peclet(0.05), fewest, most,
                              [&](int values) { return truth_at(values - 1, quantile); }));
  };
  EXPECT_LT(at(0.1), at(0.9));
}

TEST(CurveForecast, TheTimeToGoIsThatOfTheCurve) {
  const Target target = over_peclet(0.05);
  PointForecast point;
  point.cost = Cost(std::vector<double>(8, 1.0));
  point.all_seeds = points(0.3).front().estimates;
  point.ended = 8;
  const std::vector<PointForecast> all(6, point);
  const int seeds = sum(seeds_on_curve(six_points(), points(0.3), target, fewest, most));
  const std::optional<TimeToGo> left = time_to_go(all, target, fewest, most, 1, {six_points()});
  ASSERT_TRUE(left);
  EXPECT_DOUBLE_EQ(left->likely, seeds - 6 * 8);
  EXPECT_LT(left->lower, left->likely);
  EXPECT_GT(left->upper, left->likely);
  EXPECT_LT(left->likely, time_to_go(all, target, fewest, most, 1)->likely);
}

}  // namespace
}  // namespace peclet::runner
