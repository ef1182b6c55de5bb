// Tests which seed goes first, with a budget and without.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "runner/statistics/scheduler.h"
#include "tests/runner/statistics/scheduled_points.h"

namespace peclet::runner {
namespace {

TEST(Scheduler, PointsComeForwardTogetherInTheOrderOfTheSweep) {
  Scheduler scheduler = fresh(3);
  std::vector<SeedId> taken(7);
  for (SeedId& id : taken) id = take(scheduler);
  EXPECT_EQ(taken, (std::vector<SeedId>{{0, 0}, {1, 0}, {2, 0}, {0, 1}, {1, 1}, {2, 1}, {0, 2}}));
}

TEST(Scheduler, ThePointFurthestBehindGoesFirst) {
  Outcomes known(2);
  for (int seed = 0; seed < 3; ++seed) known[0].push_back(steady_outcome(seed));
  Scheduler scheduler(known, five_percent, 4, 40);
  EXPECT_EQ(take(scheduler), (SeedId{1, 0}));
  EXPECT_EQ(take(scheduler), (SeedId{1, 1}));
  EXPECT_EQ(take(scheduler), (SeedId{1, 2}));
  EXPECT_EQ(take(scheduler), (SeedId{0, 3}));
}

// In each round of the first pass, every point gets one seed, in the order of the costs.
TEST(Scheduler, FirstAllPointsGetSomeSeedsTheCheapestFirst) {
  std::vector<double> costs{0.2, 3, 0.5, 100};
  std::sort(costs.begin(), costs.end());
  do {
    Scheduler scheduler = fresh(4, 10);
    for (int point = 0; point < 4; ++point) scheduler.set_cost(point, costs[static_cast<std::size_t>(point)]);
    for (int seed = 0; seed < Scheduler::seeds_of_pass; ++seed) {
      double last = 0;
      for (int i = 0; i < 4; ++i) {
        const SeedId id = take(scheduler);
        EXPECT_EQ(id.seed, seed);
        EXPECT_GT(costs[static_cast<std::size_t>(id.point)], last);
        last = costs[static_cast<std::size_t>(id.point)];
      }
    }
    EXPECT_EQ(costs[static_cast<std::size_t>(take(scheduler).point)], 100) << "then the longest";
  } while (std::next_permutation(costs.begin(), costs.end()));
}

// Each point needs 8 seeds and has 4 after the first pass.
TEST(Scheduler, ThePointWithMostCostToComeGoesFirst) {
  Scheduler scheduler = fresh(3, 8);
  for (int i = 0; i < 12; ++i) take(scheduler);
  scheduler.set_cost(0, 1);
  scheduler.set_cost(1, 3);  // 12 s, then 9, 6 and 3
  scheduler.set_cost(2, 2);  // 8 s, then 6, 4 and 2
  std::vector<int> taken(8);
  for (int& point : taken) point = take(scheduler).point;
  EXPECT_EQ(taken, (std::vector<int>{1, 1, 2, 1, 2, 0, 2, 0}));
}

TEST(Scheduler, APointWithoutKnownCostIsTakenForAnAverageOne) {
  Scheduler scheduler = fresh(3, 8);
  for (int i = 0; i < 12; ++i) take(scheduler);
  scheduler.set_cost(0, 1);
  scheduler.set_cost(2, 4);
  EXPECT_EQ(take(scheduler).point, 2);  // 16 s, then 12, 8; the second point 4 * 2.5 = 10 s
  EXPECT_EQ(take(scheduler).point, 2);
  EXPECT_EQ(take(scheduler).point, 1);
}

TEST(Scheduler, ThePointThatNeedsMoreSeedsGoesFirst) {
  // Half-widths of 6 % and about 50 %: the first point needs a few more seeds, the second the maximum.
  const Outcomes known{alternating(4, 10, 0.3), alternating(4, 10, 3)};
  Scheduler scheduler(known, five_percent, 4, 40);
  ASSERT_EQ(scheduler.stop_tests(0).back().verdict, Verdict::more);
  EXPECT_EQ(take(scheduler), (SeedId{1, 4}));
  EXPECT_EQ(take(scheduler), (SeedId{0, 4})) << "seeds that are needed go before extra ones";
}

TEST(Scheduler, UnderABudgetThePointWhoseErrorFallsFastestGoesFirst) {
  // Half-widths of 6 and 60 % after 4 seeds: a seed of the second point has ten times the effect.
  const Outcomes known{alternating(4, 10, 0.3), alternating(4, 10, 3)};
  for (const double seconds : {1.0, 20.0}) {
    Scheduler scheduler(known, five_percent, 4, 40);
    scheduler.set_allocation(Allocation::steepest_first);
    scheduler.set_cost(0, 1);
    scheduler.set_cost(1, seconds);
    EXPECT_EQ(take(scheduler).point, seconds > 10 ? 0 : 1);
  }
}

TEST(Scheduler, UnderABudgetPointsWithoutAStopTestGoFirst) {
  const Outcomes known{alternating(4, 10, 3), {}};
  Scheduler scheduler(known, five_percent, 4, 40);
  scheduler.set_allocation(Allocation::steepest_first);
  for (int i = 0; i < 4; ++i) EXPECT_EQ(take(scheduler).point, 1);
  EXPECT_EQ(take(scheduler).point, 0);
}

TEST(Scheduler, UnderABudgetAStopTestOnceBegunIsCompleted) {
  // Half-widths of about 9 % with 9 seeds each: the second point waits until the first one has its 12 seeds.
  const Outcomes known{alternating(9, 10, 1), alternating(9, 10, 0.95)};
  Scheduler scheduler(known, five_percent, 4, 40);
  scheduler.set_allocation(Allocation::steepest_first);
  ASSERT_EQ(scheduler.wanted(0), 12);
  for (int seed = 9; seed < 12; ++seed) EXPECT_EQ(take(scheduler), (SeedId{0, seed}));
  EXPECT_EQ(take(scheduler), (SeedId{1, 9}));
}

TEST(Scheduler, UnderABudgetOnlySeedsGoThatItPaysFor) {
  Scheduler scheduler = fresh(2);
  scheduler.set_allocation(Allocation::steepest_first);
  scheduler.set_cost(0, 10);
  scheduler.set_cost(1, 3);
  EXPECT_EQ(scheduler.next_within(100), (SeedId{1, 0})) << "the cheapest of the points without a stop test";
  for (int seed = 0; seed < 4; ++seed) scheduler.begin({1, seed});
  EXPECT_EQ(scheduler.next_within(10), (SeedId{0, 0}));
  EXPECT_EQ(scheduler.next_within(9.9), std::nullopt);
  for (int seed = 0; seed < 4; ++seed) scheduler.begin({0, seed});
  EXPECT_EQ(scheduler.next_within(100), std::nullopt) << "no point runs ahead";
}

TEST(Scheduler, UnderABudgetAStopTestThatItPaysForAsAWholeGoesFirst) {
  // Both points have 9 seeds and need three more. The first one is wider, but its stop test costs 24 s.
  const Outcomes known{alternating(9, 10, 5), alternating(9, 10, 1)};
  Scheduler scheduler(known, five_percent, 4, 40);
  scheduler.set_allocation(Allocation::steepest_first);
  scheduler.set_cost(0, 8);
  scheduler.set_cost(1, 4);
  EXPECT_EQ(scheduler.next_within(24), (SeedId{0, 9}));
  EXPECT_EQ(scheduler.next_within(20), (SeedId{1, 9}));
  EXPECT_EQ(scheduler.next_within(9), (SeedId{0, 9}))
      << "if it pays for no stop test, seeds of the wider one";
}

TEST(Scheduler, SeedsThatMayNotRunAreLeftOut) {
  Scheduler scheduler = fresh(2);
  scheduler.begin({0, 0});
  const auto is_odd = [](SeedId id) { return id.seed % 2 == 1; };
  EXPECT_EQ(scheduler.next(), (SeedId{1, 0}));
  EXPECT_EQ(scheduler.next(is_odd), (SeedId{1, 1}));
  EXPECT_EQ(scheduler.next([](SeedId id) { return id.point > 1; }), std::nullopt);
  EXPECT_EQ(scheduler.next_within(1, is_odd), (SeedId{1, 1}));
}

TEST(Scheduler, KnowsWhetherASeedMayBeNext) {
  Scheduler scheduler = fresh(2);  // the first stop test is at 4 seeds
  scheduler.begin({0, 1});
  scheduler.set_cancelled(1, true);
  EXPECT_TRUE(scheduler.may_be_next({0, 0}, {}));
  EXPECT_FALSE(scheduler.may_be_next({0, 1}, {})) << "it runs";
  EXPECT_TRUE(scheduler.may_be_next({0, 4}, {})) << "ahead of the stop test";
  EXPECT_FALSE(scheduler.may_be_next({0, 4}, 100)) << "a budget does not run ahead";
  EXPECT_FALSE(scheduler.may_be_next({0, 39}, {}));
  EXPECT_FALSE(scheduler.may_be_next({1, 0}, {})) << "cancelled";
  scheduler.set_cost(0, 5);
  EXPECT_TRUE(scheduler.may_be_next({0, 0}, 5));
  EXPECT_FALSE(scheduler.may_be_next({0, 0}, 4.9));
}

TEST(Scheduler, CostsThatAreNotKnownFollowFromTheWork) {
  Scheduler scheduler = fresh(3);
  for (int point = 0; point < 3; ++point) scheduler.set_work(point, std::pow(10, point));
  EXPECT_EQ(scheduler.expected_seconds({1, 1, 1}), 0);
  EXPECT_EQ(scheduler.next_within(1e-6), (SeedId{0, 0})) << "its cost is not known yet";
  EXPECT_EQ(scheduler.next_within(0), std::nullopt) << "no budget is left";
  scheduler.set_cost(1, 5);
  EXPECT_DOUBLE_EQ(scheduler.expected_seconds({1, 0, 0}), 0.5);
  EXPECT_DOUBLE_EQ(scheduler.expected_seconds({0, 0, 1}), 50);
  EXPECT_DOUBLE_EQ(scheduler.expected_seconds({2, 1, 3}), 2 * 0.5 + 5 + 3 * 50);
  EXPECT_EQ(scheduler.next_within(0.51), (SeedId{0, 0}));
  EXPECT_EQ(scheduler.next_within(0.49), std::nullopt);
}

// A visit to all points for each of them would be 4e10 visits, which takes too long for a test.
TEST(Scheduler, TheCostOfRunningSeedsOfManyPointsTakesOnePass) {
  constexpr int many = 200'000;
  Scheduler scheduler(Outcomes(many), five_percent, 4, 4);
  for (int point = 0; point < many; ++point) scheduler.set_work(point, 1);
  scheduler.set_cost(0, 3);
  EXPECT_DOUBLE_EQ(scheduler.expected_seconds(std::vector<int>(many, 1)), 3.0 * many);
}

}  // namespace
}  // namespace peclet::runner
