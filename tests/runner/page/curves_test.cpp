// The curves of a campaign and the states of their points, from seeds.
#include <gtest/gtest.h>

#include "contract/errors.h"
#include "runner/page/jamming.h"
#include "runner/store/point_store.h"
#include "tests/runner/page/jamming_campaign.h"

namespace peclet::runner {
namespace {

const std::vector<double> fractions{0.45, 0.50, 0.54, 0.57, 0.60, 0.62, 0.66};

TEST(JammingCurves, AreOnePerValueOfWhatElseIsSwept) {
  JammingCampaign campaign(jamming_document(fractions, {{{"set", "/contact/friction"}, {"values", {0, 1}}}}));
  campaign.complete(8, 20);
  const Json curves = campaign.curves();
  EXPECT_EQ(curves.at("over"), "/volume_fraction");
  ASSERT_EQ(curves.at("curves").size(), 2U);
  EXPECT_EQ(curves.at("curves")[1].at("name"), "friction = 1");
  EXPECT_EQ(curves.at("curves")[1].at("settings"), Json({{"/contact/friction", 1}}));
  const Json& point = curves.at("curves")[1].at("points").at(1);
  EXPECT_EQ(point.at("fraction"), 0.50);
  EXPECT_EQ(point.at("state"), "flowing");
  EXPECT_EQ(point.at("count"), 8);
  EXPECT_NEAR(point.at("mean").get<double>(), 20, 1e-12);
  EXPECT_NEAR(point.at("standard_error").get<double>(), 0.2 / std::sqrt(8), 1e-12);
  EXPECT_EQ(curves.at("curves")[0].at("points").at(1).at("state"), "open");
  const Json hello = Json::parse(
      R"({"scene_schema": {"properties": {"contact": {"properties": {"friction": {"symbol": "μ"}}}}}})");
  keep_vocabulary(campaign.stored().database(), Vocabulary(hello));
  EXPECT_EQ(campaign.curves()["curves"][1]["name"], "μ = 1");
}

TEST(JammingCurves, SayOfEachPointWhetherItFlows) {
  JammingCampaign campaign(jamming_document(fractions));
  const TrueLaw law;
  campaign.complete(0, law.at(0.45));
  campaign.complete(1, law.at(0.50), 0.01, 0.00099);
  campaign.complete(2, 1000, 0.01, 0.0011);
  campaign.jam(3, 8, "packing");
  campaign.jam(4, 1);  // 1 of 8: more than a tenth, less than half
  for (int seed = 1; seed < 8; ++seed) campaign.stored().complete(4, seed, 50);
  for (int seed = 0; seed < 8; ++seed) campaign.stored().crash(5, seed);
  const Json points = campaign.points();
  const char* const states[] = {"flowing", "flowing", "soft", "jammed", "partly jammed", "lost", "open"};
  for (std::size_t i = 0; i < 7; ++i) EXPECT_EQ(points.at(i).at("state"), states[i]) << i;
  EXPECT_EQ(points[2].at("overlap"), 0.0011);
  EXPECT_EQ(points[4].at("jammed"), 1);
  EXPECT_EQ(points[4].at("seeds"), 8);
}

// A seed that stands still has a result with a rate, and so a value of the target: it is jammed, not lost.
TEST(JammingCurves, WhatStandsStillUnderItsStressHasJammed) {
  JammingCampaign campaign(jamming_document(fractions));
  for (int seed = 0; seed < 4; ++seed) {
    campaign.stored().complete_with(5, seed, 1e8 + seed, [&](Json& result) {
      if (seed > 0) result["ending"]["cause"] = "jammed";
    });
  }
  const Json still = campaign.points().at(5);
  EXPECT_EQ(still.at("state"), "jammed");
  EXPECT_EQ(still.at("seeds"), 4);
  EXPECT_EQ(still.at("jammed"), 3);
}

TEST(JammingCurves, WithoutMeanOverlapsTheLargestDecide) {
  JammingCampaign campaign(jamming_document(fractions));
  for (int point = 0; point < 2; ++point) {
    for (int seed = 0; seed < 4; ++seed) {
      campaign.stored().complete_with(point, seed, 20 + seed, [&](Json& result) {
        result["mean"].erase("mean_overlap");
        result["largest_overlap"] = point == 0 ? 0.0099 : 0.0101;  // ten times 0.001
      });
    }
  }
  const Json points = campaign.points();
  EXPECT_EQ(points.at(0).at("state"), "flowing");
  EXPECT_EQ(points.at(1).at("state"), "soft");
  EXPECT_TRUE(points[1].at("overlap").is_null());
  EXPECT_NEAR(points[1].at("largest_overlap").get<double>(), 0.0101, 1e-12);
}

TEST(JammingCurves, RefuseWhatIsNotAVolumeFractionOrNotAQuantity) {
  const auto refusal = [](JammingCampaign& campaign, const CurveChoice& choice) -> std::string {
    try {
      campaign.curves(choice);
    } catch (const InputError& fault) {
      return fault.what();
    }
    return "";
  };
  JammingCampaign campaign(jamming_document(fractions, {{{"set", "/contact/friction"}, {"values", {0, 1}}}}));
  campaign.complete(0, 10);
  EXPECT_EQ(refusal(campaign, {.over = "friction"}),
            "--over: friction: must be a swept volume fraction: numbers > 0 and < 1");
  EXPECT_TRUE(
      says(refusal(campaign, {.over = "peclet"}), "--over: peclet: must be the name of one swept parameter"));
  EXPECT_TRUE(says(refusal(campaign, {.quantity = "presure"}), "must be a measured quantity"));
}

}  // namespace
}  // namespace peclet::runner
