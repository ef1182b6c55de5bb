#include <gtest/gtest.h>

#include "contract/errors.h"
#include "runner/reports/export.h"
#include "runner/store/result_files.h"
#include "tests/runner/stored_campaign.h"

namespace peclet::runner {
namespace {

// A campaign of two points. Seed 3 of the second has left two files, of which one was thrown away.
class FilesOfACampaign : public testing::Test {
 protected:
  FilesOfACampaign() {
    campaign_.complete(0, 0, 10);
    campaign_.complete(1, 3, 10);
    Connection& connection = campaign_.database().connection();
    store_file(connection, 2, 3, {"final.xyz", 1234, std::string(64, 'a')}, true);
    store_file(connection, 2, 3, {"log.txt", 5, std::string(64, 'b')}, false);
  }
  std::string list(const FileChoice& options) {
    return list_files(campaign_.database(), campaign_.directory(), options);
  }
  // Returns the path of the kept file, files/HASH-POINT/SEED/NAME.
  std::string path() {
    const std::string hash = campaign_.database().points().at(1).hash;
    return (campaign_.directory().root() / "files" / (hash.substr(0, 16) + "-2") / "000003/final.xyz")
        .string();
  }

  StoredCampaign campaign_{2, 4, 4};
};

TEST_F(FilesOfACampaign, AreListedByPointAndSeed) {
  const std::string table = list({});
  EXPECT_NE(table.find("point=1     3  final.xyz   1234  " + path()), std::string::npos) << table;
  EXPECT_NE(table.find("point=1     3  log.txt        5  thrown away"), std::string::npos) << table;
  FileChoice of_another;
  of_another.point = "point=0";
  EXPECT_EQ(list(of_another), "no realisation has left a file\n");
  of_another.point = "point=7";
  EXPECT_THROW(list(of_another), InputError);
}

TEST_F(FilesOfACampaign, AreToldToPrograms) {
  FileChoice options;
  options.paths = true;
  EXPECT_EQ(list(options), path() + '\n');
  options.json = true;
  const Json all = Json::parse(list(options));
  ASSERT_EQ(all.size(), 2U);
  EXPECT_EQ(all[0], Json({{"point", "point=1"},
                          {"hash", campaign_.database().points().at(1).hash},
                          {"seed", 3},
                          {"name", "final.xyz"},
                          {"bytes", 1234},
                          {"sha256", std::string(64, 'a')},
                          {"path", path()}}));
  EXPECT_TRUE(all[1]["path"].is_null());
}

}  // namespace
}  // namespace peclet::runner
