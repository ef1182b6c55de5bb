// Campaigns that choose values of a curve's axis, in processes of their own.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <csignal>

#include "contract/durable_file.h"
#include "runner/command_line/ask_owner.h"
#include "runner/owner/open_campaign.h"
#include "runner/reports/next.h"
#include "runner/reports/status.h"
#include "tests/runner/campaign_process.h"

namespace peclet::runner {
namespace {

// The band from 4 to 100 is too wide at first.
void make_choosing(CampaignOnDisk& campaign, int points) {
  campaign.document["sweep"][0]["values"] = {1, 2, 3, 4, 100};
  campaign.document["target"] = Json::parse(R"({"curve": {"over": "/peclet", "relative_tolerance": 0.05}})");
  campaign.document["choose"]["points"] = points;
}

Json chosen_by(const CampaignOnDisk& campaign) {
  return chosen_values(campaign.reader().campaign().document);
}

std::string difference(const CampaignOnDisk& campaign) {
  return difference_from_file(campaign.options.campaign, {}, campaign.reader().campaign());
}

double width_of(const CampaignOnDisk& campaign) {
  NextOptions options;
  options.campaign = campaign.directory().root();
  options.json = true;
  return Json::parse(propose_next(options).text)["curves"][0]["width"].get<double>();
}

TEST(Choosing, NarrowsTheBandBetweenThePointsForAnyNumberOfWorkers) {
  CampaignOnDisk plain, campaign, other;
  make_choosing(plain, 5);
  ASSERT_EQ(plain.run(), 0) << plain.log();
  EXPECT_EQ(chosen_by(plain), Json::array());
  EXPECT_GT(width_of(plain), 0.05);

  make_choosing(campaign, 12);
  campaign.options.workers = 1;
  ASSERT_EQ(campaign.run(), 0) << campaign.log();
  const Json chosen = chosen_by(campaign);
  ASSERT_GE(chosen.size(), 1U);
  ASSERT_LT(chosen.size(), 7U);
  EXPECT_LE(width_of(campaign), 0.05);
  for (const Json& value : chosen) {
    EXPECT_GT(value.get<double>(), 1);
    EXPECT_LT(value.get<double>(), 100);
  }
  EXPECT_EQ(read_json(campaign.options.campaign), campaign.document);
  EXPECT_EQ(difference(campaign), "");
  Database database = campaign.reader();
  EXPECT_TRUE(says(status_table(read_status(database)), " of at most 12 values of /peclet; chosen: "));

  make_choosing(other, 12);
  other.options.workers = 3;
  ASSERT_EQ(other.run(), 0) << other.log();
  EXPECT_EQ(chosen_by(other), chosen);
  EXPECT_EQ(other.answer(), campaign.answer());
}

// A campaign that has chosen one value and would choose more.
void run_to_its_end(CampaignOnDisk& campaign) {
  make_choosing(campaign, 6);
  campaign.document["target"]["curve"]["relative_tolerance"] = 0.03;
  ASSERT_EQ(campaign.run(), 0) << campaign.log();
}

TEST(Choosing, EndsAtTheNumberOfValuesAndTellsPrograms) {
  CampaignOnDisk campaign;
  campaign.options.jsonl = true;
  run_to_its_end(campaign);
  const Json chosen = chosen_by(campaign);
  ASSERT_EQ(chosen.size(), 1U);
  EXPECT_TRUE(says(campaign.log(), fmt::format(R"("event":"value-chosen","observable":"relative_viscosity",)"
                                               R"("schema_version":1,"value":{},)",
                                               chosen[0].dump())))
      << campaign.log();
  Database database = campaign.reader();
  EXPECT_EQ(status_json(read_status(database)).at("chosen"), chosen);
  EXPECT_GT(width_of(campaign), 0.03);
}

// The values stay although the file does not name them.
TEST(Choosing, StaysChosenInTheNextRunAndForANewTolerance) {
  CampaignOnDisk campaign;
  make_choosing(campaign, 6);
  ASSERT_EQ(campaign.run(), 0) << campaign.log();
  const Json chosen = chosen_by(campaign);
  const std::int64_t results = campaign.count("SELECT count(*) FROM result");
  ASSERT_EQ(campaign.run(), 0) << campaign.log();
  EXPECT_EQ(chosen_by(campaign), chosen);
  EXPECT_EQ(campaign.count("SELECT count(*) FROM result"), results);

  SetOptions options;
  options.campaign = campaign.options.campaign;
  options.tolerance = 0.04;
  const Reply reply = set_campaign(options);
  EXPECT_TRUE(says(reply.text, "tolerance 5 % along /peclet -> 4 % along /peclet")) << reply.text;
  EXPECT_FALSE(says(reply.text, "left out")) << reply.text;
  EXPECT_EQ(chosen_by(campaign), chosen);
  EXPECT_EQ(difference(campaign), "");
}

// Without a curve nothing is chosen, and what follows from the results with the curve is the same again.
TEST(Choosing, FollowsFromTheResults) {
  CampaignOnDisk campaign;
  make_choosing(campaign, 12);
  ASSERT_EQ(campaign.run(), 0) << campaign.log();
  const Json chosen = chosen_by(campaign), document = campaign.document;
  const std::string answer = campaign.answer();
  const std::int64_t results = campaign.count("SELECT count(*) FROM result");
  campaign.document.erase("target");
  campaign.document.erase("choose");
  campaign.document["realisations"] = 8;
  ASSERT_EQ(campaign.run(), 0) << campaign.log();
  EXPECT_EQ(chosen_by(campaign), Json::array());
  campaign.document = document;
  ASSERT_EQ(campaign.run(), 0) << campaign.log();
  EXPECT_EQ(chosen_by(campaign), chosen);
  EXPECT_EQ(campaign.answer(), answer);
  EXPECT_EQ(campaign.count("SELECT count(*) FROM result"), results);
}

TEST(Choosing, GivesTheSameAnswerAfterKills) {
  CampaignOnDisk undisturbed, campaign;
  make_choosing(undisturbed, 8);
  ASSERT_EQ(undisturbed.run(), 0) << undisturbed.log();
  make_choosing(campaign, 8);
  campaign.options.workers = 3;
  const Environment slow{{"PECLET_FAKE_STEP_MS", "1"}};
  const auto all = static_cast<int>(undisturbed.count("SELECT count(*) FROM result"));
  for (int kill = 1; kill < 6; ++kill) {
    campaign.start(slow);
    campaign.wait_for_results(all * kill / 7);
    campaign.signal(SIGKILL);
    ASSERT_EQ(campaign.finish(), -SIGKILL) << campaign.log();
  }
  ASSERT_EQ(campaign.run(slow), 0) << campaign.log();
  EXPECT_EQ(chosen_by(campaign), chosen_by(undisturbed));
  EXPECT_EQ(campaign.answer(), undisturbed.answer());
}

// The proposed file has what was chosen, as its author may want to run it elsewhere.
TEST(Choosing, IsInTheFileThatNextWrites) {
  CampaignOnDisk campaign;
  run_to_its_end(campaign);
  NextOptions options;
  options.campaign = campaign.options.campaign;
  options.write = campaign.directory().root().parent_path() / "next.json";
  propose_next(options);
  const Campaign proposed = read_campaign(options.write);
  const double chosen = chosen_by(campaign)[0].get<double>();
  EXPECT_EQ(std::ranges::count(proposed.curves[0].axis, chosen), 1);
  EXPECT_GT(proposed.curves[0].axis.size(), 6U);
}

}  // namespace
}  // namespace peclet::runner
