// Tests the status of points in every state.
#include "runner/reports/status.h"

#include <gtest/gtest.h>

#include <cmath>
#include <ctime>

#include "runner/reports/explain.h"
#include "runner/reports/export.h"
#include "runner/store/point_store.h"
#include "tests/runner/stored_campaign.h"

namespace peclet::runner {
namespace {

// Adds the values 9, 10, 11, 10 for unit 1: mean 10, sample variance 2/3, standard error sqrt(2/3/4) = 0.408.
void four_values(StoredCampaign& campaign, int point, double unit) {
  const double values[] = {-1, 0, 1, 0};
  for (int seed = 0; seed < 4; ++seed) campaign.complete(point, seed, 10 + unit * values[seed]);
}

TEST(Status, AnOpenPointShowsTheSeedsOfItsNextStopTestAndAProvisionalMean) {
  StoredCampaign campaign(1, 4, 20);
  four_values(campaign, 0, 1);  // half-width 3.777 * 0.408 = 15 %: the next stop test is at 5 seeds
  const CampaignStatus status = read_status(campaign.database());
  const PointSummary& point = status.points.at(0);
  EXPECT_FALSE(point.decided);
  EXPECT_EQ(point.wanted, 5);
  EXPECT_EQ(point.wanted_ended, 4);
  EXPECT_EQ(point.all_seeds.count, 4);
  EXPECT_DOUBLE_EQ(point.all_seeds.mean, 10.25);  // the control variate of plain_result() is 0.25
  EXPECT_DOUBLE_EQ(point.all_seeds.standard_error, std::sqrt(2.0 / 3 / 4));
  EXPECT_EQ(point.counts.cpu_seconds, 8);
  EXPECT_EQ(exit_code_of(status), 4);
  const std::string table = status_table(status);
  EXPECT_NE(table.find("4/5  10.25 ± 0.41  10.2 ± 1.5 (15 %)"), std::string::npos) << table;
  EXPECT_NE(table.find("1 point: 1 open\n4 seeds ended; processor time 8 s"), std::string::npos) << table;
}

TEST(Status, SaysWhySeedsWereLost) {
  StoredCampaign campaign(1, 4, 20);
  campaign.blow_up(0, 0, "packing");
  campaign.blow_up(0, 1, "packing");
  campaign.crash(0, 2);
  const CampaignStatus status = read_status(campaign.database());
  const std::string table = status_table(status);
  EXPECT_TRUE(says(table, "point=0: 2 lost, packing: too near (seed 0)\n")) << table;
  EXPECT_TRUE(says(table, "point=0: 1 lost, crashed: signal 11 (Segmentation fault) (seed 2)\n")) << table;
  const Json reasons = status_json(status)["points"][0]["loss_reasons"];
  EXPECT_EQ(reasons["packing"], "too near (seed 0)");
  const std::string text = explain(campaign.database(), campaign.directory(), "");
  EXPECT_TRUE(says(text, "lost: 2 packing (seeds 0, 1)\n    too near (seed 0)\n")) << text;
}

// Four of eight seeds have ended after 4 s each. One has made 10 of its 100 steps in 120 s. Kaplan and
// Meier's mean is (4 * 4 + 1200) / 5.
TEST(Status, TheForecastKnowsOfSeedsThatRun) {
  StoredCampaign campaign(1, 8, 20);
  for (int seed = 0; seed < 4; ++seed) campaign.complete(0, seed, 10 + 0.001 * seed);
  campaign.begin(0, 4);
  Connection& connection = campaign.database().connection();
  connection.execute("UPDATE attempt SET started_at = '2026-01-01T00:00:00Z' WHERE outcome = 'running'");
  connection.execute(
      "UPDATE lease SET phase = 'equilibration', step = 10, steps = 100, renewed_at = "
      "'2026-01-01T00:02:00Z'");
  CampaignStatus status = read_status(campaign.database());
  status.owner = 4711;
  ASSERT_EQ(status.forecasts.at(0).unfinished.size(), 1U);
  const double mean = (4 * 4 + 1200) / 5.0;
  ASSERT_TRUE(status.to_go);
  EXPECT_NEAR(status.to_go->likely, 3.5 * mean / 2, 1e-6);  // two workers, four seeds, one half done
  EXPECT_EQ(status_json(status)["seconds_to_go"], to_json(status.to_go));
  EXPECT_TRUE(
      says(workers_text(status), "process 4711 runs the campaign: " + to_string(*status.to_go) + "\n"));
  status.owner.reset();
  EXPECT_TRUE(says(workers_text(status), "`peclet run` continues it: " + to_string(*status.to_go) + "\n"));
}

TEST(Status, SeedsOfARunThatWasKilledAreNotCalledRunning) {
  StoredCampaign campaign(1, 4, 20);
  four_values(campaign, 0, 1);
  CampaignStatus status = read_status(campaign.database());
  status.points[0].counts.running = 2;
  EXPECT_NE(status_table(status).find("4 seeds ended; 2 were running when the run was killed; "),
            std::string::npos);
  status.owner = 4711;
  EXPECT_NE(status_table(status).find("4 seeds ended; 2 running; "), std::string::npos);
}

TEST(Status, APointThatWasCancelledIsNeitherOpenNorASuccess) {
  StoredCampaign campaign(2, 4, 20);
  four_values(campaign, 0, 0.1);
  const std::int64_t second = campaign.database().points().at(1).id;
  PointStore(campaign.database()).set_cancelled(second, true);
  const CampaignStatus status = read_status(campaign.database());
  EXPECT_EQ(exit_code_of(status), 3);
  EXPECT_EQ(verdict_text(status.points.at(1)), "cancelled");
  EXPECT_TRUE(status_json(status)["points"][1]["cancelled"]);
  EXPECT_TRUE(status_json(status)["points"][1]["verdict"].is_null());
  EXPECT_NE(status_table(status).find("2 points: 1 cancelled, 1 converged"), std::string::npos);
}

TEST(Status, ACancelledPointThatHadConvergedIsASuccess) {
  StoredCampaign campaign(1, 4, 20);
  four_values(campaign, 0, 0.1);
  PointStore(campaign.database()).set_cancelled(1, true);
  const CampaignStatus status = read_status(campaign.database());
  EXPECT_EQ(exit_code_of(status), 0);
  EXPECT_EQ(verdict_text(status.points.at(0)), "converged, cancelled");
}

// A jammed seed has a value under a given stress; otherwise it is lost. Both count as jammed.
TEST(Status, SaysWhatHasJammedHoweverItEnded) {
  StoredCampaign campaign(4, 4, 20);
  const auto stand_still = [](Json& result) { result["ending"]["cause"] = "jammed"; };
  for (int seed = 0; seed < 4; ++seed) campaign.complete(0, seed, 10 + 0.01 * seed);
  for (int seed = 0; seed < 2; ++seed) campaign.complete_with(1, seed, 1e-9, stand_still);
  for (int seed = 2; seed < 4; ++seed) campaign.complete(1, seed, 10 + 0.01 * seed);
  campaign.blow_up(2, 0, "overlap");
  campaign.blow_up(2, 1, "packing");
  campaign.crash(2, 2);
  campaign.complete_with(3, 0, 1e-9, stand_still);
  for (int seed = 1; seed < 4; ++seed) campaign.complete(3, seed, 10 + 0.01 * seed);
  const CampaignStatus status = read_status(campaign.database());
  const int jammed[] = {0, 2, 2, 1}, lost[] = {0, 0, 1, 0};
  const std::vector<std::string> marks[] = {{}, {"jammed"}, {"jammed"}, {}};
  for (std::size_t i = 0; i < 4; ++i) {
    const Endings& endings = status.points.at(i).endings;
    EXPECT_EQ(endings.jammed, jammed[i]) << i;
    EXPECT_EQ(endings.lost, lost[i]) << i;
    std::vector<std::string> found = reservations(status.points[i]);
    std::erase_if(found, [](const std::string& mark) { return mark != "jammed"; });
    EXPECT_EQ(found, marks[i]) << i;
    EXPECT_EQ(status_json(status)["points"][i]["endings"]["has_jammed"], i == 1 || i == 2);
  }
}

// Eight values 10.25 +- 1 have a half-width of t(7) / sqrt(7), about 9 %: not within 5 %, but within 50 %.
TEST(Status, ALoosenedToleranceSaysThatAnEarlierStopTestDecides) {
  StoredCampaign campaign(1, 8, 20);
  for (int seed = 0; seed < 13; ++seed) campaign.complete(0, seed, seed % 2 == 0 ? 9 : 11);
  EXPECT_EQ(read_status(campaign.database()).points.at(0).stop_tests.back().seeds, 13);
  EXPECT_FALSE(says(status_table(read_status(campaign.database())), "earlier-stop-test"));
  campaign.set_tolerance(0.5);
  const CampaignStatus status = read_status(campaign.database());
  ASSERT_EQ(status.points.at(0).stop_tests.back().seeds, 8);
  EXPECT_EQ(verdict_text(status.points.at(0)), "converged, earlier-stop-test");
  EXPECT_TRUE(says(status_table(status),
                   "point=0: the stop test at 8 seeds decides, because it is the first within the present "
                   "target; \"all seeds\" has all 13 that have ended\n"))
      << status_table(status);
  EXPECT_TRUE(
      says(explain(campaign.database(), campaign.directory(), ""),
           "it decides as if the target had always been this one, and leaves out later seeds; all 13"));
}

// Ten values 10.25 +- 0.5 with a maximum of 10 have a half-width of 2.262 * 0.5 / 3 = 0.377, or 3.7 %. The
// true spread may be sqrt(9 / chi2(9)) = 1.65 times as large (p = 5 %), and 10 seeds would not suffice.
TEST(Status, APointThatTheMaximumIsTooNearToIsMarked) {
  StoredCampaign campaign(1, 10, 10);
  for (int seed = 0; seed < 10; ++seed) campaign.complete(0, seed, seed % 2 == 0 ? 9.5 : 10.5);
  const CampaignStatus status = read_status(campaign.database());
  EXPECT_EQ(exit_code_of(status), 0);
  EXPECT_EQ(verdict_text(status.points.at(0)), "converged, near-maximum");
  EXPECT_EQ(status_json(status)["points"][0]["reservations"], Json({"near-maximum"}));
  EXPECT_TRUE(status_json(status)["points"][0]["stop_test"]["near_maximum"].get<bool>());
  EXPECT_TRUE(says(explain(campaign.database(), campaign.directory(), ""), "perhaps by luck"));
  EXPECT_TRUE(says(explain(campaign.database(), campaign.directory(), ""), "a larger /realisations/maximum"));
}

TEST(Status, EqualValuesHaveNoIntervalAndNoConvergence) {
  StoredCampaign campaign(1, 8, 10);
  for (int seed = 0; seed < 8; ++seed) campaign.complete(0, seed, 10);
  const auto explained = [&] { return explain(campaign.database(), campaign.directory(), ""); };
  CampaignStatus status = read_status(campaign.database());
  EXPECT_EQ(verdict_text(status.points.at(0)), "open, equal-values");
  EXPECT_TRUE(says(status_table(status), "10.2 ± -")) << status_table(status);
  EXPECT_TRUE(status_json(status)["points"][0]["stop_test"]["half_width"].is_null());
  EXPECT_TRUE(says(explained(), "; all values of relative_viscosity are equal")) << explained();
  for (int seed = 8; seed < 10; ++seed) campaign.complete(0, seed, 10);
  status = read_status(campaign.database());
  EXPECT_EQ(verdict_text(status.points.at(0)), "capped, equal-values");
  EXPECT_EQ(exit_code_of(status), 3);
  EXPECT_TRUE(says(explained(), "all 10 seeds that are allowed have ended, and all values of"))
      << explained();
}

TEST(Status, SeedsThatRepeatEachOtherAreNamed) {
  StoredCampaign campaign(1, 4, 4);
  for (int seed = 0; seed < 4; ++seed) {
    campaign.complete_with(0, seed, 10 + seed % 2, [&](Json& result) {
      result["final_state_sha256"] = std::string(64, seed % 2 == 0 ? 'a' : 'b');
    });
  }
  const CampaignStatus status = read_status(campaign.database());
  EXPECT_EQ(verdict_text(status.points.at(0)), "capped, repeated-seeds");
  EXPECT_EQ(status_json(status)["points"][0]["stop_test"]["repeated_seeds"], Json({2, 3}));
  EXPECT_TRUE(says(explain(campaign.database(), campaign.directory(), ""),
                   "seeds 2, 3 ended in the same state as an earlier one"));
}

// 8 ones in 8 have the half-width 1 - 0.0205^(1/8) = 0.385 at the level 1 - 0.05 (1 - 1.4 / 8) = 95.9 %.
TEST(Status, ASharesIntervalIsThatOfAShare) {
  Campaign plain = plain_campaign(1, 8, 100, 0.05);
  plain.target = {"flowing", Tolerance::absolute(0.1), 0.95};
  StoredCampaign campaign(plain);
  for (int seed = 0; seed < 8; ++seed) {
    campaign.complete_with(0, seed, 10, [](Json& result) {
      result["mean"] = {{"flowing", 1}};
      result["blocks"] = Json::object();
      result["quantities"] = {{"flowing", {{"symbol", "P"}, {"unit", "1"}, {"estimator", "share"}}}};
    });
  }
  const CampaignStatus status = read_status(campaign.database());
  const Json stop_test = status_json(status)["points"][0]["stop_test"];
  EXPECT_EQ(verdict_text(status.points.at(0)), "open, no-transient-test");
  EXPECT_NEAR(stop_test["half_width"].get<double>(), 1 - std::pow((1 - 0.95875) / 2, 1 / 8.0), 1e-9);
  const std::string text = explain(campaign.database(), campaign.directory(), "");
  // The forecast needs the kind of the values.
  ASSERT_EQ(status.forecasts.at(0).all_seeds.size(), 1U);
  EXPECT_EQ(status.forecasts.at(0).all_seeds[0].values, Estimate::Values::share);
  EXPECT_TRUE(says(text, "interval: 0.616 .. 1 of the share (Clopper and Pearson)")) << text;
  const Json exported = Json::parse(export_json(campaign.database(), true))["points"][0];
  EXPECT_EQ(exported["quantities"]["flowing"]["estimator"], "share");
  EXPECT_EQ(exported["quantities"]["flowing"]["half_width"], exported["stop_test"]["half_width"]);
}

TEST(Status, APointWithoutSeedsHasNoNumbers) {
  StoredCampaign campaign(1, 4, 20);
  const CampaignStatus status = read_status(campaign.database());
  const Json point = status_json(status)["points"][0];
  EXPECT_TRUE(point["stop_test"].is_null());
  EXPECT_TRUE(point["verdict"].is_null());
  EXPECT_TRUE(point["all_seeds"]["mean"].is_null());
  EXPECT_TRUE(point["all_seeds"]["standard_error"].is_null());
  EXPECT_EQ(point["seeds"]["wanted"], 4);
  EXPECT_NE(status_table(status).find("0/4"), std::string::npos);
}

TEST(Status, OneSeedHasAMeanButNoError) {
  StoredCampaign campaign(1, 4, 20);
  campaign.complete(0, 2, 10);
  const CampaignStatus status = read_status(campaign.database());
  const Json point = status_json(status)["points"][0];
  EXPECT_EQ(point["all_seeds"]["mean"], 10.25);
  EXPECT_TRUE(point["all_seeds"]["standard_error"].is_null());
}

TEST(Status, SeedsBeyondTheDecidingStopTestAreExtra) {
  StoredCampaign campaign(1, 4, 20);
  four_values(campaign, 0, 0.1);
  campaign.complete(0, 4, 1000);
  campaign.complete(0, 6, 1000);
  const CampaignStatus status = read_status(campaign.database());
  EXPECT_EQ(status.points[0].extra(), 2);
  EXPECT_EQ(status.points[0].wanted_ended, 4);
  EXPECT_EQ(exit_code_of(status), 0);
  EXPECT_NE(status_table(status).find("6 seeds ended, 2 extra"), std::string::npos) << status_table(status);
}

TEST(Status, LostSeedsAreCountedByCauseAndSaidWithTheVerdict) {
  StoredCampaign campaign(2, 4, 20);
  four_values(campaign, 0, 0.1);
  four_values(campaign, 1, 0.1);
  EXPECT_EQ(exit_code_of(read_status(campaign.database())), 0);

  StoredCampaign lossy(1, 6, 20);
  four_values(lossy, 0, 0.01);
  lossy.blow_up(0, 4);
  EXPECT_EQ(verdict_text(read_status(lossy.database()).points[0]), "open, 1 lost");
  lossy.crash(0, 5);
  const CampaignStatus status = read_status(lossy.database());
  EXPECT_EQ(verdict_text(status.points[0]), "converged-with-losses(2)");
  EXPECT_EQ(status.points[0].losses, (std::map<std::string, int>{{"crashed", 1}, {"overlap", 1}}));
  EXPECT_EQ(exit_code_of(status), 3);
}

TEST(Status, ASuspectPointIsAnIntegrityFault) {
  StoredCampaign campaign(1, 4, 20);
  four_values(campaign, 0, 0.1);
  campaign.repeat(0, 1, 10);
  EXPECT_EQ(exit_code_of(read_status(campaign.database())), 0);
  campaign.repeat(0, 1, 11);
  const CampaignStatus status = read_status(campaign.database());
  EXPECT_EQ(verdict_text(status.points[0]), "converged, suspect");
  EXPECT_EQ(exit_code_of(status), 6);
}

TEST(Status, SeedsThatWarnOfTheirResultsAreCountedWithTheVerdict) {
  StoredCampaign campaign(2, 4, 20);
  const auto warning = [](const char* code) { return Json{{"code", code}, {"message", "why"}}; };
  for (int seed = 0; seed < 4; ++seed) {
    campaign.complete(0, seed, 10 + 0.01 * seed,
                      Json::array({warning("inertia-shear"), warning("timestep")}));
    campaign.complete(1, seed, 10 + 0.01 * seed, Json::array({warning("inertia-shear")}));
  }
  const CampaignStatus status = read_status(campaign.database());
  EXPECT_EQ(verdict_text(status.points[0]), "converged, 4 flagged timestep");
  EXPECT_EQ(verdict_text(status.points[1]), "converged");
  EXPECT_EQ(status_json(status)["points"][0]["flags"], (Json{{"timestep", 4}}));
}

// The estimate without control variate, 10.00 ± 0.15, is only in `explain`.
TEST(Status, TheTableHasTheEstimateThatDecidesAlone) {
  StoredCampaign campaign(1, 4, 20);
  four_values(campaign, 0, 0.1);
  const std::string table = status_table(read_status(campaign.database()));
  EXPECT_NE(table.find("10.25 ± 0.15 (1.5 %)  converged\n"), std::string::npos) << table;
}

// 20 points have 800 seeds each. A user does not notice a third of a second.
TEST(Status, OfSixteenThousandRealisationsTakesBelowAThirdOfASecond) {
  StoredCampaign campaign(20, 10, 800);
  campaign.database().connection().execute(
      "WITH RECURSIVE seeds(seed) AS (SELECT 0 UNION ALL SELECT seed + 1 FROM seeds WHERE seed < 799) "
      "INSERT INTO realisation (point_id, seed, state, cause, cpu_seconds, final_state_sha256, "
      "content_sha256) "
      "SELECT point_id, seed, 'done', 'completed', 1, hash, hash FROM seeds, point;"
      "INSERT INTO number_layout VALUES (1, '{}');"
      // The observable, and 40 numbers of other quantities.
      "INSERT INTO numbers SELECT point_id, seed, 1, '[' || (10 + seed % 7) || ',null,null,null' || "
      "replace(hex(zeroblob(40)), '00', ',1.2345678901234567') || ']' FROM realisation");
  const std::clock_t start = std::clock();  // processor time, which does not depend on other processes
  const std::string table = status_table(read_status(campaign.database()));
  const std::clock_t spent = std::clock() - start;
  EXPECT_NE(table.find("16000 seeds ended"), std::string::npos);
  EXPECT_LT(static_cast<double>(spent) / CLOCKS_PER_SEC, 0.3);
}

}  // namespace
}  // namespace peclet::runner
