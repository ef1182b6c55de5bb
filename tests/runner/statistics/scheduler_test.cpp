#include "runner/statistics/scheduler.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "tests/runner/statistics/scheduled_points.h"

namespace peclet::runner {
namespace {

TEST(Scheduler, KnowsTheMeanOfWhatHasEndedInAnyOrder) {
  Scheduler scheduler = fresh(1, 8);
  EXPECT_EQ(scheduler.all_seeds(0)[0].count, 0);
  for (const int seed : {5, 0, 3}) scheduler.end({0, seed}, value(seed));
  scheduler.end({0, 1}, Outcome{});
  EXPECT_EQ(scheduler.all_seeds(0)[0].count, 3);
  EXPECT_DOUBLE_EQ(scheduler.all_seeds(0)[0].mean, 8.0 / 3);
  // Deviations 7/3, -8/3 and 1/3: variance 19/3, of the mean a third of it.
  EXPECT_DOUBLE_EQ(scheduler.all_seeds(0)[0].standard_error, std::sqrt(19.0) / 3);
  EXPECT_EQ(scheduler.all_ended(0), 4);
  scheduler.end({0, 1}, value(8.0 / 3));  // its late result
  EXPECT_EQ(scheduler.all_seeds(0)[0].count, 4);
  EXPECT_EQ(scheduler.all_ended(0), 4);
}

TEST(Scheduler, UnderACeilingOnlyTheFirstSeedsGo) {
  Scheduler scheduler = fresh(2);
  scheduler.set_ceiling(2);
  for (const SeedId id : {SeedId{0, 0}, SeedId{1, 0}, SeedId{0, 1}, SeedId{1, 1}})
    EXPECT_EQ(take(scheduler), id);
  EXPECT_EQ(scheduler.next(), std::nullopt);
  for (int seed = 0; seed < 2; ++seed) scheduler.end({0, seed}, steady_outcome(seed));
  EXPECT_FALSE(scheduler.finished());
  for (int seed = 0; seed < 2; ++seed) scheduler.end({1, seed}, steady_outcome(seed));
  EXPECT_TRUE(scheduler.finished());
  EXPECT_FALSE(scheduler.decided(0));
}

// With a fixed number of realisations no seed is extra, and lost seeds are not replaced.
TEST(Scheduler, GivesEveryPointTheFixedNumberOfSeeds) {
  const Target target{"relative_viscosity", Tolerance::none(), 0.95};
  Scheduler scheduler(Outcomes(2), target, 6, 6);
  for (int seed = 0; seed < 12; ++seed) take(scheduler);
  EXPECT_EQ(scheduler.next(), std::nullopt);
  for (int seed = 0; seed < 6; ++seed) {
    EXPECT_FALSE(scheduler.finished());
    scheduler.end({0, seed}, scattered(seed));
    scheduler.end({1, seed}, seed == 3 ? Outcome{} : steady_outcome(seed));
  }
  EXPECT_TRUE(scheduler.finished());
  EXPECT_EQ(scheduler.stop_tests(0).back().verdict, Verdict::complete);
  EXPECT_EQ(scheduler.stop_tests(1).back().verdict, Verdict::complete_with_losses);
}

TEST(Scheduler, PriorityGoesBeforeCost) {
  Scheduler scheduler = fresh(2);
  scheduler.set_cost(0, 1);
  scheduler.set_cost(1, 100);
  scheduler.set_priority(0, 1);
  for (int seed = 0; seed < 4; ++seed) EXPECT_EQ(take(scheduler), (SeedId{0, seed}));
  EXPECT_EQ(take(scheduler), (SeedId{1, 0})) << "needed seeds go before extra ones";
}

TEST(Scheduler, ACancelledPointGetsNoSeedsAndHoldsNothingUp) {
  Scheduler scheduler = fresh(2);
  for (int i = 0; i < 4; ++i) take(scheduler);
  scheduler.set_cancelled(0, true);
  EXPECT_EQ(take(scheduler).point, 1);
  EXPECT_EQ(take(scheduler).point, 1);
  for (int seed = 0; seed < 4; ++seed) scheduler.end({1, seed}, steady_outcome(seed));
  EXPECT_TRUE(scheduler.finished());
  scheduler.end({0, 0}, steady_outcome(0));  // a running seed may still end
  scheduler.set_cancelled(0, false);
  EXPECT_FALSE(scheduler.finished());
  EXPECT_EQ(take(scheduler), (SeedId{0, 2}));
}

TEST(Scheduler, RunsAheadByOneStopTestWhenAllNeededSeedsAreOutAndNoFurther) {
  Scheduler scheduler = fresh(1);
  for (int seed = 0; seed < 5; ++seed) EXPECT_EQ(take(scheduler), (SeedId{0, seed}));
  EXPECT_EQ(scheduler.next(), std::nullopt);
}

TEST(Scheduler, NeededSeedsGoBeforeExtraOnes) {
  Scheduler scheduler = fresh(2);
  for (int i = 0; i < 8; ++i) EXPECT_LT(take(scheduler).seed, 4);
  EXPECT_EQ(take(scheduler), (SeedId{0, 4}));
}

TEST(Scheduler, ASeedThatComesBackIsTheNextToGo) {
  Scheduler scheduler = fresh(1);
  for (int i = 0; i < 4; ++i) take(scheduler);
  scheduler.give_back({0, 1});
  EXPECT_EQ(take(scheduler), (SeedId{0, 1}));
}

TEST(Scheduler, TestsOnlyClosedCohorts) {
  Scheduler scheduler = fresh(1);
  for (int i = 0; i < 5; ++i) take(scheduler);
  for (const int seed : {4, 3, 2, 1}) {
    EXPECT_TRUE(scheduler.end({0, seed}, steady_outcome(seed)).empty());
    EXPECT_TRUE(scheduler.stop_tests(0).empty());
  }
  EXPECT_FALSE(scheduler.end({0, 0}, steady_outcome(0)).empty());
  ASSERT_EQ(scheduler.stop_tests(0).size(), 1U);
  EXPECT_EQ(scheduler.stop_tests(0)[0].seeds, 4);  // seed 4 is extra
  EXPECT_TRUE(scheduler.finished());
}

TEST(Scheduler, ADecidedPointGetsNoMoreSeeds) {
  Scheduler scheduler = fresh(2);
  for (int i = 0; i < 8; ++i) take(scheduler);
  for (int seed = 0; seed < 4; ++seed) scheduler.end({0, seed}, steady_outcome(seed));
  EXPECT_TRUE(scheduler.decided(0));
  EXPECT_EQ(take(scheduler).point, 1);
  EXPECT_EQ(scheduler.next(), std::nullopt);
}

TEST(Scheduler, AnUndecidedStopTestAsksForTheSeedsOfTheNextOne) {
  Scheduler scheduler = fresh(1);
  for (int seed = 0; seed < 4; ++seed) {
    take(scheduler);
    scheduler.end({0, seed}, scattered(seed));
  }
  EXPECT_EQ(scheduler.wanted(0), 5);
  EXPECT_EQ(scheduler.ended(0), 4);
  EXPECT_FALSE(scheduler.finished());
}

TEST(Scheduler, StopsAtTheMaximum) {
  Scheduler scheduler = fresh(1, 4, 6);
  for (int seed = 0; seed < 6; ++seed) {
    take(scheduler);
    scheduler.end({0, seed}, scattered(seed));
  }
  EXPECT_TRUE(scheduler.finished());
  EXPECT_EQ(scheduler.stop_tests(0).back().verdict, Verdict::capped);
  EXPECT_EQ(scheduler.next(), std::nullopt);
}

TEST(Scheduler, ATighterToleranceReopensAPointAndRunsNothingTwice) {
  Outcomes known(1);
  for (int seed = 0; seed < 7; ++seed) known[0].push_back(steady_outcome(seed));
  Scheduler loose(known, five_percent, 4, 40);
  EXPECT_TRUE(loose.finished());
  Scheduler tight(known, {"relative_viscosity", 1e-6, 0.95}, 4, 40);
  EXPECT_FALSE(tight.finished());
  EXPECT_EQ(tight.stop_tests(0).size(), 3U);  // at 4, 5 and 7: extra seeds are used
  EXPECT_EQ(take(tight), (SeedId{0, 7}));
}

TEST(Scheduler, ALowerMaximumLeavesLaterSeedsOutOfTheStopTests) {
  Outcomes known(1);
  for (int seed = 0; seed < 20; ++seed) known[0].push_back(scattered(seed));
  const Scheduler scheduler(known, five_percent, 4, 9);
  EXPECT_TRUE(scheduler.finished());
  EXPECT_EQ(scheduler.stop_tests(0).back().seeds, 9);
}

TEST(Scheduler, ALateResultOfALostSeedRepeatsTheStopTest) {
  Scheduler scheduler = fresh(1);
  for (int seed = 0; seed < 4; ++seed) {
    take(scheduler);
    scheduler.end({0, seed}, seed == 2 ? Outcome{} : steady_outcome(seed));
  }
  EXPECT_EQ(scheduler.stop_tests(0).back().verdict, Verdict::converged_with_losses);
  EXPECT_FALSE(scheduler.end({0, 2}, steady_outcome(2)).empty());
  EXPECT_EQ(scheduler.stop_tests(0).back().verdict, Verdict::converged);
}

// Lists of all outcomes up to the maximum would take 80 GB.
TEST(Scheduler, AMaximumThatNoPointComesNearCostsNothing) {
  constexpr int points = 2000, maximum = 1'000'000;
  Scheduler scheduler = fresh(points, 4, maximum);
  for (int i = 0; i < 4 * points; ++i) {
    const SeedId id = take(scheduler);
    scheduler.end(id, scattered(id.seed));
  }
  EXPECT_EQ(scheduler.begun(points - 1), 4);
  EXPECT_EQ(scheduler.ended(points - 1), 4);
  EXPECT_EQ(scheduler.wanted(points - 1), 5);
}

// Returns the answers of a scheduler on its only point, and the seeds that it gives out once `beyond` ends.
std::vector<double> answers(Scheduler scheduler, int beyond) {
  const Estimate all_seeds = scheduler.all_seeds(0)[0];
  std::vector<double> all{scheduler.begun(0) + 0.0,       scheduler.all_ended(0) + 0.0,
                          scheduler.ended(0) + 0.0,       scheduler.wanted(0) + 0.0,
                          all_seeds.count + 0.0,          all_seeds.count > 0 ? all_seeds.mean : 0,
                          scheduler.expected_seconds({1})};
  for (const StopTest& stop_test : scheduler.stop_tests(0)) all.push_back(stop_test.estimate.mean);
  scheduler.end({0, beyond}, scattered(beyond));
  while (const std::optional<SeedId> id = scheduler.next()) {
    scheduler.begin(*id);
    all.push_back(id->seed);
  }
  return all;
}

// After a failure the scheduler is created again from the database. Seeds have ended in any order, the first
// one twice (its late result), and one runs.
TEST(Scheduler, CreatedAgainFromTheOutcomesItContinuesAsTheFirstOne) {
  constexpr int out = 21;
  for (const std::vector<int>& order : {std::vector{0, 1, 2, 3, 4}, {4, 3, 2, 1, 0}, {2, 39, 0, 3, 1, 17}}) {
    Scheduler heard = fresh(1);
    heard.set_cost(0, 3);
    heard.begin({0, out});
    heard.end({0, order.front()}, Outcome{});
    std::vector<std::optional<Outcome>> known;
    for (const int seed : order) {
      heard.end({0, seed}, scattered(seed));
      known.resize(std::max(known.size(), static_cast<std::size_t>(seed) + 1));
      known[static_cast<std::size_t>(seed)] = scattered(seed);
      Scheduler again({known}, five_percent, 4, 40);
      again.set_cost(0, 3);
      again.begin({0, out});
      const std::vector<double> one = answers(heard, 7), other = answers(again, 7);
      ASSERT_EQ(one.size(), other.size()) << seed;
      for (std::size_t i = 0; i < one.size(); ++i) EXPECT_NEAR(one[i], other[i], 1e-12) << seed << ' ' << i;
    }
  }
}

// Any number of workers, with seeds that end in any order, gives the same decisions.
TEST(Scheduler, StopTestsDoNotDependOnWorkersOrOrderOfArrival) {
  const auto outcome = [](SeedId id) {
    std::mt19937 generator(static_cast<unsigned>(1000 * id.point + id.seed));
    if (generator() % 10 == 0) return Outcome{};
    return value(10 + std::normal_distribution<double>(0, 1 + id.point)(generator));
  };
  std::vector<std::vector<StopTest>> expected;
  for (unsigned trial = 0; trial < 40; ++trial) {
    std::mt19937 generator(trial);
    const std::size_t workers = trial == 0 ? 1 : 1 + generator() % 16;
    Scheduler scheduler = fresh(3, 4, 60);
    std::vector<SeedId> out;
    while (!scheduler.finished()) {
      while (out.size() < workers && scheduler.next()) out.push_back(take(scheduler));
      ASSERT_FALSE(out.empty());
      std::swap(out[generator() % out.size()], out.back());
      if (generator() % 5 == 0) {
        scheduler.give_back(out.back());
      } else {
        scheduler.end(out.back(), outcome(out.back()));
      }
      out.pop_back();
    }
    for (int point = 0; point < 3; ++point) {
      const std::vector<StopTest>& stop_tests = scheduler.stop_tests(point);
      if (trial == 0) {
        expected.push_back(stop_tests);
        continue;
      }
      const std::vector<StopTest>& first = expected[static_cast<std::size_t>(point)];
      ASSERT_EQ(stop_tests.size(), first.size()) << "trial " << trial;
      EXPECT_EQ(stop_tests.back().seeds, first.back().seeds);
      EXPECT_EQ(stop_tests.back().verdict, first.back().verdict);
      EXPECT_EQ(stop_tests.back().estimate.mean, first.back().estimate.mean);  // the same bits
    }
  }
}

}  // namespace
}  // namespace peclet::runner
