// What a campaign may cost.
#include "runner/plan.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/runner/runner_fixture.h"

namespace peclet::runner {
namespace {

TEST(Plan, ACampaignWithoutASeedHasUnknownHours) {
  const Plan plan = make_plan(plain_campaign(2, 10, 800, 0.05), {1e6, 2e6}, {});
  EXPECT_TRUE(std::isnan(plan.points[0].cost.cpu_seconds));
  const Json json = plan_json(plan);
  EXPECT_TRUE(json["cpu_hours_minimum"].is_null());
  EXPECT_TRUE(json["points"][0]["cpu_seconds_per_seed"].is_null());
  EXPECT_EQ(json["points"][1]["particle_steps"], 2e6);
  EXPECT_NE(plan_text(plan).find("not known before a seed has ended"), std::string::npos);
}

TEST(Plan, APointWithoutASeedCostsWhatTheOthersDoForEachParticleStep) {
  const Campaign campaign = plain_campaign(3, 10, 100, 0.05);
  // 4 seeds of 36 s for 1e6 particle-steps and one of 216 s for 2e6: 360 s for 6e6, 60 s for each million.
  const Plan plan = make_plan(campaign, {1e6, 2e6, 3e6},
                              {{campaign.points[0].hash, {4, 36}}, {campaign.points[1].hash, {1, 216}}});
  EXPECT_EQ(plan.points[0].cost.cpu_seconds, 36);
  EXPECT_EQ(plan.points[1].cost.cpu_seconds, 216);
  EXPECT_NEAR(plan.points[2].cost.cpu_seconds, 180, 1e-9);
  EXPECT_EQ(plan.points[2].cost.count, 0);
  // (36 + 216 + 180) s = 0.12 h for a seed of each.
  EXPECT_NEAR(plan_json(plan)["cpu_hours_minimum"].get<double>(), 1.2, 1e-9);
  EXPECT_NEAR(plan_json(plan)["cpu_hours_maximum"].get<double>(), 12, 1e-9);
}

}  // namespace
}  // namespace peclet::runner
