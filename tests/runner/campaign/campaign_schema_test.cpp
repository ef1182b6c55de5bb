// Tests that the manual and the reference documents agree with the table of keys.
#include <gtest/gtest.h>

#include <fstream>

#include "contract/durable_file.h"
#include "contract/errors.h"
#include "runner/campaign/campaign.h"
#include "tests/runner/runner_fixture.h"

namespace peclet::runner {
namespace {

namespace fs = std::filesystem;

const fs::path source = PECLET_SOURCE_DIR;

TEST(CampaignSchema, TheExampleInTheManualMakesTheGridThatItSays) {
  const std::string page = read_file(source / "schema/README.md");
  const auto begin = page.find("```json\n", page.find("## Campaign")) + 8;
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "campaign.json") << page.substr(begin, page.find("```", begin) - begin);
  const Campaign campaign = read_campaign(folder.path() / "campaign.json");
  EXPECT_EQ(campaign.points.size(), 18U);
  EXPECT_EQ(campaign.points[1].label, "peclet=0.1 volume_fraction=0.5");
}

// schema_agreement.py tests the schema file with the same documents.
TEST(CampaignSchema, TheTableJudgesTheReferenceDocumentsByTheirNames) {
  int documents = 0;
  for (const fs::directory_entry& entry : fs::directory_iterator(source / "tests/reference/campaigns")) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with("valid_")) {
      EXPECT_NO_THROW(read_campaign(entry.path())) << name;
    } else {
      EXPECT_THROW(campaign_keys().validate(read_json(entry.path()), name), InputError) << name;
    }
    ++documents;
  }
  EXPECT_GE(documents, 12);
}

}  // namespace
}  // namespace peclet::runner
