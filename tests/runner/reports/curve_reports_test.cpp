// Tests what status, explain, export and plot say of a target with a curve.
#include <gtest/gtest.h>

#include <algorithm>

#include "contract/errors.h"
#include "runner/page/figure.h"
#include "runner/reports/explain.h"
#include "runner/reports/export.h"
#include "runner/reports/plan.h"
#include "runner/reports/status.h"
#include "runner/store/database_summary.h"
#include "tests/runner/reports/curve_campaign.h"

namespace peclet::runner {
namespace {

TEST(CurveReports, StatusShowsTheBandBesideTheInterval) {
  StoredCampaign campaign(curve_campaign());
  const CampaignStatus status = read_status(decided(campaign).database());
  const std::string table = status_table(status, 200);
  EXPECT_TRUE(says(table, "relative_viscosity to 5 % along /peclet")) << table;
  EXPECT_TRUE(says(table, "curve: the band of the curve over /peclet")) << table;
  EXPECT_TRUE(says(table, "converged, by-curve")) << table;
  EXPECT_EQ(exit_code_of(status), 0);
  int by_curve = 0;
  for (const PointSummary& point : status.points) {
    const ObservableStopTest& one = point.stop_tests.back().each.at(0);
    const std::vector<std::string> marks = reservations(point);
    const bool is_marked = std::ranges::find(marks, "by-curve") != marks.end();
    EXPECT_EQ(is_marked, one.share > 1);
    by_curve += is_marked ? 1 : 0;
  }
  EXPECT_GT(by_curve, 0);
}

TEST(CurveReports, PointsThatWaitAreSaid) {
  StoredCampaign campaign(curve_campaign());
  complete(campaign, 0, 10, 8);
  const CampaignStatus status = read_status(campaign.database());
  EXPECT_TRUE(status.points[0].waits);
  EXPECT_EQ(status.points[0].wanted, 8);
  EXPECT_EQ(status.points[0].wanted_ended, 8);
  EXPECT_TRUE(says(status_table(status, 200), "open, waits-for-curve"));
  EXPECT_TRUE(says(explain(campaign.database(), campaign.directory(), "peclet=0.1 window=9"),
                   "next: nothing, until other points of its curve have made their stop tests"));
  for (int point = 1; point < 6; ++point) complete(campaign, point, 10, 8);
  EXPECT_TRUE(says(explain(campaign.database(), campaign.directory(), ""),
                   "next: the stop test at 10 seeds; `peclet next` says what its curve needs"));
}

// The curve decides at fewer seeds than the points would, and its forecast after ten is one of the curve.
TEST(CurveReports, APlanIsOneOfTheCurve) {
  const auto plan_after = [](int seeds) {
    StoredCampaign campaign(curve_campaign());
    for (int point = 0; point < 6; ++point) complete(campaign, point, 10, seeds);
    std::map<std::string, PointHistory> known;
    for (const PointRecord& point : campaign.database().points())
      known[point.hash] = {{seeds, 1, 1}, campaign.database().outcomes(point.id)};
    return make_plan(curve_campaign(), std::vector<double>(6, 1e6), known, 1);
  };
  const Plan whole = plan_after(60), pilot = plan_after(10);
  EXPECT_TRUE(says(plan_text(whole), "every point is decided"));
  int seeds = 0;
  for (std::size_t i = 0; i < 6; ++i) {
    seeds += whole.points[i].decided->seeds;
    EXPECT_FALSE(pilot.points[i].decided);
  }
  EXPECT_LT(pilot.totals.seeds.lower, seeds);
  EXPECT_GT(pilot.totals.seeds.upper, seeds);
}

TEST(CurveReports, ExplainNamesBothWidths) {
  StoredCampaign campaign(curve_campaign());
  const std::string text = explain(decided(campaign).database(), campaign.directory(), "peclet=10 window=7");
  EXPECT_TRUE(says(text, "% by the curve (")) << text;
  EXPECT_TRUE(says(text, "curve of relative_viscosity over /peclet: ")) << text;
  EXPECT_TRUE(says(text, "standard deviations from the curve through the others, and at most ")) << text;
}

// The fourth point is half of the others.
TEST(CurveReports, ARefusedCurveIsSaid) {
  StoredCampaign campaign(curve_campaign());
  const CampaignStatus status = read_status(decided(campaign, 5).database());
  EXPECT_TRUE(says(status_table(status, 200), "curve-refused"));
  EXPECT_TRUE(says(status_table(status, 200), "off-curve"));
  const std::string text = explain(campaign.database(), campaign.directory(), "");
  EXPECT_TRUE(says(text, "the curve is refused, because this point contradicts it")) << text;
  EXPECT_TRUE(says(text, "the curve is refused, because another point contradicts it")) << text;
}

TEST(CurveReports, ExportsHaveTheBand) {
  StoredCampaign campaign(curve_campaign());
  decided(campaign);
  const Json whole = Json::parse(export_json(campaign.database(), true));
  const Json curve = whole["points"][2]["stop_test"]["observables"][0]["curve"];
  EXPECT_LT(curve["low"].get<double>(), curve["mean"].get<double>());
  EXPECT_LE(curve["share_of_tolerance"].get<double>(), 1);
  EXPECT_EQ(whole["target"]["curve"], Json({{"over", "/peclet"}, {"relative_tolerance", 0.05}}));
  const std::string csv = export_csv(campaign.database(), true);
  EXPECT_TRUE(says(csv, ",curve_mean,curve_low,curve_high,curve_refused,")) << csv;
  EXPECT_TRUE(says(csv, "," + canonical_json(curve["high"]) + ",0,")) << csv;
}

TEST(CurveReports, AStoredStopTestThatWasChangedIsFound) {
  StoredCampaign campaign(curve_campaign());
  decided(campaign);
  StopTestCheck check(campaign.database());
  const PointRecord point = campaign.database().points().at(2);
  EXPECT_TRUE(is_decided_by_curve(*check.last(point)) || check.last(point)->each[0].share <= 1);
  campaign.database().connection().run("UPDATE stop_test SET mean = mean + 1 WHERE point_id = ?", point.id);
  EXPECT_THROW(StopTestCheck(campaign.database()).last(point), IntegrityError);
}

TEST(CurveReports, ABandThatWasChangedIsFound) {
  StoredCampaign campaign(curve_campaign());
  const PointRecord point = decided(campaign).database().points().at(2);
  campaign.database().connection().run(
      "UPDATE stop_test SET observables = json_set(observables, '$[0].curve.high', 11) WHERE point_id = ?",
      point.id);
  EXPECT_THROW(StopTestCheck(campaign.database()).last(point), IntegrityError);
}

TEST(CurveReports, AFigureHasTheBand) {
  StoredCampaign campaign(curve_campaign());
  const Json figure = figure_data(decided(campaign).database(), {});
  for (const Json& point : figure["points"]) {
    EXPECT_LT(point["curve"]["low"].get<double>(), point["curve"]["high"].get<double>());
  }
}

}  // namespace
}  // namespace peclet::runner
