// Files that wait to be taken in: some are read, some set aside and some removed.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "contract/sha256.h"
#include "runner/store/realisation_result.h"
#include "runner/store/result_files.h"
#include "tests/runner/runner_fixture.h"

namespace peclet::runner {
namespace {

class Spool : public testing::Test {
 protected:
  Spool() { create_folders(directory_); }
  std::filesystem::path put(const std::string& name, const std::string& text) const {
    std::ofstream(directory_.spool() / name) << text;
    return directory_.spool() / name;
  }
  TemporaryFolder folder_;
  CampaignDirectory directory_{folder_.path()};
};

TEST_F(Spool, ReadsAFileWhoseHashIsRight) {
  const std::string text = plain_result(sha256("point"), 3, 12.5).dump();
  const std::filesystem::path file = put("a.json", text);
  EXPECT_EQ(read_spool_file(file, sha256(text)).seed, 3);
  EXPECT_EQ(read_spool_file(file, "").seed, 3);
  EXPECT_THROW(read_spool_file(file, sha256("other")), ResultError);
  EXPECT_THROW(read_spool_file(directory_.spool() / "none.json", ""), ResultError);
}

TEST_F(Spool, ListsFinishedFilesOnly) {
  put("b.json", "");
  put("a.json", "");
  put("c.json.123.0.tmp", "");
  EXPECT_EQ(spool_files(directory_), (std::vector<std::filesystem::path>{directory_.spool() / "a.json",
                                                                         directory_.spool() / "b.json"}));
}

TEST_F(Spool, RejectedFilesNeverReplaceEachOther) {
  const std::filesystem::path first = reject(directory_, put("a.json", "1"));
  const std::filesystem::path second = reject(directory_, put("a.json", "2"));
  EXPECT_NE(first, second);
  EXPECT_TRUE(std::filesystem::exists(first));
  EXPECT_TRUE(std::filesystem::exists(second));
  EXPECT_TRUE(spool_files(directory_).empty());
}

TEST_F(Spool, UnfinishedFilesOfTheDeadGoAndThoseOfTheLivingStay) {
  const auto living = put("a.json." + std::to_string(getpid()) + ".0.tmp", "");
  const auto dead = put("a.json.2147483646.0.tmp", "");  // above the kernel's largest process number
  const auto other = put("notes.tmp", "");
  remove_unfinished_files(directory_.spool());
  EXPECT_TRUE(std::filesystem::exists(living));
  EXPECT_FALSE(std::filesystem::exists(dead));
  EXPECT_TRUE(std::filesystem::exists(other));
}

}  // namespace
}  // namespace peclet::runner
