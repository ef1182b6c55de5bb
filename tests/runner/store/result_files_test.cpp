#include "runner/store/result_files.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include "contract/durable_file.h"
#include "contract/sha256.h"
#include "runner/store/realisation_result.h"
#include "tests/runner/runner_fixture.h"

namespace peclet::runner {
namespace {

namespace fs = std::filesystem;

// echo -n content | sha256sum
constexpr const char* hash_of_content = "ed7002b439e9ac845f22357d822bac1444730fbdb6016d3ec9432297b9ec9f73";

Json listed(const Json& name, const Json& bytes = 7, const Json& hash = hash_of_content) {
  return {{"name", name}, {"bytes", bytes}, {"sha256", hash}};
}

Json with_files(const Json& files) {
  Json result = plain_result(std::string(64, 'a'), 3, 10);
  result["files"] = files;
  return result;
}

TEST(ResultFiles, AreTakenByPlainNamesAlone) {
  const std::string longest(64, 'x');
  for (const std::string name : {"final.xyz", "x", "9", "A-b_c.d.e", longest.c_str()}) {
    const RealisationResult result = parse_result(with_files(Json::array({listed(name)})).dump());
    EXPECT_EQ(left_files(result.document).at(0).name, name);
  }
  const Json bad_names[] = {"",    ".",           "..",          "../x", "/etc/passwd", "a/b",  ".hidden",
                            "-rf", "a..b",        "a b",         "a\nb", "a@b",         "a\\b", "x.tmp",
                            "é",   longest + "x", Json(nullptr), 7,      Json::array()};
  for (const Json& name : bad_names) {
    EXPECT_THROW(parse_result(with_files(Json::array({listed(name)})).dump()), ResultError) << name;
  }
  EXPECT_THROW(parse_result(with_files(Json::array({listed(std::string("a\0b", 3))})).dump()), ResultError);
}

TEST(ResultFiles, AreListedOnceEachWithSizeAndHash) {
  Json sixteen = Json::array();
  for (int i = 0; i < 16; ++i) sixteen.push_back(listed("file-" + std::to_string(i)));
  EXPECT_EQ(left_files(parse_result(with_files(sixteen).dump()).document).size(), 16U);
  EXPECT_TRUE(left_files(parse_result(with_files(Json::array()).dump()).document).empty());
  EXPECT_TRUE(left_files(parse_result(plain_result(std::string(64, 'a'), 3, 10).dump()).document).empty());
  Json seventeen = sixteen;
  seventeen.push_back(listed("one-too-many"));
  const Json a = listed("a");
  const Json bad[] = {seventeen,
                      Json::object(),
                      nullptr,
                      "a",
                      a,
                      Json::array({"a"}),
                      Json::array({a, listed("b"), a}),
                      Json::array({listed("a", -1)}),
                      Json::array({listed("a", 1.5)}),
                      Json::array({listed("a", (std::uint64_t{1} << 32) + 1)}),
                      Json::array({listed("a", "7")}),
                      Json::array({listed("a", 7, std::string(64, 'A'))}),
                      Json::array({listed("a", 7, std::string(63, 'a'))}),
                      Json::array({listed("a", 7, nullptr)}),
                      Json::array({{{"name", "a"}, {"bytes", 7}}}),
                      Json::array({{{"name", "a"}, {"sha256", hash_of_content}}})};
  EXPECT_EQ(left_files(parse_result(with_files(Json::array({a})).dump()).document).size(), 1U);
  for (const Json& files : bad) EXPECT_THROW(parse_result(with_files(files).dump()), ResultError) << files;
}

TEST(ResultFiles, ThatAreWrongAreNamed) {
  try {
    parse_result(with_files(Json::array({listed("good"), listed("../bad")})).dump());
    FAIL();
  } catch (const ResultError& error) {
    EXPECT_NE(std::string(error.what()).find("/files/1/name: must be a name of 1 to 64 letters"),
              std::string::npos)
        << error.what();
  }
}

// A log among the files has times in it, so two runs of a seed would never agree.
TEST(ResultFiles, AreNoPartOfWhatRepetitionsMustShare) {
  const std::string without = parse_result(with_files(Json::array()).dump()).content_sha256;
  EXPECT_EQ(parse_result(with_files(Json::array({listed("log.txt")})).dump()).content_sha256, without);
  EXPECT_EQ(parse_result(plain_result(std::string(64, 'a'), 3, 10).dump()).content_sha256, without);
}

TEST(ResultFiles, AreCheckedWhereTheyAre) {
  const TemporaryFolder folder;
  const CampaignDirectory directory(folder.path());
  create_folders(directory);
  const fs::path spool = directory.spool_file(std::string(64, 'a'), 3, 17);
  const fs::path file = left_file(spool, "final.xyz");
  EXPECT_EQ(file, directory.left() / "aaaaaaaaaaaaaaaa-000003-17@final.xyz");
  const auto complaint = [&] {
    try {
      open_files_in_spool(with_files(Json::array({listed("final.xyz")})), spool);
      return std::string();
    } catch (const ResultError& error) {
      return std::string(error.what());
    }
  };
  EXPECT_EQ(complaint(), "its file final.xyz is missing");
  write_durably(file, "content");
  EXPECT_EQ(complaint(), "");
  write_durably(file, "contend");
  EXPECT_EQ(complaint(), "its file final.xyz does not have its hash");
  write_durably(file, "contents");
  EXPECT_EQ(complaint(), "its file final.xyz has 8 bytes instead of 7");
  // Links are not followed, FIFOs not waited for.
  write_durably(folder.path() / "elsewhere", "content");
  fs::remove(file);
  fs::create_symlink(folder.path() / "elsewhere", file);
  EXPECT_EQ(complaint(), "its file final.xyz is a link");
  fs::remove(file);
  ASSERT_EQ(mkfifo(file.c_str(), 0600), 0);
  EXPECT_EQ(complaint(), "its file final.xyz is a FIFO");
}

TEST(ResultFiles, OfOneJobAreNotThoseOfAnother) {
  const TemporaryFolder folder;
  const CampaignDirectory directory(folder.path());
  create_folders(directory);
  const fs::path first = directory.spool_file(std::string(64, 'a'), 3, 1);
  const fs::path other = directory.spool_file(std::string(64, 'a'), 3, 17);
  write_durably(left_file(first, "x"), "");
  write_durably(left_file(other, "x"), "");
  write_durably(left_file(other, "y"), "");
  EXPECT_EQ(left_files_of(first), std::vector{left_file(first, "x")});
  EXPECT_EQ(left_files_of(other).size(), 2U);
}

}  // namespace
}  // namespace peclet::runner
