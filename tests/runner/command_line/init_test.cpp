#include <gtest/gtest.h>

#include <fstream>

#include "contract/durable_file.h"
#include "contract/errors.h"
#include "runner/campaign/campaign.h"
#include "runner/command_line/validate.h"
#include "tests/runner/runner_fixture.h"

namespace peclet::runner {
namespace {

TEST(Init, WritesACampaignThatIsNamedForItsFile) {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "flow-curve.json";
  init_campaign({file});
  const Campaign campaign = read_campaign(file);
  EXPECT_EQ(campaign.name, "flow-curve");
  EXPECT_EQ(campaign.points.size(), 3U);
}

TEST(Init, LeavesWhatIsThereAlone) {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "mine.json";
  std::ofstream(file) << "mine";
  EXPECT_THROW(init_campaign({file}), InputError);
  EXPECT_EQ(read_file(file), "mine");
}

TEST(Init, RefusesNamesThatACampaignCannotHave) {
  const TemporaryFolder folder;
  EXPECT_THROW(init_campaign({folder.path() / "flow curve.json"}), InputError);
  EXPECT_THROW(init_campaign({folder.path() / "flow-curve"}), InputError);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

}  // namespace
}  // namespace peclet::runner
