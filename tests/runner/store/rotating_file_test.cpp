#include "runner/store/rotating_file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <string>

#include "contract/durable_file.h"
#include "tests/runner/campaign_process.h"

namespace peclet::runner {
namespace {

namespace fs = std::filesystem;

TEST(RotatingFiles, KeepTheLatestLinesInBoundedFiles) {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "log";
  {
    RotatingFile file(path, 20, 2);
    for (int line = 0; line < 10; ++line) file.append("line " + std::to_string(line) + " ...\n");
  }
  EXPECT_EQ(read_file(path), "line 9 ...\n");
  EXPECT_EQ(read_file(path.string() + ".1"), "line 8 ...\n");
  EXPECT_EQ(read_file(path.string() + ".2"), "line 7 ...\n");
  EXPECT_FALSE(fs::exists(path.string() + ".3"));
}

TEST(RotatingFiles, GoOnWithTheFileThatIsThere) {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "log";
  RotatingFile(path, 10, 1).append("12345678");
  RotatingFile(path, 10, 1).append("abc");
  EXPECT_EQ(read_file(path), "abc");
  EXPECT_EQ(read_file(path.string() + ".1"), "12345678");
}

TEST(RotatingFiles, FollowNoLinkAndWaitForNoFifo) {
  const TemporaryFolder folder;
  const fs::path victim = folder.path() / "victim";
  write_durably(victim, "precious");
  for (const char* const name : {"log", "log.1"}) fs::create_symlink(victim, folder.path() / name);
  RotatingFile(folder.path() / "log", 10, 2).append("a line\n");
  RotatingFile rotating(folder.path() / "other", 10, 2);
  rotating.append("12345678");
  fs::create_symlink(victim, folder.path() / "other.1");
  rotating.append("abcdefgh");
  ASSERT_EQ(mkfifo((folder.path() / "pipe").c_str(), 0600), 0);
  RotatingFile(folder.path() / "pipe", 10, 2).append("a line\n");
  EXPECT_EQ(read_file(victim), "precious");
  EXPECT_EQ(read_file(folder.path() / "other"), "abcdefgh");
}

TEST(RotatingFiles, DivideWhatIsLongerThanAFile) {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "log";
  RotatingFile(path, 4, 2).append("abcdefghij");
  EXPECT_EQ(read_file(path.string() + ".2") + read_file(path.string() + ".1") + read_file(path),
            "abcdefghij");
}

TEST(RotatingFiles, OnAFullDiskDropWhatDoesNotFit) {
  RotatingFile file("/dev/full", 1000, 1);
  EXPECT_NO_THROW(file.append("this is dropped\n"));
  EXPECT_NO_THROW(file.append("nor this\n"));
  RotatingFile nowhere("/nonexistent/log", 1000, 1);
  EXPECT_NO_THROW(nowhere.append("nor this\n"));
  EXPECT_FALSE(fs::exists("/nonexistent"));
}

// Each seed prints half a mebibyte: without a bound, the logs would have some fifteen.
TEST(WorkerLogs, StaySmallWhenAnEnginePrintsWithoutEnd) {
  CampaignOnDisk campaign(1);
  ASSERT_EQ(campaign.run({{"PECLET_FAKE_PRINTED", "262144"}, {"PECLET_FAKE_STEPS", "2"}}), 0)
      << campaign.log();
  std::uintmax_t size = 0;
  for (const fs::directory_entry& entry : fs::directory_iterator(campaign.directory().logs())) {
    size += entry.file_size();
  }
  EXPECT_GT(size, std::uintmax_t{1} << 20);
  EXPECT_LE(size, std::uintmax_t{2} * 3 * (std::uintmax_t{1} << 20) +
                      10'000);  // two workers, three files each, the run's own
}

}  // namespace
}  // namespace peclet::runner
