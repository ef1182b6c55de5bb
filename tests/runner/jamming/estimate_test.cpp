// From the seeds of a campaign to its jamming points: which points count, and what is said of the others.
#include "runner/jamming/estimate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "contract/input_error.h"
#include "runner/jamming/report.h"
#include "tests/runner/jamming/jamming_campaign.h"

namespace peclet::runner {
namespace {

const std::vector<double> fractions{0.45, 0.50, 0.54, 0.57, 0.60, 0.62, 0.66};

// Six points that follow the law and one that is jammed.
void fill(JammingCampaign& campaign, const TrueLaw& law, int first = 0) {
  for (int point = 0; point < 6; ++point)
    campaign.complete(first + point, law.at(fractions[static_cast<std::size_t>(point)]));
  campaign.jam(first + 6);
}

bool remarks_say(const JammingEstimate& estimate, const std::string& part) {
  return std::any_of(estimate.remarks.begin(), estimate.remarks.end(),
                     [&](const JammingRemark& remark) { return says(remark.text(), part); });
}

TEST(JammingOfACampaign, EachCurveGivesItsLawBack) {
  JammingCampaign campaign(jamming_document(fractions, {{{"set", "/contact/friction"}, {"values", {0, 1}}}}));
  const TrueLaw laws[] = {{0.65, 1.6, 1.4}, {0.63, 2.1, 1.2}};
  fill(campaign, laws[0]);
  fill(campaign, laws[1], 7);
  const JammingCurves curves = campaign.curves();
  EXPECT_EQ(curves.over, "/volume_fraction");
  ASSERT_EQ(curves.curves.size(), 2U);
  for (std::size_t k = 0; k < 2; ++k) {
    const JammingEstimate found = estimate_jamming(curves.curves[k], {});
    EXPECT_EQ(found.curve.settings, Json({{"/contact/friction", k}}));
    EXPECT_EQ(found.flowing(), 6);
    EXPECT_EQ(found.curve.largest_flowing(), 0.62);
    ASSERT_NE(found.curve.smallest_stuck(), nullptr);
    EXPECT_EQ(found.curve.smallest_stuck()->fraction, 0.66);
    EXPECT_EQ(found.curve.smallest_stuck()->state, FlowState::jammed);
    ASSERT_TRUE(found.law.law) << found.law.obstacle;
    EXPECT_NEAR(found.law.law->fraction.value, laws[k].fraction, 1e-6);
    EXPECT_NEAR(found.law.law->exponent.value, laws[k].exponent, 1e-5);
    EXPECT_NEAR(found.law.law->prefactor.value, laws[k].prefactor, 1e-5);
    ASSERT_TRUE(found.steepest.steepest);
    EXPECT_TRUE(found.steepest.steepest->to_jammed);
    EXPECT_NEAR(found.steepest.steepest->fraction.value, 0.64, 1e-12);
    EXPECT_TRUE(found.remarks.empty()) << found.remarks.front().text();
  }
}

TEST(JammingOfACampaign, TheLawIsOfFlowingPointsAboveTheBound) {
  JammingCampaign campaign(jamming_document(fractions));
  fill(campaign, {});
  // 1.4 (1 - 0.45 / 0.65)^-1.6 = 9.22 is below 10, 0.50 gives 14.6.
  EXPECT_EQ(campaign.estimate().fitted.size(), 5U);
  EXPECT_EQ(campaign.estimate({{}, 9}).fitted.size(), 6U);
  const JammingEstimate few = campaign.estimate({{}, 25});
  EXPECT_FALSE(few.law.law);
  EXPECT_EQ(few.law.obstacle, "3 of the 4 flowing points with a viscosity above 25 that it needs");
}

TEST(JammingOfACampaign, PointsThatDoNotFlowAreNoPartOfTheLaw) {
  JammingCampaign campaign(jamming_document(fractions));
  const TrueLaw law;
  campaign.complete(0, law.at(0.45));
  campaign.complete(1, law.at(0.50), 0.01, 0.00099);
  campaign.complete(2, 1000, 0.01, 0.0011);  // soft, and far from the law
  campaign.jam(3, 8, "packing");
  campaign.jam(4, 1);  // 1 of 8: more than a tenth, less than half
  for (int seed = 1; seed < 8; ++seed) campaign.stored().complete(4, seed, 50);
  for (int seed = 0; seed < 8; ++seed) campaign.stored().crash(5, seed);
  const JammingEstimate found = campaign.estimate();
  const FlowState states[] = {FlowState::flowing, FlowState::flowing,       FlowState::soft,
                              FlowState::jammed,  FlowState::partly_jammed, FlowState::lost,
                              FlowState::open};
  for (std::size_t i = 0; i < 7; ++i) EXPECT_EQ(found.curve.points.at(i).state, states[i]) << i;
  EXPECT_EQ(found.curve.points[4].jammed, 1);
  EXPECT_EQ(found.fitted.size(), 1U);
  EXPECT_EQ(found.curve.smallest_stuck()->fraction, 0.54);
  EXPECT_TRUE(remarks_say(found, "0.54 (overlap 0.0011): left out, soft, a larger"));
  EXPECT_TRUE(remarks_say(found, "0.6 (1 of 8): left out, some seeds jammed"));
  EXPECT_TRUE(remarks_say(found, "0.62: left out, half of the seeds or more were lost"));
  EXPECT_TRUE(remarks_say(found, "0.66: left out, no seed has ended yet"));
  EXPECT_FALSE(remarks_say(found, "0.57"));  // jammed has its column
}

// A result with a rate, and so a value of what the campaign aims at: it ends as `jammed`, not as lost.
TEST(JammingOfACampaign, WhatStandsStillUnderItsStressHasJammed) {
  JammingCampaign campaign(jamming_document(fractions));
  const TrueLaw law;
  for (int point = 0; point < 5; ++point)
    campaign.complete(point, law.at(fractions[static_cast<std::size_t>(point)]));
  for (int seed = 0; seed < 4; ++seed) {
    campaign.stored().complete_with(5, seed, 1e8 + seed, [&](Json& result) {
      if (seed > 0) result["ending"]["cause"] = "jammed";
    });
  }
  const JammingEstimate found = campaign.estimate();
  const JammingPoint& still = found.curve.points.at(5);
  EXPECT_EQ(still.state, FlowState::jammed);
  EXPECT_EQ(still.ended, 4);
  EXPECT_EQ(still.jammed, 3);
  for (const LawPoint& fitted : found.fitted) EXPECT_NE(fitted.fraction, still.fraction);
  EXPECT_EQ(found.curve.smallest_stuck()->fraction, still.fraction);
  EXPECT_EQ(found.curve.largest_flowing(), 0.60);
}

TEST(JammingOfACampaign, WithoutMeanOverlapsTheLargestDecide) {
  JammingCampaign campaign(jamming_document(fractions));
  for (int point = 0; point < 2; ++point) {
    for (int seed = 0; seed < 4; ++seed) {
      campaign.stored().complete_with(point, seed, 20 + seed, [&](Json& result) {
        result["mean"].erase("mean_overlap");
        result["largest_overlap"] = point == 0 ? 0.0099 : 0.0101;  // ten times 0.001
      });
    }
  }
  const JammingEstimate found = campaign.estimate();
  EXPECT_EQ(found.curve.points.at(0).state, FlowState::flowing);
  EXPECT_EQ(found.curve.points.at(1).state, FlowState::soft);
  EXPECT_TRUE(remarks_say(found, "0.5 (overlap 0.01 at most): left out, soft"));
}

TEST(JammingOfACampaign, APointNeedsFourSeedsAndASpread) {
  JammingCampaign campaign(jamming_document(fractions));
  const TrueLaw law;
  for (int seed = 0; seed < 3; ++seed) campaign.stored().complete(5, seed, law.at(0.62) + seed);
  const JammingEstimate found = campaign.estimate();
  EXPECT_EQ(found.curve.points[5].state, FlowState::flowing);
  EXPECT_EQ(found.curve.largest_flowing(), 0.62);
  EXPECT_TRUE(remarks_say(found, "0.62 (3): left out, no error yet, 4 seeds with a value are needed"));
}

// A fraction that flows, if only by a few seeds, is below phi_m.
TEST(JammingOfACampaign, ContradictionsAreSaid) {
  JammingCampaign campaign(jamming_document(fractions));
  fill(campaign, {0.70, 1.6, 1.4});
  EXPECT_TRUE(remarks_say(campaign.estimate(), "0.66: the law diverges above a fraction that is jammed"));
  JammingCampaign mixed(jamming_document(fractions));
  for (const int point : {0, 1, 2, 4, 5}) mixed.complete(point, 10 + point);
  mixed.jam(3);
  EXPECT_TRUE(remarks_say(mixed.estimate(), "0.57 (below 0.62): jammed, although a larger fraction flows"));
}

TEST(JammingOfACampaign, RefusesWhatIsNoVolumeFractionOrNoQuantity) {
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
      says(refusal(campaign, {.over = "peclet"}), "--over: peclet: must be what one thing is called"));
  EXPECT_TRUE(says(refusal(campaign, {.quantity = "presure"}), "must be a number that is measured"));
}

TEST(JammingOfACampaign, OneExponentForAllCurvesIsTold) {
  const Json swept = Json::array({{{"set", "/contact/friction"}, {"values", {0, 0.5, 1}}}});
  JammingCampaign campaign(jamming_document(fractions, swept));
  const std::size_t of_one = fractions.size();
  const std::vector<double> jammed{0.70, 0.68};
  for (std::size_t curve = 0; curve < jammed.size(); ++curve) {
    const TrueLaw law{jammed[curve], 1.9, 1.2};
    for (std::size_t k = 0; k < of_one; ++k)
      campaign.complete(static_cast<int>(curve * of_one + k), law.at(fractions[k]));
  }
  const JammingCurves curves = campaign.curves();
  const EstimateChoice choice{.common_exponent = true};
  JammingEstimates found = estimate_all(curves.curves, choice);
  ASSERT_TRUE(found.common.common) << found.common.obstacle;
  EXPECT_NEAR(found.common.common->exponent.value, 1.9, 1e-3);
  for (std::size_t curve = 0; curve < jammed.size(); ++curve) {
    ASSERT_TRUE(found.curves[curve].law.law);
    EXPECT_NEAR(found.curves[curve].law.law->fraction.value, jammed[curve], 1e-4);
  }
  EXPECT_EQ(found.curves[2].law.obstacle,
            "0 of the 4 flowing points with a viscosity above 10 that it needs");
  const JammingReport report{.campaign = curves,
                             .choice = choice,
                             .common = found.common,
                             .estimates = found.curves,
                             .proposed = {}};
  EXPECT_TRUE(says(jamming_table(report), "exponent: common to 2 curves, 1.9000 ±")) << jamming_table(report);
  const Json common = jamming_json(report)["common"];
  EXPECT_NEAR(common["exponent"]["value"], 1.9, 1e-3);
  EXPECT_EQ(common["curves"], 2);
  EXPECT_TRUE(common["obstacle"].is_null());
}

// A campaign of fifty curves says once what is true of all of them, and by curve what is true of some.
TEST(JammingOfACampaign, WhatIsTrueOfManyCurvesIsToldOnce) {
  JammingCampaign campaign(
      jamming_document(fractions, {{{"set", "/contact/friction"}, {"values", {0, 0.5, 1}}}}));
  const TrueLaw law;
  for (int point = 0; point < 2; ++point) campaign.complete(point, law.at(0.45), 0.01, 0.002);
  campaign.complete(7, law.at(0.45), 0.01, 0.003);
  const JammingCurves curves = campaign.curves();
  const JammingReport report{
      .campaign = curves, .choice = {}, .estimates = estimate_all(curves.curves, {}).curves, .proposed = {}};
  const std::string table = jamming_table(report);
  EXPECT_TRUE(
      says(table,
           "phi_m by law is not determined, 0 of the 4 flowing points with a viscosity above 10 that it "
           "needs:\nevery curve\n"))
      << table;
  EXPECT_TRUE(says(table,
                   "left out, soft, a larger normal_stiffness makes spheres harder:\n"
                   "  μ = 0: 0.45 (overlap 0.002), 0.5 (overlap 0.002)\n"
                   "  μ = 0.5: 0.45 (overlap 0.003)\n"))
      << table;
}

TEST(JammingOfACampaign, IsToldToPeopleAndPrograms) {
  JammingCampaign campaign(jamming_document(fractions));
  fill(campaign, {});
  JammingReport report{
      .campaign = campaign.curves(), .choice = {}, .estimates = {campaign.estimate()}, .proposed = {}};
  const std::string table = jamming_table(report);
  EXPECT_TRUE(says(table, "jam: relative_viscosity over /volume_fraction, 1 curve\n")) << table;
  EXPECT_TRUE(says(table, "0.66 jammed")) << table;
  EXPECT_TRUE(says(table, "tell: sweep the stiffness.")) << table;
  const Json json = jamming_json(report);
  EXPECT_EQ(json["schema_version"], 1);
  const Json& curve = json["curves"].at(0);
  EXPECT_EQ(curve["flowing"], 6);
  EXPECT_EQ(curve["smallest_stuck"], Json({{"fraction", 0.66}, {"state", "jammed"}}));
  EXPECT_NEAR(curve["law"]["phi_m"]["value"].get<double>(), 0.65, 1e-6);
  EXPECT_EQ(curve["law"]["obstacle"], nullptr);
  EXPECT_EQ(curve["law"]["degrees"], 2);
  EXPECT_EQ(curve["points"].size(), 7U);
  EXPECT_EQ(curve["points"][0]["fitted"], false);
  EXPECT_EQ(curve["points"][1]["fitted"], true);
  EXPECT_EQ(curve["points"][6]["mean"], nullptr);
  report.by_steepest = false;
  EXPECT_FALSE(jamming_json(report)["curves"][0].contains("steepest"));
  EXPECT_FALSE(says(jamming_table(report), "steepest"));
}

}  // namespace
}  // namespace peclet::runner
