// The archive of a campaign for readers of a paper, unpacked by tar and checked by sha256sum.
#include "runner/page/supplement.h"

#include <gtest/gtest.h>

#include <fstream>

#include "contract/durable_file.h"
#include "contract/errors.h"
#include "runner/reports/export.h"
#include "tests/runner/command_line/shell.h"
#include "tests/runner/stored_campaign.h"

namespace peclet::runner {
namespace {

class Supplement : public testing::Test {
 protected:
  void complete() {
    for (int point = 0; point < 2; ++point) {
      for (int seed = 0; seed < 4; ++seed) campaign_.complete(point, seed, 10 + point + 0.01 * seed);
    }
  }
  // Runs a command in the folder of the archive.
  Answer in_folder(const std::string& command) const {
    return shell("cd '" + folder_.path().string() + "' && " + command);
  }
  void write(const std::string& bytes) const {
    std::ofstream(folder_.path() / "all.tar.gz", std::ios::binary) << bytes;
  }

  TemporaryFolder folder_;
  StoredCampaign campaign_{2, 4, 4};
};

TEST_F(Supplement, IsUnpackedByTarAndCheckedBySha256sum) {
  complete();
  write(supplement(campaign_.database(), std::nullopt));
  EXPECT_EQ(in_folder("tar --warning=all -xzf all.tar.gz").text, "");
  const std::string name = campaign_.database().campaign().name;
  const Answer sums = in_folder("cd " + name + " && sha256sum --strict --check SHA256SUMS");
  EXPECT_EQ(sums.code, 0) << sums.text;
  for (const char* const file : {"README.md", "results.csv", "numbers.csv", "results.json", "report.html",
                                 "figure.py", "provenance.json"}) {
    EXPECT_TRUE(says(sums.text, std::string(file) + ": OK")) << file;
  }
  EXPECT_EQ(read_file(folder_.path() / name / "results.csv"), export_csv(campaign_.database(), true));
  EXPECT_EQ(read_file(folder_.path() / name / "results.json"), export_json(campaign_.database(), true));
  EXPECT_EQ(Json::parse(read_file(folder_.path() / name / (name + ".json"))),
            campaign_.database().campaign().document);
  const Answer times = in_folder("stat -c '%Y %a' " + name + "/figure.py");
  EXPECT_TRUE(times.text.ends_with(" 755\n")) << times.text;
  EXPECT_FALSE(times.text.starts_with("0 ")) << times.text;
}

TEST_F(Supplement, OfNothingIsRefusedInWordsAboutTheBundle) {
  campaign_.blow_up(0, 0);
  try {
    supplement(campaign_.database(), std::nullopt);
    FAIL() << "made";
  } catch (const InputError& error) {
    EXPECT_TRUE(says(error.what(), "--bundle: plain: has no number of relative_viscosity yet"))
        << error.what();
  }
}

TEST_F(Supplement, IsTheSameBytesForTheSameState) {
  complete();
  const std::string first = supplement(campaign_.database(), std::nullopt);
  EXPECT_EQ(first, supplement(campaign_.database(), std::nullopt));
  campaign_.complete(1, 7, 12);
  EXPECT_NE(first, supplement(campaign_.database(), std::nullopt));
}

TEST_F(Supplement, IsNotMadeOfNothing) {
  EXPECT_THROW(supplement(campaign_.database(), std::nullopt), InputError);
  EXPECT_THROW(check_supplement_name("all.zip"), InputError);
  EXPECT_NO_THROW(check_supplement_name("all.tgz"));
}

TEST(TarGz, HoldsFilesOfAnyLength) {
  const TemporaryFolder folder;
  std::vector<ArchivedFile> files;
  for (const std::size_t size : {0U, 1U, 511U, 512U, 513U, 100'000U}) {
    files.push_back({std::to_string(size), noise(size, 1)});
  }
  std::ofstream(folder.path() / "a.tar.gz", std::ios::binary) << gzip(tar("a", files, 1'000'000'000));
  EXPECT_EQ(shell("cd '" + folder.path().string() + "' && tar -xzf a.tar.gz").text, "");
  for (const ArchivedFile& file : files) EXPECT_EQ(read_file(folder.path() / "a" / file.name), file.bytes);
  EXPECT_EQ(shell("date -u -r '" + (folder.path() / "a" / "1").string() + "' +%Y-%m-%dT%H:%M:%S").text,
            "2001-09-09T01:46:40\n");
  EXPECT_THROW(tar("a", {{std::string(101, 'x'), ""}}, 0), std::length_error);
}

}  // namespace
}  // namespace peclet::runner
