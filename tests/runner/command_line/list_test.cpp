// Tests the list of campaigns below a folder, in the states that campaigns may have.
#include "runner/command_line/list.h"

#include <gtest/gtest.h>

#include <csignal>
#include <fstream>

#include "contract/errors.h"
#include "tests/runner/campaign_process.h"

namespace peclet::runner {
namespace {

namespace fs = std::filesystem;

std::string states(const fs::path& folder) {
  std::string text;
  for (const ListedCampaign& campaign : campaigns_below(folder))
    text += campaign.name + ' ' + state_of(campaign) + '\n';
  return text;
}

TEST(List, SaysWhetherCampaignsRunHaveStoppedOrHaveEnded) {
  CampaignOnDisk campaign;
  const fs::path file = campaign.options.campaign;
  campaign.start(campaign.held_from(1));
  campaign.wait_for_results(2);
  const std::string name = file.filename().string();
  EXPECT_EQ(states(file.parent_path()), name + " running\n");
  campaign.signal(SIGTERM);
  EXPECT_EQ(campaign.finish(), 75);
  EXPECT_EQ(states(file.parent_path()), name + " stopped\n");
  campaign.release();
  EXPECT_EQ(campaign.run(), 0) << campaign.log();
  const std::vector<ListedCampaign> all = campaigns_below(file.parent_path());
  ASSERT_EQ(all.size(), 1U);
  const Json line = list_json(all)[0];
  EXPECT_EQ(line["state"], "converged");
  EXPECT_EQ(line["points"], 2);
  EXPECT_EQ(line["decided"], 2);
  EXPECT_EQ(line["seeds"], campaign.count("SELECT count(*) FROM realisation WHERE state = 'done'"));
  EXPECT_EQ(line["process"], nullptr);
  EXPECT_NE(list_table(all).find(name + "      2/2"), std::string::npos) << list_table(all);
}

TEST(List, FindsCampaignsInFoldersBelowAndNamesThoseThatCannotBeRead) {
  const TemporaryFolder folder;
  EXPECT_EQ(states(folder.path()), "");
  EXPECT_EQ(list_table({}), "no campaigns\n");
  fs::create_directories(folder.path() / "b" / "deep.peclet" / "inner.peclet");
  std::ofstream(folder.path() / "b" / "deep.peclet" / "campaign.db") << "no database";
  std::ofstream(folder.path() / "b" / "deep.peclet" / "inner.peclet" / "campaign.db") << "not searched";
  fs::create_directories(folder.path() / "a.peclet" / "logs");  // no campaign has been run here
  fs::create_directory_symlink(folder.path() / "b", folder.path() / "c");
  EXPECT_EQ(states(folder.path()), "b/deep.peclet unreadable\n");
  EXPECT_NE(list_json(campaigns_below(folder.path()))[0]["fault"].get<std::string>(), "");
  const fs::path campaign = folder.path() / "b" / "deep.peclet";
  EXPECT_EQ(states(campaign), campaign.string() + " unreadable\n");
  fs::create_directories(folder.path() / "b" / "\xff\n.peclet" / "backup");
  EXPECT_NO_THROW(list_json(campaigns_below(folder.path())).dump());
  EXPECT_EQ(list_table(campaigns_below(folder.path())).find('\xff'), std::string::npos);
}

TEST(List, RefusesWhatIsNoFolder) {
  EXPECT_THROW(campaigns_below("/nonexistent"), InputError);
  EXPECT_THROW(campaigns_below("/dev/null"), InputError);
}

}  // namespace
}  // namespace peclet::runner
