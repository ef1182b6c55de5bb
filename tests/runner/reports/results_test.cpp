// Tests the lines of results for other programs.
#include <gtest/gtest.h>

#include "contract/errors.h"
#include "runner/reports/export.h"
#include "tests/runner/stored_campaign.h"

namespace peclet::runner {
namespace {

std::vector<Json> lines(Database& database, const std::string& point = "", std::optional<int> seed = {}) {
  std::vector<Json> all;
  for_each_result_line(database, point, seed, [&](const std::string& line) {
    EXPECT_EQ(line.find('\n'), std::string::npos);
    all.push_back(Json::parse(line));
  });
  return all;
}

TEST(Results, AreWholeAndInTheOrderOfPointsAndSeeds) {
  StoredCampaign campaign(2, 4, 20);
  for (const int seed : {3, 1, 0, 2}) campaign.complete(0, seed, 10 + 0.01 * seed);
  campaign.complete(1, 7, 42);
  const std::vector<Json> all = lines(campaign.database());
  ASSERT_EQ(all.size(), 5U);
  for (int seed = 0; seed < 4; ++seed) {
    const Json& line = all[static_cast<std::size_t>(seed)];
    EXPECT_EQ(line["label"], "point=0");
    EXPECT_EQ(line["seed"], seed);
    EXPECT_EQ(line["result"], *campaign.database().result(1, seed));
    EXPECT_DOUBLE_EQ(line["result"]["mean"]["relative_viscosity"].get<double>(), 10 + 0.01 * seed);
  }
  EXPECT_EQ(all[4]["seed"], 7);
  EXPECT_EQ(all[4]["settings"], campaign.database().points().at(1).settings);
}

TEST(Results, SayWhichSeedsTheLastStopTestCounts) {
  StoredCampaign campaign(1, 4, 20);
  for (const int seed : {0, 1, 2, 3, 5}) campaign.complete(0, seed, 10 + 0.01 * seed);  // converged with 4
  std::vector<bool> deciding;
  for (const Json& line : lines(campaign.database())) deciding.push_back(line["deciding"].get<bool>());
  EXPECT_EQ(deciding, (std::vector<bool>{true, true, true, true, false}));
}

TEST(Results, OfOnePointOrSeedAreGivenAlone) {
  StoredCampaign campaign(2, 4, 20);
  campaign.complete(0, 0, 10);
  campaign.complete(0, 1, 10);
  campaign.complete(1, 1, 11);
  EXPECT_EQ(lines(campaign.database(), "point=0").size(), 2U);
  EXPECT_EQ(lines(campaign.database(), "", 1).size(), 2U);
  EXPECT_EQ(lines(campaign.database(), "point=1", 1).size(), 1U);
  EXPECT_THROW(lines(campaign.database(), "point=1", 0), InputError);
  EXPECT_THROW(lines(campaign.database(), "point=2"), InputError);
}

}  // namespace
}  // namespace peclet::runner
