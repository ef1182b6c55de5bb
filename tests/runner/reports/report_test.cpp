// The page that a colleague gets.
#include "runner/reports/report.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "contract/sha256.h"
#include "runner/reports/export.h"
#include "runner/text/utc_time.h"
#include "tests/runner/stored_campaign.h"

namespace peclet::runner {
namespace {

// The first element that is closed without having been opened last, or never closed; "" when there is none.
std::string badly_nested(const std::string& html) {
  std::vector<std::string> open;
  for (std::size_t at = html.find('<'); at != std::string::npos; at = html.find('<', at + 1)) {
    const std::size_t end = html.find('>', at);
    const std::string tag = html.substr(at + 1, end - at - 1);
    const std::string name = tag.substr(0, tag.find_first_of(" \n"));
    if (name == "!DOCTYPE" || name == "meta" || name == "wbr" || tag.ends_with('/')) continue;
    if (!name.starts_with('/')) {
      open.push_back(name);
    } else if (open.empty() || '/' + open.back() != name) {
      return name;
    } else {
      open.pop_back();
    }
  }
  return open.empty() ? "" : open.back();
}

class Report : public testing::Test {
 protected:
  // 10.05 ± 0.41 with a control of 0.25; Student's t for 3 degrees of freedom is 3.182.
  void complete_widely(int point) {
    const double values[] = {9.05, 10.05, 11.05, 10.05};
    for (int seed = 0; seed < 4; ++seed) campaign_.complete(point, seed, values[seed]);
  }
  std::string page() { return report_html(campaign_.database()); }

  StoredCampaign campaign_{2, 4, 4};
};

TEST_F(Report, HasTheEstimateWithItsIntervalAndVerdict) {
  complete_widely(0);
  const std::string text = page();
  EXPECT_TRUE(says(text, "<td>4/4</td><td>10.3 ± 1.3</td><td>13 %</td>")) << text;
  EXPECT_TRUE(says(text, "<td class=\"text\">capped</td>")) << text;
  EXPECT_TRUE(says(text, "<td class=\"text\">open</td>")) << text;
  EXPECT_TRUE(says(text, "relative_viscosity to 5 % at 95 % confidence, with 4 to 4")) << text;
  EXPECT_TRUE(says(text, "1 point without an error is not drawn.")) << text;
  EXPECT_TRUE(says(text, "<dt>capped</dt>")) << text;
  EXPECT_FALSE(says(text, "Lost seeds")) << text;
}

TEST_F(Report, OfACampaignHalfDoneHasWhatIsKnownSoFarAndSaysSo) {
  complete_widely(0);
  EXPECT_FALSE(says(page(), "so far")) << page();
  campaign_.complete(1, 0, 9);
  campaign_.complete(1, 2, 11);
  // With the control of 0.25: mean 10.25, standard error |11 - 9| / 2.
  const std::string text = page();
  EXPECT_TRUE(says(text, "<td>2/4</td><td>10.2 ± 1.0 so far</td><td>-</td>")) << text;
  EXPECT_TRUE(says(text, "So far: provisional")) << text;
  EXPECT_TRUE(says(text, "class=\"provisional\"")) << text;
}

TEST_F(Report, IsReadableOnATelephone) {
  complete_widely(0);
  const std::string text = page();
  EXPECT_TRUE(says(text, "<th>relative_<wbr>viscosity</th>")) << text;
  EXPECT_TRUE(says(text, "<svg class=\"for-wide\"") && says(text, "<svg class=\"for-narrow\"")) << text;
}

TEST_F(Report, ListsLostSeedsByCauseAndWhatTheyMean) {
  for (int seed = 0; seed < 2; ++seed) campaign_.complete(0, seed, 10 + 0.001 * seed);
  campaign_.blow_up(0, 2);
  campaign_.crash(0, 3);
  const std::string text = page();
  EXPECT_TRUE(says(text, "<td class=\"text\">point=0</td><td class=\"text\">crashed</td><td>1</td>")) << text;
  EXPECT_TRUE(says(text, "<td class=\"text\">point=0</td><td class=\"text\">overlap</td><td>1</td>")) << text;
  EXPECT_TRUE(says(text, "<dt>converged-with-losses</dt>")) << text;
}

TEST_F(Report, ExplainsTheMarksAndShowsWhatTheEngineWarnsOf) {
  const Json warning = {{{"code", "overlap"}, {"message", "0.02 > 0.01 & more"}}};
  for (int seed = 0; seed < 4; ++seed) campaign_.complete(0, seed, 10, warning);
  const std::string text = page();
  EXPECT_TRUE(says(text, "<td class=\"text\">4 flagged overlap</td>")) << text;
  EXPECT_TRUE(says(text, "<dt>flagged overlap</dt><dd>seeds in which spheres overlapped")) << text;
  EXPECT_TRUE(says(text, "overlap: 0.02 &gt; 0.01 &amp; more")) << text;
}

TEST_F(Report, SaysWhereItComesFromAndHowToMakeItAgain) {
  complete_widely(0);
  const std::string text = page();
  EXPECT_TRUE(says(text, sha256("engine"))) << text;  // the binary of plain_engine()
  EXPECT_TRUE(says(text, sha256(canonical_json(campaign_.database().campaign().document)))) << text;
  EXPECT_TRUE(says(text, sha256(export_json(campaign_.database(), true)))) << text;
  EXPECT_TRUE(says(text, "peclet run plain.json")) << text;
}

TEST_F(Report, IsOnePieceThatNeedsNoOtherFile) {
  complete_widely(0);
  complete_widely(1);
  const std::string text = page();
  EXPECT_EQ(badly_nested(text), "") << text;
  EXPECT_TRUE(says(text, "<svg class")) << text;
  for (const char* const outside : {"http", "src=", "href=", "url(", "@import", "<script"}) {
    EXPECT_FALSE(says(text, outside)) << outside;
  }
}

TEST_F(Report, DependsOnTheDatabaseAlone) {
  complete_widely(0);
  for (const char* const aged : {"campaign SET created_at", "campaign SET updated_at", "look SET made_at",
                                 "attempt SET started_at", "attempt SET ended_at", "event SET at"}) {
    campaign_.database().connection().execute(fmt::format("UPDATE {} = '2001-02-03T04:05:06Z'", aged));
  }
  const std::string before = page();
  // Elsewhere, and with nothing in it that was read off a clock now.
  const TemporaryFolder elsewhere;
  campaign_.database().connection().execute(
      fmt::format("VACUUM INTO '{}'", (elsewhere.path() / "copy.db").string()));
  Database reader = Database::open_reader(elsewhere.path() / "copy.db");
  EXPECT_EQ(report_html(reader), before);
  EXPECT_FALSE(says(before, utc_now().substr(0, 10))) << before;
}

TEST_F(Report, IsRefusedWhenALookIsNotWhatTheResultsSay) {
  complete_widely(0);
  campaign_.database().connection().execute("UPDATE look SET mean = 9");
  EXPECT_THROW(page(), IntegrityError);
}

}  // namespace
}  // namespace peclet::runner
