// The command of --notify: what a run tells it, and how its failure is reported.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "contract/durable_file.h"
#include "runner/command_line/run.h"
#include "tests/runner/campaign_process.h"

namespace peclet::runner {
namespace {

// Returns a command that writes its variables into a file in the campaign's folder, one on each line.
std::string noting(const CampaignOnDisk& campaign) {
  return "printf '%s\\n' \"$PECLET_SUMMARY\" $PECLET_EXIT_CODE \"$PECLET_CAMPAIGN\" > '" +
         (campaign.directory().root() / "note").string() + "'; test -e \"$PECLET_DIRECTORY/campaign.db\"";
}

std::string note_of(const CampaignOnDisk& campaign) {
  return read_file(campaign.directory().root() / "note");
}

bool has_note(const CampaignOnDisk& campaign) {
  return std::filesystem::exists(campaign.directory().root() / "note");
}

TEST(Notification, HasTheTotalsOfARunThatConverged) {
  CampaignOnDisk campaign;
  campaign.options.notify = noting(campaign);
  ASSERT_EQ(campaign.run(), 0) << campaign.log();
  const std::string name = campaign.document.at("name").get<std::string>();
  EXPECT_EQ(note_of(campaign),
            name + ": 2 points: 2 converged\n0\n" + campaign.options.campaign.string() + "\n");
}

TEST(Notification, ComesWithJsonLinesToo) {
  CampaignOnDisk campaign;
  campaign.options.notify = noting(campaign);
  campaign.options.jsonl = true;
  ASSERT_EQ(campaign.run(), 0) << campaign.log();
  EXPECT_TRUE(has_note(campaign));
}

TEST(Notification, SaysThatAPointIsCapped) {
  CampaignOnDisk campaign(1);
  campaign.document["realisations"]["maximum"] = 9;
  campaign.options.notify = noting(campaign);
  ASSERT_EQ(campaign.run({{"PECLET_FAKE_DEVIATION", "9"}}), 3) << campaign.log();
  EXPECT_NE(note_of(campaign).find(": 1 point: 1 capped\n3\n"), std::string::npos) << note_of(campaign);
}

TEST(Notification, OfAStoppedRunSaysSo) {
  CampaignOnDisk campaign;
  campaign.options.notify = noting(campaign);
  campaign.options.time_limit = 0.3;
  ASSERT_EQ(campaign.run({{"PECLET_FAKE_STEP_MS", "20"}}), 75) << campaign.log();
  EXPECT_NE(note_of(campaign).find(": stopped; 2 points: "), std::string::npos) << note_of(campaign);
}

TEST(Notification, IsNotSentOfAFaultyFile) {
  CampaignOnDisk campaign;
  campaign.options.notify = "touch '" + (campaign.directory().root().parent_path() / "note").string() + "'";
  campaign.document["target"]["relative_tolerance"] = -1;
  ASSERT_EQ(campaign.run(), 2) << campaign.log();
  EXPECT_FALSE(std::filesystem::exists(campaign.directory().root().parent_path() / "note"));
}

TEST(Notification, ThatFailsChangesNothingOfTheRun) {
  CampaignOnDisk campaign;
  campaign.options.notify = "echo no such mailbox >&2; exit 4";
  EXPECT_EQ(campaign.run(), 0) << campaign.log();
  const RunOutcome outcome{"a.json", "a.peclet", 0, "done"};
  EXPECT_EQ(notify(campaign.options.notify, outcome),
            "--notify: echo no such mailbox >&2; exit 4: exit status 4: no such mailbox");
  EXPECT_EQ(notify("true", outcome), "");
}

// The command may run the campaign again, because the owner has released it.
TEST(Notification, ComesWhenNobodyHoldsTheCampaignAnyMore) {
  CampaignOnDisk campaign;
  const std::filesystem::path lock = campaign.directory().lock();
  campaign.options.notify = "flock --nonblock '" + lock.string() + "' true && touch '" +
                            (campaign.directory().root() / "note").string() + "'";
  ASSERT_EQ(campaign.run(), 0) << campaign.log();
  EXPECT_TRUE(has_note(campaign));
}

}  // namespace
}  // namespace peclet::runner
