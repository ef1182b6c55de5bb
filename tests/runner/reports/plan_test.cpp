// Tests plans: guessed, measured and predicted costs.
#include "runner/reports/plan.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/runner/reports/curve_campaign.h"

namespace peclet::runner {
namespace {

TEST(Plan, ACampaignWithoutASeedHasUnknownHours) {
  const Plan plan = make_plan(plain_campaign(2, 10, 800, 0.05), {1e6, 2e6}, {}, 1);
  EXPECT_TRUE(std::isnan(plan.points[0].cost.cpu_seconds));
  const Json json = plan_json(plan);
  EXPECT_TRUE(json["cpu_hours_minimum"].is_null());
  EXPECT_TRUE(json["points"][0]["cpu_seconds_per_seed"].is_null());
  EXPECT_EQ(json["points"][1]["particle_steps"], 2e6);
  EXPECT_NE(plan_text(plan).find("not known before a seed has ended"), std::string::npos);
}

TEST(Plan, SaysWhatRestWouldSaveOfThePointsThatAreNearIt) {
  Plan plan = make_plan(plain_campaign(2, 10, 800, 0.05), {1e6, 2e6}, {}, 1);
  EXPECT_EQ(plan_text(plan).find("at rest"), std::string::npos);
  plan.points[1].flow_over_rest = 250;
  EXPECT_NE(plan_text(plan).find("nearly at rest. Processor time over that for the same error at rest, with "
                                 "linear_response (a guess):\n  point=1: 250\n"),
            std::string::npos)
      << plan_text(plan);
  EXPECT_TRUE(plan_json(plan)["points"][0]["flow_over_rest"].is_null());
  EXPECT_EQ(plan_json(plan)["points"][1]["flow_over_rest"], 250);
}

TEST(Plan, SaysThatTheRunMayAddValues) {
  Campaign campaign = curve_campaign();
  EXPECT_EQ(plan_json(make_plan(campaign, std::vector<double>(6, 1e6), {}, 1))["values_to_choose"], 0);
  campaign.most_values = 9;
  const Plan plan = make_plan(campaign, std::vector<double>(6, 1e6), {}, 1);
  EXPECT_EQ(plan_json(plan)["values_to_choose"], 3);
  EXPECT_NE(plan_text(plan).find("may add 3 values of /peclet (/choose), which are not in"),
            std::string::npos)
      << plan_text(plan);
}

// The guess is 3 s for 1e6 particle-steps of the first point, so a seed of each point takes 3 + 6 s.
TEST(Plan, AGuessIsCalledOne) {
  const Plan plan = make_plan(plain_campaign(2, 10, 800, 0.05), {1e6, 2e6}, {}, 1, CostGuess{0, 3});
  EXPECT_DOUBLE_EQ(plan.points[1].cost.cpu_seconds, 6);
  const Json json = plan_json(plan);
  EXPECT_EQ(json["guessed_from"], "point=0");
  EXPECT_NEAR(json["cpu_hours_minimum"].get<double>(), 90 / 3600.0, 1e-12);
  EXPECT_NE(plan_text(plan).find("~: a guess, from the first two seconds of one realisation of point=0"),
            std::string::npos)
      << plan_text(plan);
  EXPECT_TRUE(make_plan(plain_campaign(2, 10, 800, 0.05), {1e6, 2e6},
                        {{plain_campaign(2, 10, 800, 0.05).points[0].hash, {{1, 5}}}}, 1, CostGuess{0, 3})
                  .guessed_from.empty())
      << "measured costs need no guess";
}

// Each of two workers does four realisations at once, which takes 3 s.
TEST(Plan, RealisationsSideBySideShareTheTimeOfTheirWorker) {
  Campaign campaign = plain_campaign(1, 16, 16, 0.05);
  campaign.target.tolerance = Tolerance::none();
  const CostGuess guess{0, 3};
  const Plan plan = make_plan(campaign, {1e6}, {}, 2, guess, 4);
  EXPECT_DOUBLE_EQ(plan.points[0].cost.wall_seconds, 3);
  EXPECT_DOUBLE_EQ(plan.points[0].cost.cpu_seconds, 0.75);
  EXPECT_DOUBLE_EQ(plan.totals.wall_seconds_to_come.likely, 2 * 3);
  EXPECT_EQ(plan_json(plan)["prediction"]["capacity"], 4);
  EXPECT_TRUE(says(plan_text(plan), "with 2 workers of 4 realisations at once")) << plan_text(plan);
  EXPECT_DOUBLE_EQ(make_plan(campaign, {1e6}, {}, 2, guess).totals.wall_seconds_to_come.likely, 8 * 3);
}

TEST(Plan, APointWithoutASeedCostsWhatTheOthersDoForEachParticleStep) {
  const Campaign campaign = plain_campaign(3, 10, 100, 0.05);
  // 4 seeds of 36 s for 1e6 particle-steps and one of 216 s for 2e6 give 360 s for 6e6: 60 s per million.
  const Plan plan =
      make_plan(campaign, {1e6, 2e6, 3e6},
                {{campaign.points[0].hash, {{4, 36}}}, {campaign.points[1].hash, {{1, 216}}}}, 1);
  EXPECT_EQ(plan.points[0].cost.cpu_seconds, 36);
  EXPECT_EQ(plan.points[1].cost.cpu_seconds, 216);
  EXPECT_NEAR(plan.points[2].cost.cpu_seconds, 180, 1e-9);
  EXPECT_EQ(plan.points[2].cost.count, 0);
  // A seed of each point takes (36 + 216 + 180) s = 0.12 h.
  EXPECT_NEAR(plan_json(plan)["cpu_hours_minimum"].get<double>(), 1.2, 1e-9);
  EXPECT_NEAR(plan_json(plan)["cpu_hours_maximum"].get<double>(), 12, 1e-9);
}

// Returns four seeds with values so near each other that the minimum of 10 seeds is certainly enough.
PointHistory four_equal_seeds(double cpu_seconds, double wall_seconds) {
  PointHistory history{{4, cpu_seconds, wall_seconds}, {}};
  for (const double value : {10.0, 10.001, 9.999, 10.0}) history.outcomes.emplace_back(Outcome{{value}});
  return history;
}

TEST(Plan, WhatIsToComeFollowsFromThePilot) {
  const Campaign campaign = plain_campaign(3, 10, 100, 0.05);
  const Plan plan = make_plan(campaign, {1, 1, 1},
                              {{campaign.points[0].hash, four_equal_seeds(36, 18)},
                               {campaign.points[1].hash, four_equal_seeds(200, 100)}},
                              4);
  EXPECT_EQ(plan.points[0].prediction.seeds.likely, 10);
  EXPECT_EQ(plan.points[2].obstacle(), "fewer than two seeds have ended");
  EXPECT_EQ(plan.totals.points, 2);
  EXPECT_DOUBLE_EQ(plan.totals.cpu_seconds.likely, 10 * (36 + 200));
  EXPECT_DOUBLE_EQ(plan.totals.cpu_seconds_to_come.upper, 6 * (36 + 200));
  // Six seeds of 100 s on four workers take 200 s, more than a quarter of 6 * 118 s.
  EXPECT_DOUBLE_EQ(plan.totals.wall_seconds_to_come.likely, 200);
  const Json json = plan_json(plan);
  EXPECT_EQ(json["points"][1]["prediction"]["seeds"]["upper"], 10);
  EXPECT_TRUE(json["points"][2]["prediction"].is_null());
  EXPECT_EQ(json["prediction"]["workers"], 4);
  const std::string text = plan_text(plan);
  EXPECT_NE(text.find("these sums leave out the points without a prediction: 1\n"), std::string::npos)
      << text;
  EXPECT_NE(text.find("with 4 workers 3 min"), std::string::npos) << text;
}

// Seeds of the decided point took 36 s, so that ten of the other one take 6 min.
TEST(Plan, WithoutAPredictionSaysWhatTheFirstSeedsTake) {
  const Campaign campaign = plain_campaign(2, 10, 100, 0.05);
  PointHistory decided{{10, 36, 18}, {}};
  for (int seed = 0; seed < 10; ++seed) decided.outcomes.emplace_back(Outcome{{10.0 + 0.001 * seed}});
  const std::string text = plan_text(make_plan(campaign, {1, 1}, {{campaign.points[0].hash, decided}}, 4));
  EXPECT_NE(
      text.find("no prediction is possible for the open points; the 10 seeds that each of them needs at "
                "least take another 6 min of processor time"),
      std::string::npos)
      << text;
}

TEST(Plan, WithOneWorkerEverythingIsOneChain) {
  const Campaign campaign = plain_campaign(2, 10, 100, 0.05);
  const Plan plan = make_plan(campaign, {1, 1},
                              {{campaign.points[0].hash, four_equal_seeds(36, 18)},
                               {campaign.points[1].hash, four_equal_seeds(200, 100)}},
                              1);
  EXPECT_DOUBLE_EQ(plan.totals.wall_seconds_to_come.likely, 6 * 118);
}

TEST(Plan, ADecidedPointHasNothingToCome) {
  const Campaign campaign = plain_campaign(1, 4, 100, 0.05);
  const Plan plan = make_plan(campaign, {1}, {{campaign.points[0].hash, four_equal_seeds(36, 18)}}, 1);
  ASSERT_TRUE(plan.points[0].decided);
  EXPECT_EQ(plan.totals.predicted, 0);
  EXPECT_EQ(plan.totals.cpu_seconds_to_come.upper, 0);
  EXPECT_EQ(plan_json(plan)["points"][0]["verdict"], "converged");
}

// After four values, the true variance is 0.32 to 14 times that of the sample. For ten points of equal cost
// it is 0.64 to 1.8 times (30 degrees of freedom). A point that outweighs the others counts alone.
TEST(Plan, OfASumMoreIsKnownThanOfEachPartUnlessOneOutweighsTheOthers) {
  const auto seconds_of = [](std::size_t points, double of_first) {
    Campaign campaign = plain_campaign(10, 8, 4000, 0.03);
    campaign.points.resize(points);
    std::map<std::string, PointHistory> known;
    for (const StatePoint& point : campaign.points) {
      const double seconds = known.empty() ? of_first : 1;
      PointHistory& history = known[point.hash] = {{4, seconds, seconds}, {}};
      for (const double value : {8.0, 12.0, 8.0, 12.0}) history.outcomes.emplace_back(Outcome{{value}});
    }
    return make_plan(campaign, std::vector<double>(points, 1), known, 1).totals.cpu_seconds;
  };
  const Expected<double> one = seconds_of(1, 1), ten = seconds_of(10, 1), unequal = seconds_of(10, 1e6);
  EXPECT_LT(ten.upper, 10 * one.upper / 3);
  EXPECT_GT(ten.lower, 10 * one.lower * 1.4);
  EXPECT_NEAR(unequal.upper / 1e6, one.upper, 1e-2 * one.upper);
  EXPECT_NEAR(unequal.lower / 1e6, one.lower, 1e-2 * one.lower);
}

// Four seeds of the first point took a minute each. The second point has the same number of particle-steps.
TEST(Plan, AFixedNumberOfSeedsIsPlannedWithoutAPilot) {
  Campaign campaign = plain_campaign(2, 16, 16, 0.05);
  campaign.target.tolerance = Tolerance::none();
  const Plan plan = make_plan(campaign, {1, 1}, {{campaign.points[0].hash, four_equal_seeds(60, 60)}}, 1);
  EXPECT_EQ(plan.totals.points, 2);
  EXPECT_DOUBLE_EQ(plan.totals.seeds.likely, 32);
  EXPECT_DOUBLE_EQ(plan.totals.cpu_seconds_to_come.lower, 28 * 60);
  EXPECT_DOUBLE_EQ(plan.totals.cpu_seconds_to_come.upper, 28 * 60);
  EXPECT_NE(plan_text(plan).find("plain: 2 points, 16 seeds each\n"), std::string::npos) << plan_text(plan);
  EXPECT_EQ(plan_text(plan).find("95 %"), std::string::npos) << plan_text(plan);
}

// The spread is so large that the mean may be zero.
TEST(Plan, SaysWhereAMeanNearZeroForbidsAPrediction) {
  const Campaign campaign = plain_campaign(1, 10, 100, 0.05);
  PointHistory history = four_equal_seeds(36, 18);
  history.outcomes[0]->value = history.outcomes[1]->value = -9;
  const Plan plan = make_plan(campaign, {1}, {{campaign.points[0].hash, history}}, 1);
  EXPECT_EQ(plan_json(plan)["points"][0]["obstacle"], "the mean of 4 seeds may be zero");
  EXPECT_TRUE(plan_json(plan)["prediction"].is_null());
}

}  // namespace
}  // namespace peclet::runner
