// The page of a campaign: its document and its file. tests/pages tests it in a browser.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include "contract/documents.h"
#include "contract/sha256.h"
#include "runner/campaign/number_text.h"
#include "runner/campaign/quoting.h"
#include "runner/page/joined_page.h"
#include "runner/page/page_data.h"
#include "runner/page/page_html.h"
#include "runner/reports/export.h"
#include "runner/store/point_store.h"
#include "tests/contract/refusal.h"
#include "tests/runner/stored_campaign.h"

namespace peclet::runner {
namespace {

class CampaignPage : public testing::Test {
 protected:
  // 10.05 ± 0.41 with a control of 0.25; Student's t for 3 degrees of freedom is 3.182.
  void complete_widely(int point) {
    const double values[] = {9.05, 10.05, 11.05, 10.05};
    for (int seed = 0; seed < 4; ++seed) campaign_.complete(point, seed, values[seed]);
  }
  Json data() { return page_data(campaign_.database(), std::nullopt); }
  Json estimate(const Json& data, std::size_t point, const std::string& path) {
    for (std::size_t i = 0; i < data["quantities"].size(); ++i) {
      if (data["quantities"][i]["path"] == path) return data["points"][point]["estimates"][i];
    }
    return nullptr;
  }

  StoredCampaign campaign_{2, 4, 4};
};

TEST_F(CampaignPage, HasTheEstimateThatDecidesAndEveryOther) {
  complete_widely(0);
  const Json page = data();
  const double error = std::sqrt(2.0 / 3) / 2;
  const Json deciding = estimate(page, 0, "relative_viscosity");
  EXPECT_NEAR(deciding[0], 10.3, 1e-12);
  EXPECT_NEAR(deciding[1], error, 1e-12);
  EXPECT_NEAR(deciding[2], 3.18244630528 * error, 1e-9);
  EXPECT_EQ(deciding[3], 4);
  EXPECT_NEAR(page["points"][0]["plain"]["relative_viscosity"][0], 10.05, 1e-12);
  EXPECT_NEAR(estimate(page, 0, "pressure")[0], 20.1, 1e-12);
  EXPECT_NEAR(page["points"][0]["good_enough"]["relative_viscosity"], 0.05 * 10.3, 1e-12);
  EXPECT_EQ(page["points"][0]["state"], "capped");
  EXPECT_EQ(page["points"][1]["state"], "open");
  EXPECT_EQ(estimate(page, 1, "pressure"), nullptr);
  EXPECT_EQ(page["progress"]["decided"], 1);
  EXPECT_EQ(page["progress"]["cpu_seconds"], 8);
  EXPECT_TRUE(page["meanings"].contains("capped"));
}

// The mean of an open point is that of all seeds that have ended: 10.25, with standard error |11 - 9| / 2.
TEST_F(CampaignPage, OfAnOpenPointHasWhatIsKnownSoFar) {
  campaign_.complete(1, 0, 9);
  campaign_.complete(1, 2, 11);
  campaign_.database().connection().execute(
      "UPDATE attempt SET worker = attempt_id, started_at = '2026-01-01T00:00:00Z'");
  const Json page = data();
  const Json all_seeds = estimate(page, 1, "relative_viscosity");
  EXPECT_EQ(all_seeds[0], 10.25);
  EXPECT_EQ(all_seeds[1], 1);
  EXPECT_EQ(all_seeds[3], 2);
  const Json& point = page["points"][1];
  EXPECT_EQ(point["decided"], false);
  EXPECT_EQ(point["seeds"]["tested"], nullptr);
  EXPECT_EQ(point["seeds"]["wanted_ended"], 2);
  EXPECT_EQ(point["running_mean"]["seeds"], Json({1}));  // seed 1 has not ended
  // Two points of four seeds each, of which two have ended, at 4 s on the wall, for two workers.
  EXPECT_EQ(page["progress"]["seconds_to_go"]["likely"], 12);
}

TEST_F(CampaignPage, ShowsHowAMeanCameAbout) {
  complete_widely(0);
  const Json page = data();
  const Json& point = page["points"][0];
  EXPECT_EQ(point["running_mean"]["seeds"], Json({1, 2, 3, 4}));
  EXPECT_EQ(point["running_mean"]["mean"], Json({9.3, 9.8, 10.3, 10.3}));
  EXPECT_EQ(point["running_mean"]["half_width"][0], nullptr);
  EXPECT_NEAR(point["running_mean"]["half_width"][1], 12.7062 * 0.5, 1e-4);  // six digits are kept
  EXPECT_EQ(point["scatter"]["seeds"], Json({1, 2, 3, 4}));
  EXPECT_EQ(point["scatter"]["values"], Json({9.3, 10.3, 11.3, 10.3}));
  ASSERT_EQ(point["stop_tests"].size(), 1U);
  EXPECT_EQ(point["stop_tests"][0]["seeds"], 4);
  EXPECT_EQ(point["stop_tests"][0]["verdict"], "capped");
}

TEST_F(CampaignPage, KeepsItsSizeHoweverManySeedsThereAre) {
  StoredCampaign large(1, 400, 400);
  for (int seed = 0; seed < 400; ++seed) large.complete(0, seed, 10 + 0.01 * (seed % 10));
  const Json page = page_data(large.database(), std::nullopt);
  const Json& point = page["points"][0];
  EXPECT_LE(point["running_mean"]["seeds"].size(), 60U);
  EXPECT_EQ(point["running_mean"]["seeds"].back(), 400);
  ASSERT_EQ(point["scatter"]["counts"].size(), 20U);  // the root of 400
  int seeds = 0;
  for (const Json& count : point["scatter"]["counts"]) seeds += count.get<int>();
  EXPECT_EQ(seeds, 400);
  EXPECT_EQ(point["scatter"]["counts"].front(), 40);
  EXPECT_EQ(point["scatter"]["low"], 10.25);
}

// Blocks of 1, 2 ... 32 plus the seed, and control variates of 0.25 in every one: means of seeds 0 to 3
// are 2.5 + k.
TEST_F(CampaignPage, ShowsTheCourseWithinTheWindow) {
  for (int seed = 0; seed < 4; ++seed) {
    campaign_.complete_with(0, seed, 10, [&](Json& result) {
      Json& blocks = result["blocks"] = {{"relative_viscosity", Json::array()}};
      for (int k = 0; k < 32; ++k) blocks["relative_viscosity"].push_back(1 + k + seed);
      blocks["relative_viscosity"][7] = seed == 0 ? Json(nullptr) : Json(8 + seed);
    });
  }
  const Json details = data()["points"][0]["details"];
  EXPECT_EQ(details["seeds"], 4);
  EXPECT_EQ(details["of"], 4);
  ASSERT_EQ(details["blocks"]["mean"].size(), 32U);
  EXPECT_EQ(details["blocks"]["mean"][0], 2.5);
  EXPECT_EQ(details["blocks"]["mean"][7], 10);  // of 9, 10 and 11
  EXPECT_EQ(details["blocks"]["mean"][31], 33.5);
  // Student's t of 3.182 times the root of 5/3 over 4.
  EXPECT_NEAR(details["blocks"]["half_width"][0], 3.18244630528 * std::sqrt(5.0 / 12), 1e-9);
}

TEST_F(CampaignPage, SaysWhoWorkedOnWhat) {
  campaign_.complete(1, 3, 10);
  campaign_.crash(0, 2);
  const Json work = data()["work"];
  ASSERT_EQ(work["attempts"].size(), 2U);
  EXPECT_EQ(work["attempts"][0]["point"], 1);
  EXPECT_EQ(work["attempts"][0]["seed"], 3);
  EXPECT_EQ(work["attempts"][0]["outcome"], "result");
  EXPECT_EQ(work["attempts"][1]["point"], 0);
  EXPECT_EQ(work["attempts"][1]["outcome"], "crashed");
  EXPECT_EQ(work["now"], Json::array());
}

TEST_F(CampaignPage, ListsLostSeedsByCauseAndWhatTheyMean) {
  for (int seed = 0; seed < 2; ++seed) campaign_.complete(0, seed, 10 + 0.001 * seed);
  campaign_.blow_up(0, 2);
  campaign_.crash(0, 3);
  const Json page = data();
  EXPECT_EQ(page["points"][0]["losses"], Json({{"crashed", 1}, {"overlap", 1}}));
  EXPECT_TRUE(page["meanings"].contains("converged-with-losses"));
  EXPECT_EQ(page["progress"]["seeds"]["lost"], 2);
}

TEST_F(CampaignPage, ExplainsTheMarksAndShowsWhatTheEngineWarnsOf) {
  const Json warning = {{{"code", "overlap"}, {"message", "0.02 > 0.01 & more"}}};
  for (int seed = 0; seed < 4; ++seed) campaign_.complete(0, seed, 10 + 0.01 * seed, warning);
  const Json page = data();
  EXPECT_EQ(page["points"][0]["marks"][0], "4 flagged overlap");
  EXPECT_TRUE(says(page["meanings"]["flagged overlap"], "contacts overlapped"));
  EXPECT_EQ(page["warnings"][0]["message"], "0.02 > 0.01 & more");
}

// One of four seeds has jammed, which is too few for the point to be jammed.
TEST_F(CampaignPage, TellsAFlaggedJamFromAPointThatHasJammed) {
  campaign_.complete_with(0, 0, 10, [](Json& result) {
    result["ending"]["cause"] = "jammed";
    result["warnings"] = {{{"code", "jammed"}, {"message", "stands still"}}};
  });
  const Json warning = {{{"code", "patience"}, {"message", "too short"}}};
  for (int seed = 1; seed < 4; ++seed) campaign_.complete(0, seed, 10 + 0.01 * seed, warning);
  const Json meanings = data()["meanings"];
  EXPECT_FALSE(meanings.contains("jammed"));
  EXPECT_TRUE(says(meanings["flagged jammed"], "stood still")) << meanings;
  EXPECT_TRUE(says(meanings["flagged patience"], "window is too short")) << meanings;
}

// The viscosity is 10.265 with a standard deviation of 0.01 sqrt(5/3); 3.182 is Student's t for 3 degrees of
// freedom. The rule subtracts the half-width of the observable to which the tolerance is relative.
TEST_F(CampaignPage, ShowsWhatTheRuleAllowsOfAnObservableThatAnotherMeasures) {
  Tolerance tolerance(0.05);
  tolerance.relative_to = "relative_viscosity";
  StoredCampaign several(1, 4, 4, {{"pressure", tolerance}});
  for (int seed = 0; seed < 4; ++seed) several.complete(0, seed, 10 + 0.01 * seed);
  const Json page = page_data(several.database(), std::nullopt);
  const double half_width = 3.18244630528 * 0.01 * std::sqrt(5.0 / 3) / 2;
  EXPECT_NEAR(page["points"][0]["good_enough"]["pressure"], 0.05 * (10.265 - half_width), 1e-9);
}

TEST_F(CampaignPage, ShowsEveryCriterionOfATarget) {
  StoredCampaign several(1, 4, 4, {{"pressure", Tolerance::absolute(0.5)}});
  for (int seed = 0; seed < 4; ++seed) several.complete(0, seed, 10 + 0.01 * seed);
  const Json page = page_data(several.database(), std::nullopt);
  EXPECT_EQ(page["points"][0]["good_enough"]["pressure"], 0.5);
  EXPECT_NEAR(estimate(page, 0, "pressure")[0], 20.03, 1e-12);
}

TEST_F(CampaignPage, OfTwoCampaignsHasThePointsOfBoth) {
  complete_widely(0);
  StoredCampaign other(1, 4, 4, {{"pressure", Tolerance::absolute(0.5)}});
  for (int seed = 0; seed < 4; ++seed) other.complete(0, seed, 20 + 0.01 * seed);
  const auto both = [&] {
    return joined_page({{campaign_.database(), "rough"}, {other.database(), "smooth"}});
  };
  const Json page = both(), own = data(), of_other = page_data(other.database(), std::nullopt);
  ASSERT_EQ(page["points"].size(), 3U);
  EXPECT_EQ(page["parameters"][0]["pointer"], "campaign");
  EXPECT_EQ(page["points"][1]["label"], "rough: point=1");
  EXPECT_EQ(page["points"][2]["label"], "smooth: point=0");
  EXPECT_EQ(page["points"][2]["settings"], (Json{{"/point", 0}, {"campaign", "smooth"}}));
  for (const char* const path : {"relative_viscosity", "pressure", "stress/total/3"}) {
    EXPECT_EQ(estimate(page, 0, path), estimate(own, 0, path)) << path;
    EXPECT_EQ(estimate(page, 2, path), estimate(of_other, 0, path)) << path;
  }
  EXPECT_EQ(page["progress"]["points"], 3);
  EXPECT_EQ(page["progress"]["decided"], 2);
  EXPECT_EQ(page["progress"]["states"], (Json{{"capped", 1}, {"converged", 1}, {"open", 1}}));
  EXPECT_EQ(page["progress"]["cpu_seconds"], 16);
  EXPECT_TRUE(says(page["target"]["text"], "smooth: ")) << page["target"];
  EXPECT_EQ(page["documents"][1]["document"], other.database().campaign().document);
  other.set_target({"pressure", Tolerance::absolute(0.5), 0.95});
  EXPECT_EQ(refusal_by([&] { both(); }),
            "--with: smooth: must have the observable of the first campaign, \"relative_viscosity\"; it has "
            "\"pressure\"");
}

TEST_F(CampaignPage, SaysWhereItComesFromAndHowToMakeItAgain) {
  complete_widely(0);
  const Json page = data();
  const std::string provenance = page["provenance"].dump();
  EXPECT_TRUE(says(provenance, sha256("engine"))) << provenance;  // the binary of plain_engine()
  EXPECT_TRUE(says(provenance, sha256(canonical_json(campaign_.database().campaign().document))));
  EXPECT_TRUE(says(page["commands"], sha256(export_csv(campaign_.database(), true))));
  EXPECT_TRUE(says(page["commands"], "peclet run plain.json"));
  EXPECT_EQ(page["document"], campaign_.database().campaign().document);
}

TEST_F(CampaignPage, CallsAKeyOfASceneWhatTheEngineCallsIt) {
  complete_widely(0);
  EXPECT_EQ(data()["parameters"], Json::parse(R"([{"pointer": "/point", "words": "", "symbol": "", "unit": "",
                                                   "meaning": ""}])"));
  const Json hello = Json::parse(
      R"({"type": "hello", "protocol": 1, "engine": {}, "derived": [{"name": "peclet", "symbol": "Pe"}], "scene_schema":
      {"properties": {"point": {"title": "place in a row", "symbol": "p_0", "description": "Where.", "unit": "1"}}}})");
  keep_vocabulary(campaign_.database(), Vocabulary(checked_frame(hello)));
  const Json page = data();
  EXPECT_EQ(page["parameters"],
            Json::parse(R"([{"pointer": "/point", "words": "place in a row", "symbol": "p_0",
                                                 "unit": "1", "meaning": "Where."}])"));
  EXPECT_EQ(page["derived"], Json::parse(R"([{"name": "peclet", "words": "", "symbol": "Pe", "unit": ""}])"));
}

TEST_F(CampaignPage, DependsOnTheDatabaseAlone) {
  complete_widely(0);
  for (const char* const aged :
       {"campaign SET created_at", "campaign SET updated_at", "stop_test SET made_at",
        "attempt SET started_at", "attempt SET ended_at", "event SET at"}) {
    campaign_.database().connection().execute(fmt::format("UPDATE {} = '2001-02-03T04:05:06Z'", aged));
  }
  const std::string before = report_html(campaign_.database());
  // A copy in another folder gives the same page, which has no time of the present clock.
  const TemporaryFolder elsewhere;
  campaign_.database().connection().execute(
      fmt::format("VACUUM INTO '{}'", (elsewhere.path() / "copy.db").string()));
  Database reader = Database::open_reader(elsewhere.path() / "copy.db");
  EXPECT_EQ(report_html(reader), before);
  EXPECT_FALSE(says(before, utc_now().substr(0, 10)));
}

TEST_F(CampaignPage, IsRefusedWhenAStopTestIsNotWhatTheResultsSay) {
  complete_widely(0);
  campaign_.database().connection().execute("UPDATE stop_test SET mean = 9");
  EXPECT_THROW(data(), IntegrityError);
}

// Returns the text between `begin` and `end`.
std::string between(const std::string& text, const std::string& begin, const std::string& end) {
  const std::size_t from = text.find(begin) + begin.size();
  return text.substr(from, text.find(end, from) - from);
}

TEST(PageFile, NothingInItsDataCanEndItsElement) {
  const Json data{{"campaign", "</script><img onerror=alert(1)> & <!--"}};
  const std::string page = page_html(data);
  const std::string inside = between(page, "id=\"data\">", "</script>");
  EXPECT_EQ(inside.find_first_of("<>&"), std::string::npos) << inside;
  EXPECT_EQ(Json::parse(inside), data);
  EXPECT_TRUE(says(page, "<h1>&lt;/script&gt;&lt;img onerror=alert(1)&gt; &amp; &lt;!--</h1>"));
  EXPECT_FALSE(says(page, "<img"));
}

TEST(PageFile, AllowsNoScriptButItsOwnAndNoOtherPlace) {
  const std::string page = page_html({{"campaign", "plain"}});
  const std::string policy = between(page, "Content-Security-Policy\" content=\"", "\"");
  EXPECT_TRUE(policy.starts_with("default-src 'none'; ")) << policy;
  EXPECT_TRUE(
      says(policy, "script-src 'sha256-" + sha256_base64(between(page, "<script>", "</script>")) + "'"))
      << policy;
  EXPECT_TRUE(says(policy, "style-src 'sha256-" + sha256_base64(page_style) + "'")) << policy;
  EXPECT_FALSE(says(policy, "unsafe")) << policy;
  for (const char* const outside : {"https:", "src=", "<link", "url(", "@import", "innerHTML", "eval("}) {
    EXPECT_FALSE(says(page, outside)) << outside;
  }
}

TEST(Html, EveryCharacterThatMeansSomethingIsEscaped) {
  EXPECT_EQ(escaped("<a href='x' id=\"y\">&amp;"), "&lt;a href=&#39;x&#39; id=&quot;y&quot;&gt;&amp;amp;");
  EXPECT_EQ(escaped("φ ± 1\n\t"), "φ ± 1\n\t");
  EXPECT_EQ(escaped(std::string("a\0b\x1b\x7f", 5)), "a\uFFFDb\uFFFD\uFFFD");
}

}  // namespace
}  // namespace peclet::runner
