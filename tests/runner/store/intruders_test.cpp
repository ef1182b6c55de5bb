#include <gtest/gtest.h>
#include <sys/stat.h>

#include <vector>

#include "contract/durable_file.h"
#include "runner/store/campaign_directory.h"
#include "tests/runner/runner_fixture.h"

namespace peclet::runner {
namespace {

namespace fs = std::filesystem;

TEST(Intruders, AreMovedAsideAndFilesStay) {
  const TemporaryFolder folder;
  const CampaignDirectory directory(folder.path() / "campaign");
  create_folders(directory);
  const fs::path victim = folder.path() / "victim";
  write_durably(victim, "precious");
  fs::create_symlink(victim, directory.spool() / "a\n.json");
  fs::create_symlink("loop", directory.spool() / "loop");
  ASSERT_EQ(mkfifo((directory.spool() / "pipe.json").c_str(), 0600), 0);
  write_durably(directory.spool() / "file.json", "{}");
  fs::create_directories(directory.checkpoints() / "d.checkpoint" / "full");
  std::vector<std::string> told;
  move_intruders_aside(directory, [&](const std::string& text) { told.push_back(text); });
  ASSERT_EQ(told.size(), 2U);
  EXPECT_EQ(told[0],
            "spool/ had entries that are not regular files: a\\n.json (a link), loop (a link) and 1 more; "
            "moved to aside/1/");
  EXPECT_EQ(
      told[1],
      "checkpoints/ had entries that are not regular files: d.checkpoint (a folder); moved to aside/2/");
  EXPECT_TRUE(fs::exists(directory.spool() / "file.json"));
  EXPECT_TRUE(fs::is_directory(directory.rejected()));
  EXPECT_TRUE(fs::is_symlink(directory.aside() / "1" / "loop"));
  EXPECT_TRUE(fs::is_directory(directory.aside() / "2" / "d.checkpoint" / "full"));
  EXPECT_EQ(read_file(victim), "precious");
  told.clear();
  move_intruders_aside(directory, [&](const std::string& text) { told.push_back(text); });
  EXPECT_TRUE(told.empty());
}

}  // namespace
}  // namespace peclet::runner
