#include "runner/statistics/curve_stop_tests.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "runner/statistics/scheduler.h"

namespace peclet::runner {
namespace {

using Outcomes = std::vector<std::optional<Outcome>>;

constexpr int minimum = 8, maximum = 200;
const std::vector<double> axis{0.1, 1, 10, 100, 1000, 1e4};

Target along_axis(double tolerance) {
  Target target{"viscosity", tolerance, 0.95};
  target.tolerance.over = "/peclet";
  return target;
}

// Returns seeds with normal values; the same for the same point.
Outcomes outcomes(std::size_t point, double mean, double spread, int count = maximum) {
  std::mt19937_64 random(point + 1);
  std::normal_distribution<double> normal;
  Outcomes all;
  for (int seed = 0; seed < count; ++seed) all.emplace_back(Outcome{{mean * (1 + spread * normal(random))}});
  return all;
}

// Returns the outcomes of a curve that is constant but for one point.
std::vector<Outcomes> curve(double spread, double at_one = 5, std::size_t one = 3) {
  std::vector<Outcomes> all;
  all.reserve(axis.size());
  for (std::size_t i = 0; i < axis.size(); ++i) all.push_back(outcomes(i, i == one ? at_one : 5, spread));
  return all;
}

std::vector<CurveStopTests::Member> members(const std::vector<Outcomes>& all) {
  std::vector<CurveStopTests::Member> found;
  found.reserve(all.size());
  for (const Outcomes& of_point : all) found.push_back({&of_point});
  return found;
}

CurveStopTests made(const std::vector<Outcomes>& all, const Target& target, int most = maximum,
                    const std::vector<double>& spheres = {}) {
  CurveStopTests stop_tests({{}, axis, spheres}, target, minimum, most);
  stop_tests.advance(members(all));
  return stop_tests;
}

const StopTest& last(const CurveStopTests& stop_tests, std::size_t point) {
  return stop_tests.stop_tests(point).back();
}

TEST(CurveStopTests, ABandDecidesBeforeTheIntervalsOfThePoints) {
  const std::vector<Outcomes> all = curve(0.15);
  const CurveStopTests joint = made(all, along_axis(0.05));
  int seeds = 0, seeds_alone = 0, by_curve = 0;
  for (std::size_t i = 0; i < axis.size(); ++i) {
    const StopTest& stop_test = last(joint, i);
    const ObservableStopTest& one = stop_test.each.at(0);
    EXPECT_EQ(stop_test.verdict, Verdict::converged);
    EXPECT_FALSE(stop_test.near_maximum);
    EXPECT_TRUE(one.share <= 1 || one.curve->is_met());
    EXPECT_LT(one.curve->low, one.curve->mean);
    EXPECT_NEAR(one.curve->share, (one.curve->high / one.curve->mean - 1) / 0.05, 1e-12);
    by_curve += is_decided_by_curve(stop_test) ? 1 : 0;
    seeds += stop_test.seeds;
    seeds_alone += replay_stop_tests(all[i], Target{"viscosity", 0.05, 0.95}, minimum, maximum).back().seeds;
  }
  EXPECT_GT(by_curve, 3);
  EXPECT_LT(seeds, seeds_alone);
}

TEST(CurveStopTests, ThoseOfARoundWaitForOneAnother) {
  std::vector<Outcomes> all = curve(0.15);
  const Outcomes late = std::exchange(all[2], {});
  CurveStopTests stop_tests({{}, axis}, along_axis(0.05), minimum, maximum);
  EXPECT_EQ(stop_tests.advance(members(all)), (std::vector<std::size_t>{0, 1, 3, 4, 5}));
  EXPECT_TRUE(stop_tests.is_waiting(0));
  EXPECT_FALSE(stop_tests.is_waiting(2));
  EXPECT_EQ(last(stop_tests, 0).verdict, Verdict::more);
  EXPECT_TRUE(waits_for_curve(last(stop_tests, 0)));
  EXPECT_FALSE(last(stop_tests, 0).each.at(0).curve->is_known());
  EXPECT_TRUE(stop_tests.advance(members(all)).empty());
  all[2] = late;
  EXPECT_EQ(stop_tests.advance(members(all)).size(), axis.size());
  EXPECT_EQ(last(stop_tests, 0).verdict, Verdict::converged);
}

TEST(CurveStopTests, ACancelledPointIsNotWaitedFor) {
  std::vector<Outcomes> all = curve(0.15);
  all[2].clear();
  std::vector<CurveStopTests::Member> without = members(all);
  without[2].cancelled = true;
  CurveStopTests stop_tests({{}, axis}, along_axis(0.05), minimum, maximum);
  stop_tests.advance(without);
  EXPECT_TRUE(stop_tests.stop_tests(2).empty());
  EXPECT_EQ(last(stop_tests, 0).verdict, Verdict::converged);
}

// The point in the middle lies 30 % below the others, and each is soon known to 2 %.
TEST(CurveStopTests, ACurveThatAPointContradictsDecidesNothing) {
  const std::vector<Outcomes> all = curve(0.05, 3.5);
  const CurveStopTests joint = made(all, along_axis(0.01));
  bool refused = false;
  for (std::size_t i = 0; i < axis.size(); ++i) {
    for (const StopTest& stop_test : joint.stop_tests(i)) {
      const CurveBand& band = *stop_test.each.at(0).curve;
      refused = refused || band.refused;
      EXPECT_FALSE(band.refused && band.is_met());
    }
    EXPECT_TRUE(last(joint, i).each.at(0).share <= 1 || last(joint, i).each.at(0).curve->is_met());
  }
  EXPECT_TRUE(refused);
  const CurveBand& odd = *last(joint, 3).each.at(0).curve;
  EXPECT_NEAR(odd.mean, 3.5, 0.1);
}

TEST(CurveStopTests, AMeanBelowZeroDecidesAlone) {
  std::vector<Outcomes> all = curve(0.1);
  all[1] = outcomes(1, -5, 0.1);
  const CurveStopTests joint = made(all, along_axis(0.05));
  EXPECT_FALSE(last(joint, 1).each.at(0).curve->is_known());
  EXPECT_LE(last(joint, 1).each.at(0).share, 1);
  EXPECT_TRUE(last(joint, 0).each.at(0).curve->is_known());
}

TEST(CurveStopTests, WhatIsNotMetAtTheMaximumIsCapped) {
  const std::vector<Outcomes> all = curve(0.5);
  const CurveStopTests joint = made(all, along_axis(0.02), 20);
  for (std::size_t i = 0; i < axis.size(); ++i) {
    EXPECT_EQ(last(joint, i).verdict, Verdict::capped);
    EXPECT_EQ(last(joint, i).seeds, 20);
  }
}

TEST(CurveStopTests, LostSeedsAreSaid) {
  std::vector<Outcomes> all = curve(0.15);
  all[4][3] = Outcome{};
  all[5].assign(minimum, Outcome{});  // all seeds of the first cohort
  const CurveStopTests joint = made(all, along_axis(0.05));
  EXPECT_EQ(last(joint, 4).verdict, Verdict::converged_with_losses);
  EXPECT_EQ(last(joint, 5).verdict, Verdict::failed);
  EXPECT_EQ(last(joint, 0).verdict, Verdict::converged);
}

// A second criterion without a curve is met by a point's own seeds only.
TEST(CurveStopTests, OtherCriteriaMustBeMetToo) {
  std::vector<Outcomes> all = curve(0.15);
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Outcomes other = outcomes(10 + i, 1, i == 2 ? 0.2 : 0.01);
    for (std::size_t seed = 0; seed < other.size(); ++seed) all[i][seed]->further = {*other[seed]};
  }
  Target target = along_axis(0.05);
  target.also = {{"pressure", 0.05}};
  const CurveStopTests joint = made(all, target);
  EXPECT_LE(last(joint, 2).each.at(1).share, 1);
  EXPECT_FALSE(last(joint, 2).each.at(1).curve);
  EXPECT_GT(last(joint, 2).seeds, last(joint, 1).seeds);
  EXPECT_EQ(last(joint, 2).verdict, Verdict::converged);
}

// Where a neighbour's seeds take a thousandth of the steps, or have a thousandth of the spheres, it makes
// more stop tests than its own mean needs.
TEST(CurveStopTests, CheapNeighboursHelp) {
  const auto seeds_at = [](double steps, double spheres = 1) {
    std::vector<Outcomes> all;
    for (std::size_t i = 0; i < axis.size(); ++i) {
      all.push_back(outcomes(i, 5, i == 3 ? 0.4 : 0.2));
      for (std::optional<Outcome>& outcome : all.back()) outcome->steps = i == 3 ? steps : 1;
    }
    const CurveStopTests joint = made(all, along_axis(0.05), maximum, {1, 1, 1, spheres, 1, 1});
    return std::pair(last(joint, 3).seeds, last(joint, 2).seeds + last(joint, 4).seeds);
  };
  const auto [dear, beside_dear] = seeds_at(1000);
  const auto [even, beside_even] = seeds_at(1);
  EXPECT_LE(dear, even);
  EXPECT_GT(beside_dear, beside_even);
  EXPECT_EQ(seeds_at(1, 1000), std::pair(dear, beside_dear));
}

// Returns what is stored of the stop tests of all points.
Json stored(const Scheduler& scheduler) {
  Json all = Json::array();
  for (int point = 0; point < scheduler.points(); ++point) {
    Json& of_point = all.emplace_back(Json::array());
    for (const StopTest& stop_test : scheduler.stop_tests(point))
      of_point.push_back(stop_test_json(stop_test));
  }
  return all;
}

Scheduler fresh() {
  std::vector<std::size_t> points(axis.size());
  for (std::size_t i = 0; i < points.size(); ++i) points[i] = i;
  return Scheduler(std::vector<Outcomes>(axis.size()), along_axis(0.05), minimum, maximum, {{points, axis}});
}

// Seeds end in another order with each number of workers.
TEST(CurveStopTests, DoNotDependOnTheOrderOfTheResults) {
  const std::vector<Outcomes> all = curve(0.2);
  Json first;
  for (const std::size_t workers : {1U, 3U, 20U}) {
    Scheduler scheduler = fresh();
    std::mt19937_64 random(workers);
    std::vector<SeedId> running;
    while (!scheduler.finished()) {
      while (running.size() < workers) {
        const std::optional<SeedId> next = scheduler.next();
        if (!next) break;
        scheduler.begin(*next);
        running.push_back(*next);
      }
      std::swap(running[random() % running.size()], running.back());
      const SeedId id = running.back();
      running.pop_back();
      scheduler.end(id, *all[static_cast<std::size_t>(id.point)][static_cast<std::size_t>(id.seed)]);
    }
    if (first.is_null()) first = stored(scheduler);
    EXPECT_EQ(stored(scheduler), first) << workers;
  }
}

// A late result of a given-up seed makes the stop tests anew, as if it had been there from the start.
TEST(CurveStopTests, ALateResultReplacesALostSeed) {
  const std::vector<Outcomes> all = curve(0.2);
  Scheduler late = fresh(), in_time = fresh();
  for (Scheduler* scheduler : {&late, &in_time}) {
    while (const std::optional<SeedId> next = scheduler->next()) {
      scheduler->begin(*next);
      const bool is_lost = scheduler == &late && *next == SeedId{2, 1};
      scheduler->end(
          *next, is_lost ? Outcome{}
                         : *all[static_cast<std::size_t>(next->point)][static_cast<std::size_t>(next->seed)]);
    }
  }
  EXPECT_NE(stored(late), stored(in_time));
  EXPECT_EQ(late.end({2, 1}, *all[2][1]).size(), axis.size());
  while (const std::optional<SeedId> next = late.next()) {
    late.begin(*next);
    late.end(*next, *all[static_cast<std::size_t>(next->point)][static_cast<std::size_t>(next->seed)]);
  }
  EXPECT_EQ(stored(late), stored(in_time));
}

TEST(CurveStopTests, AreStoredAsTheyAre) {
  const StopTest stop_test = last(made(curve(0.15), along_axis(0.05)), 0);
  const Json stored = observables_json(stop_test);
  StopTest read;
  read.each = observables_of(Json::parse(stored.dump()));
  EXPECT_EQ(observables_json(read), stored);
}

}  // namespace
}  // namespace peclet::runner
