// Tests which new value of the axis a campaign with a curve chooses.
#include <gtest/gtest.h>

#include <span>

#include "runner/statistics/curve_proposal.h"

namespace peclet::runner {
namespace {

Campaign campaign_with(int points) {
  return parse_campaign(Json::parse(R"({
  "name": "curve", "scene": {},
  "sweep": [{"set": "/peclet", "values": [0.1, 1, 10, 100, 1000, 10000000]}],
  "target": {"curve": {"over": "/peclet", "relative_tolerance": 0.05}},
  "choose": {"points": )" + std::to_string(points) +
                                    R"(}, "realisations": {"minimum": 8, "maximum": 100}})"),
                        "curve.json");
}

// Seeds within 1 % of their mean, so that each point is decided by its first stop test.
constexpr double uneven[] = {10, 10.4, 9.7, 10.3, 9.8, 10.1}, even[] = {10, 10, 10, 10, 10};
Scheduler decided(const Campaign& campaign, std::span<const double> means = uneven, int open_points = 0) {
  std::vector<std::vector<std::optional<Outcome>>> outcomes(campaign.points.size());
  for (std::size_t point = 0; point < outcomes.size(); ++point) {
    for (int seed = 0; seed < 8; ++seed) {
      Outcome outcome{{means[point] * (seed % 2 == 0 ? 0.99 : 1.01)}};
      outcome.steps = 1000;
      if (static_cast<int>(point) >= open_points) outcomes[point].emplace_back(outcome);
    }
  }
  return {std::move(outcomes), campaign.target, campaign.minimum_realisations, campaign.maximum_realisations,
          campaign.curves};
}

TEST(ChosenValue, LiesWhereTheBandIsWidest) {
  const Campaign campaign = campaign_with(7);
  const std::optional<ChosenValue> chosen = choose_value(decided(campaign), campaign);
  ASSERT_TRUE(chosen);
  EXPECT_GT(chosen->value, 1000);
  EXPECT_LT(chosen->value, 1e7);
  EXPECT_GT(chosen->width, 0.05);
  EXPECT_EQ(chosen->observable, "relative_viscosity");
}

TEST(ChosenValue, IsAbsentOnceTheAxisHasItsNumber) {
  const Campaign campaign = campaign_with(6);
  EXPECT_FALSE(choose_value(decided(campaign), campaign));
}

TEST(ChosenValue, WaitsForAllPoints) {
  const Campaign campaign = campaign_with(7);
  Scheduler scheduler = decided(campaign, uneven, 1);
  EXPECT_FALSE(choose_value(scheduler, campaign));
  scheduler.set_cancelled(0, true);
  EXPECT_TRUE(choose_value(scheduler, campaign));
}

TEST(ChosenValue, IsNotAskedForByARefusedCurve) {
  const Campaign campaign = campaign_with(7);
  constexpr double with_a_jump[] = {10, 10.4, 30, 10.3, 9.8, 10.1};
  EXPECT_FALSE(choose_value(decided(campaign, with_a_jump), campaign));
}

// A curve from 0.1 to 1000 is known between its points.
TEST(ChosenValue, IsAbsentWithinTheTolerance) {
  Campaign campaign = campaign_with(7);
  Json document = campaign.document;
  document["sweep"][0]["values"] = {0.1, 1, 10, 100, 1000};
  campaign = parse_campaign(document, "curve.json");
  EXPECT_FALSE(choose_value(decided(campaign, even), campaign));
}

TEST(ChosenValue, BelongsToTheAxisThatItWasChosenFor) {
  const auto along = [](const char* over) {
    Json document = campaign_with(7).document;
    document["sweep"][0] = {{"set", {"/peclet", "/x"}}, {"values", {{1, 1}, {2, 2}, {3, 3}, {4, 4}}}};
    document["target"] = Json::parse(R"({"observable": "pressure", "absolute_tolerance": 1})");
    document["target"]["also"] = {
        {{"observable", "relative_viscosity"}, {"curve", {{"over", over}, {"relative_tolerance", 0.05}}}}};
    return document;
  };
  const Json before = with_chosen_value(along("/peclet"), 1.5);
  EXPECT_EQ(chosen_values(keeping_chosen_values(along("/peclet"), before)), Json({1.5}));
  EXPECT_EQ(chosen_values(keeping_chosen_values(along("/x"), before)), Json::array());
}

}  // namespace
}  // namespace peclet::runner
