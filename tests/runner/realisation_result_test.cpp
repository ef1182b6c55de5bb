#include "runner/realisation_result.h"

#include <gtest/gtest.h>

#include <fstream>
#include <functional>

#include "contract/sha256.h"
#include "runner/spool.h"
#include "tests/runner/runner_fixture.h"

namespace peclet::runner {
namespace {

const std::string point = sha256("point");

TEST(RealisationResult, TakesAWellFormedOne) {
  const RealisationResult result = parse_result(plain_result(point, 3, 12.5).dump());
  EXPECT_EQ(result.point, point);
  EXPECT_EQ(result.seed, 3);
  EXPECT_TRUE(result.completed());
}

TEST(RealisationResult, RefusesEverythingElse) {
  struct Fault {
    const char* what;
    std::function<void(Json&)> inflict;
  };
  const std::vector<Fault> faults{
      {"no version", [](Json& r) { r.erase("schema_version"); }},
      {"another version", [](Json& r) { r["schema_version"] = 2; }},
      {"no point", [](Json& r) { r.erase("point"); }},
      {"a point that is no hash", [](Json& r) { r["point"] = "peclet=1"; }},
      {"a negative seed", [](Json& r) { r["seed"] = -1; }},
      {"a broken seed", [](Json& r) { r["seed"] = 1.5; }},
      {"an enormous seed", [](Json& r) { r["seed"] = 1LL << 40; }},
      {"an ending that is no word", [](Json& r) { r["ending"]["cause"] = "Out of memory?"; }},
      {"a nameless ending", [](Json& r) { r["ending"]["cause"] = ""; }},
      {"an ending that is no object", [](Json& r) { r["ending"] = "completed"; }},
      {"no mean", [](Json& r) { r["mean"] = nullptr; }},
      {"no blocks", [](Json& r) { r.erase("blocks"); }},
      {"a number after a blow-up", [](Json& r) { r["ending"]["cause"] = "overlap"; }},
      {"no cost", [](Json& r) { r.erase("cost"); }},
      {"a cost in words", [](Json& r) { r["cost"]["cpu_seconds"] = "little"; }},
      {"no final state", [](Json& r) { r["final_state_sha256"] = nullptr; }},
      {"no engine", [](Json& r) { r.erase("engine"); }},
      {"an engine without its binary", [](Json& r) { r["engine"].erase("binary_sha256"); }},
      {"an engine without its instruction set", [](Json& r) { r["engine"].erase("instruction_set"); }},
      {"a list", [](Json& r) { r = Json::array(); }},
  };
  for (const Fault& fault : faults) {
    Json result = plain_result(point, 3, 12.5);
    fault.inflict(result);
    EXPECT_THROW(parse_result(result.dump()), ResultError) << fault.what;
  }
}

TEST(RealisationResult, AnotherEngineHasItsOwnEndingsAndLacksOthersNumbers) {
  Json lost = plain_result(point, 3, 12.5);
  lost["ending"]["cause"] = "lost-atoms";
  lost["mean"] = lost["blocks"] = nullptr;
  EXPECT_FALSE(parse_result(lost.dump()).completed());
  EXPECT_EQ(parse_result(lost.dump()).cause, "lost-atoms");

  Json plain = plain_result(point, 3, 12.5);
  plain["mean"].erase("control_variates");
  for (const char* const key : {"method", "timestep", "statistical_inefficiency", "largest_overlap", "gate"})
    plain[key] = nullptr;
  plain["strain"] = {{"equilibration", nullptr}, {"production", nullptr}};
  EXPECT_TRUE(parse_result(plain.dump()).completed());
  EXPECT_EQ(observe(plain, "relative_viscosity").value, 12.5);
  EXPECT_EQ(observe(plain, "relative_viscosity").control, std::nullopt);
}

TEST(RealisationResult, RefusesTextThatIsNotJsonOrNotFinite) {
  const std::string whole = plain_result(point, 3, 12.5).dump();
  std::string infinite = whole;
  infinite.replace(infinite.find("12.5"), 4, "1e999");
  for (const std::string& text : {std::string(), whole.substr(0, whole.size() / 2), whole + "x", infinite,
                                  std::string("{\"schema_version\": NaN}")}) {
    EXPECT_THROW(parse_result(text), ResultError) << text.substr(0, 60);
  }
}

TEST(RealisationResult, RepetitionsMayDifferInCostMachineAndPlaceOnly) {
  const auto hash = [](const Json& result) { return parse_result(result.dump()).content_sha256; };
  const Json first = plain_result(point, 3, 12.5);
  Json again = first;
  again["cost"] = {{"cpu_seconds", 9.0}, {"wall_seconds", 99.0}};
  again["engine"]["cpu"] = "another";
  EXPECT_EQ(hash(first), hash(again));
  again["mean"]["relative_viscosity"] = 12.500000000000002;
  EXPECT_NE(hash(first), hash(again));
}

TEST(RealisationResult, OnlyRelativeViscositiesHaveAControlVariate) {
  const Json result = plain_result(point, 3, 12.5);
  EXPECT_EQ(observe(result, "relative_viscosity").value, 12.5);
  EXPECT_EQ(observe(result, "relative_viscosity").control, 0.25);
  EXPECT_EQ(observe(result, "pressure").value, 25);
  EXPECT_EQ(observe(result, "pressure").control, std::nullopt);
  EXPECT_EQ(observe(result, "temperature").value, std::nullopt);
}

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
  const std::string text = plain_result(point, 3, 12.5).dump();
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
