// Tests targets of several observables: a point is done when each of them meets its tolerance.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "runner/statistics/cohorts.h"
#include "runner/statistics/forecast.h"
#include "runner/statistics/scheduler.h"

namespace peclet::runner {
namespace {

using Outcomes = std::vector<std::optional<Outcome>>;

// Returns the target of a viscosity to 5 % and another criterion.
Target viscosity_and(const Criterion& other) {
  Target target{"viscosity", 0.05, 0.95};
  target.also = {other};
  return target;
}

Tolerance relative_to(const std::string& measure, double share) {
  Tolerance tolerance(share);
  tolerance.relative_to = measure;
  return tolerance;
}

// Returns seeds with the viscosity 10 - 0.1, 10 + 0.1 in turn, and another observable `mean` - `spread`,
// `mean` + `spread`. For even n the standard error is the spread over sqrt(n - 1).
Outcomes both_alternating(int count, double mean, double spread) {
  Outcomes outcomes;
  for (int seed = 0; seed < count; ++seed) {
    const double sign = seed % 2 == 0 ? -1 : 1;
    Outcome outcome{{10 + 0.1 * sign}};
    outcome.further = {{mean + spread * sign}};
    outcomes.emplace_back(outcome);
  }
  return outcomes;
}

TEST(SeveralTargets, ObserveWhatTheyAimAtAndWhatTheyMeasureBy) {
  Target target = viscosity_and({"N1", relative_to("viscosity", 0.05)});
  target.also.push_back({"N2", relative_to("pressure", 0.05)});
  target.also.push_back({"N3", relative_to("pressure", 0.05)});
  EXPECT_EQ(target.observables(), (std::vector<std::string>{"viscosity", "N1", "N2", "N3", "pressure"}));
  EXPECT_EQ(to_string(target),
            "viscosity to 5 %, N1 to 5 % of viscosity, N2 to 5 % of pressure, N3 to 5 % of pressure");
  EXPECT_EQ(pointer_of(target, "viscosity"), "/target/observable");
  EXPECT_EQ(pointer_of(target, "N2"), "/target/also/1/observable");
  EXPECT_EQ(pointer_of(target, "pressure"), "/target/also/1/relative_to");
  EXPECT_EQ(target_of("viscosity", criterion_json(target), 0.95), target);
}

TEST(SeveralTargets, TheLessFavourableVerdictCounts) {
  EXPECT_EQ(less_favourable(Verdict::converged, Verdict::converged), Verdict::converged);
  EXPECT_EQ(less_favourable(Verdict::converged_with_losses, Verdict::converged),
            Verdict::converged_with_losses);
  EXPECT_EQ(less_favourable(Verdict::converged_with_losses, Verdict::capped), Verdict::capped);
  EXPECT_EQ(less_favourable(Verdict::converged, Verdict::more), Verdict::more);
  EXPECT_EQ(less_favourable(Verdict::failed, Verdict::more), Verdict::failed);
}

// At 95.7 %, t(9) = 2.354 and t(27) = 2.126: the other half-width is 0.392 at 10 seeds and 0.205 at 28.
TEST(SeveralTargets, APointGoesOnUntilAllAreWithinTheirTolerances) {
  const Target target = viscosity_and({"other", Tolerance::absolute(0.21)});
  const std::vector<StopTest> stop_tests = replay_stop_tests(both_alternating(100, 5, 0.5), target, 10, 1000);
  ASSERT_EQ(stop_tests.size(), 5U);
  EXPECT_EQ(stop_tests.front().verdict, Verdict::more);
  EXPECT_EQ(stop_tests.front().each[0].verdict, Verdict::converged);
  EXPECT_EQ(stop_tests.front().each[1].verdict, Verdict::more);
  EXPECT_NEAR(stop_tests.front().each[1].half_width, 0.392, 1e-3);
  EXPECT_NEAR(stop_tests.front().each[1].share, 0.392 / 0.21, 5e-3);
  EXPECT_NEAR(largest_share(stop_tests.front(), target), 0.392 / 0.21, 5e-3);
  EXPECT_EQ(stop_tests.back().seeds, 28);
  EXPECT_EQ(stop_tests.back().verdict, Verdict::converged);
  EXPECT_NEAR(stop_tests.back().each[1].half_width, 0.205, 1e-3);
  EXPECT_DOUBLE_EQ(stop_tests.back().each[1].estimate.mean, 5);
  EXPECT_DOUBLE_EQ(stop_tests.back().controlled.mean, 10);
}

// A mean of 0 has no relative width of its own. 5 % of the viscosity is allowed, less its half-width 0.0785.
TEST(SeveralTargets, OneMayBeMeasuredByAnother) {
  const Target target = viscosity_and({"N1", relative_to("viscosity", 0.05)});
  const std::vector<StopTest> stop_tests = replay_stop_tests(both_alternating(100, 0, 0.5), target, 10, 1000);
  ASSERT_EQ(stop_tests.size(), 1U);
  EXPECT_EQ(stop_tests[0].verdict, Verdict::converged);
  EXPECT_NEAR(stop_tests[0].each[1].share, 0.392 / (0.05 * (10 - 0.0785)), 2e-3);
}

TEST(SeveralTargets, WhatOnlyMeasuresNeedsNoInterval) {
  const Target target{"N1", relative_to("viscosity", 0.05), 0.95};
  Outcomes outcomes;
  for (int seed = 0; seed < 10; ++seed) {
    Outcome outcome{{seed % 2 == 0 ? -0.5 : 0.5}};
    outcome.further = {{10.0}};
    outcomes.emplace_back(outcome);
  }
  const StopTest stop_test = replay_stop_tests(outcomes, target, 10, 10).at(0);
  EXPECT_TRUE(std::isnan(stop_test.each[1].half_width));
  EXPECT_EQ(stop_test.verdict, Verdict::converged);
  EXPECT_TRUE(without_interval(stop_test, target).empty());
}

// The viscosity 10 +- s has a half-width of 2.354 s / 3, which is 5 at s = 6.37: the tolerance is then 5 % of
// 10 - 5. The half-width of N1 is 2.354 * 0.5 / 3 = 0.392: within 5 % of 10, and of 10 less at most 2.1.
TEST(SeveralTargets, TheErrorOfTheMeasureCounts) {
  const auto stop_test_at = [](double spread) {
    Target target{"N1", relative_to("viscosity", 0.05), 0.95};
    Outcomes outcomes;
    for (int seed = 0; seed < 10; ++seed) {
      const double sign = seed % 2 == 0 ? -1 : 1;
      Outcome outcome{{0.5 * sign}};
      outcome.further = {{10 + spread * sign}};
      outcomes.emplace_back(outcome);
    }
    return replay_stop_tests(outcomes, target, 10, 10000).at(0);
  };
  EXPECT_EQ(stop_test_at(0).verdict, Verdict::converged);  // a constant is exact
  EXPECT_NEAR(stop_test_at(0).each[0].share, 0.392 / 0.5, 1e-3);
  EXPECT_EQ(stop_test_at(2.6).verdict, Verdict::converged);
  EXPECT_EQ(stop_test_at(2.8).verdict, Verdict::more);
  EXPECT_EQ(stop_test_at(6.37).verdict, Verdict::more);
  EXPECT_NEAR(stop_test_at(6.37).each[1].half_width, 5, 2e-2);
  EXPECT_NEAR(stop_test_at(6.37).each[0].share, 0.392 / 0.25, 1e-2);
  EXPECT_EQ(stop_test_at(20).verdict, Verdict::more);  // it may be 0
}

// The half-width of N1 at 10 seeds is 0.392, and its mean is 0.
TEST(SeveralTargets, AFloorIsEnoughForAMeanOfZero) {
  Tolerance tolerance = 0.05;
  EXPECT_EQ(replay_stop_tests(both_alternating(10, 0, 0.5), viscosity_and({"N1", tolerance}), 10, 1000)
                .back()
                .verdict,
            Verdict::more);
  tolerance.floor = 0.4;
  const StopTest stop_test =
      replay_stop_tests(both_alternating(10, 0, 0.5), viscosity_and({"N1", tolerance}), 10, 1000).back();
  EXPECT_EQ(stop_test.verdict, Verdict::converged);
  EXPECT_NEAR(stop_test.each[1].share, 0.392 / 0.4, 3e-3);
}

// The other observable may be zero, so the floor is the tolerance.
TEST(SeveralTargets, AFloorNeedsNoMeasure) {
  Tolerance tolerance = relative_to("other", 0.05);
  tolerance.floor = 0.5;
  const Target target{"viscosity", tolerance, 0.95};
  const StopTest stop_test = replay_stop_tests(both_alternating(10, 0, 0.5), target, 10, 1000).back();
  EXPECT_EQ(stop_test.verdict, Verdict::converged);
  EXPECT_NEAR(stop_test.each[0].share, 2.354 * 0.1 / 3 / 0.5, 1e-3);
}

// An observable to which a tolerance is only relative has an interval but no verdict, and delays nothing.
TEST(SeveralTargets, AMeasureNeedsNoPrecision) {
  Target target{"N1", relative_to("viscosity", 0.05), 0.95};
  Outcomes outcomes;
  for (const std::optional<Outcome>& other : both_alternating(10, 10, 3)) {
    Outcome outcome{{other->value - 10}};
    outcome.further = other->further;
    outcomes.emplace_back(outcome);
  }
  const std::vector<StopTest> stop_tests = replay_stop_tests(outcomes, target, 10, 1000);
  ASSERT_EQ(stop_tests.size(), 1U);
  EXPECT_EQ(stop_tests[0].verdict, Verdict::converged);
  EXPECT_EQ(stop_tests[0].each[1].verdict, std::nullopt);
  EXPECT_NEAR(stop_tests[0].each[1].half_width, 2.354 * 3 / 3, 2e-3);
  EXPECT_NEAR(stop_tests[0].each[0].share, 2.354 * 0.1 / 3 / (0.05 * (10 - 2.354)), 1e-3);
}

TEST(SeveralTargets, ASeedWithoutOneOfThemIsLostToThatOne) {
  const Target target = viscosity_and({"other", Tolerance::absolute(1)});
  Outcomes outcomes = both_alternating(10, 5, 0.1);
  outcomes[3]->further = {Observation{}};
  const std::vector<StopTest> stop_tests = replay_stop_tests(outcomes, target, 10, 1000);
  EXPECT_EQ(stop_tests.back().verdict, Verdict::converged_with_losses);
  EXPECT_EQ(stop_tests.back().lost, 0);
  EXPECT_EQ(stop_tests.back().each[0].verdict, Verdict::converged);
  EXPECT_EQ(stop_tests.back().each[1].estimate.count, 9);
  for (std::optional<Outcome>& outcome : outcomes) outcome->further = {Observation{}};
  EXPECT_EQ(replay_stop_tests(outcomes, target, 10, 1000).back().verdict, Verdict::failed);
}

TEST(SeveralTargets, OneThatIsNotMetCapsThePoint) {
  const Target target = viscosity_and({"other", Tolerance::absolute(0.01)});
  const StopTest last = replay_stop_tests(both_alternating(13, 5, 0.5), target, 10, 13).back();
  EXPECT_EQ(last.verdict, Verdict::capped);
  EXPECT_EQ(last.each[0].verdict, Verdict::converged);
  EXPECT_EQ(last.each[1].verdict, Verdict::capped);
}

TEST(SeveralTargets, ATransientOfAnyIsOneOfTheStopTest) {
  const Target target = viscosity_and({"other", Tolerance::absolute(1)});
  Outcomes outcomes = both_alternating(10, 5, 0.001);
  for (std::optional<Outcome>& outcome : outcomes) {
    outcome->first_quarter = outcome->first_half = outcome->value;
    outcome->further[0].first_quarter = outcome->further[0].first_half = outcome->further[0].value + 0.1;
  }
  const StopTest stop_test = replay_stop_tests(outcomes, target, 10, 1000).back();
  EXPECT_TRUE(stop_test.transient);
  EXPECT_FALSE(stop_test.each[0].transient);
  EXPECT_TRUE(stop_test.each[1].transient);
  outcomes[0]->further[0].first_half = std::nan("");
  EXPECT_FALSE(replay_stop_tests(outcomes, target, 10, 1000).back().untested);
  for (std::optional<Outcome>& outcome : outcomes) outcome->further[0].first_half = std::nan("");
  EXPECT_TRUE(replay_stop_tests(outcomes, target, 10, 1000).back().untested);
}

// The viscosity alone would stop at the first stop test. The other half-width is t(n - 1) 0.527 / sqrt(n):
// 0.103 at the stop test of 109 seeds (t = 2.047), and 0.092 at that of 137.
TEST(SeveralTargets, TheHardestToKnowTellsHowManySeedsToExpect) {
  const Target target = viscosity_and({"other", Tolerance::absolute(0.1)});
  const Outcomes outcomes = both_alternating(10, 5, 0.5);
  const int expected = expected_seeds(replay_stop_tests(outcomes, target, 10, 10000), target, 10, 10000);
  EXPECT_EQ(expected, 137);
  const Target alone{"viscosity", 0.05, 0.95};
  const Prediction together = predict(outcomes, target, 20, 10000);
  EXPECT_EQ(predict(outcomes, alone, 20, 10000).seeds.likely, 20);
  EXPECT_GE(together.seeds.likely, 87);
  EXPECT_LE(together.seeds.likely, 215);
  Scheduler scheduler({outcomes}, target, 10, 10000);
  EXPECT_FALSE(scheduler.finished());
  ASSERT_EQ(scheduler.all_seeds(0).size(), 2U);
  EXPECT_DOUBLE_EQ(scheduler.all_seeds(0)[1].mean, 5);
  EXPECT_TRUE(Scheduler({outcomes}, alone, 10, 10000).finished());
}

TEST(SeveralTargets, ATimeToGoIsThatOfTheHardest) {
  PointForecast point;
  for (int i = 0; i < 10; ++i) point.cost.add(6);
  point.ended = 10;
  point.all_seeds = {{10, 10, 0.1 / 3}, {10, 5, 0.5 / 3}};
  const Target target = viscosity_and({"other", Tolerance::absolute(0.1)});
  const std::optional<TimeToGo> left = time_to_go({point}, target, 10, 10000, 1);
  ASSERT_TRUE(left);
  EXPECT_GE(left->likely, 99 * 6);
  point.all_seeds[1].standard_error = 0.001;
  EXPECT_LT(time_to_go({point}, target, 10, 10000, 1)->likely, 10 * 6);
}

// Each interval holds its mean at least as often as with a single criterion, because a point continues after
// one interval is narrow for the first time: 93.7 % to 95 %, with a standard error of 0.5 % for 2000.
TEST(SeveralTargets, EachIntervalIsHonest) {
  std::mt19937_64 random(20261123);
  std::normal_distribution<double> viscosities(1, 0.2), others(0, 1);
  Target target{"viscosity", 0.07, 0.95};
  target.also = {{"other", Tolerance::absolute(0.35)}};
  constexpr int replications = 2000;
  int covered = 0, covered_other = 0;
  for (int replication = 0; replication < replications; ++replication) {
    Outcomes outcomes;
    StopTest last;
    for (const int wanted : stop_test_schedule(10, 1000)) {
      while (std::ssize(outcomes) < wanted) {
        Outcome outcome{{viscosities(random)}};
        outcome.further = {{others(random)}};
        outcomes.emplace_back(outcome);
      }
      last = replay_stop_tests(outcomes, target, 10, 1000).back();
      if (last.verdict != Verdict::more) break;
    }
    ASSERT_EQ(last.verdict, Verdict::converged);
    covered += std::abs(last.controlled.mean - 1) <= last.controlled_half_width ? 1 : 0;
    covered_other += std::abs(last.each[1].estimate.mean) <= last.each[1].half_width ? 1 : 0;
  }
  EXPECT_GT(covered, 0.92 * replications);
  EXPECT_LT(covered, 0.975 * replications);
  EXPECT_GT(covered_other, 0.92 * replications);
  EXPECT_LT(covered_other, 0.975 * replications);
}

}  // namespace
}  // namespace peclet::runner
