// Tests the proposals of further seeds for a curve.
#include "runner/reports/next.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "contract/errors.h"
#include "runner/reports/proposed_file.h"
#include "tests/contract/refusal.h"
#include "tests/runner/reports/curve_campaign.h"

namespace peclet::runner {
namespace {

class Next : public ::testing::Test {
 protected:
  Proposal next(NextOptions options) {
    options.campaign = campaign_.directory().root();
    return propose_next(options);
  }
  Json json() {
    NextOptions options;
    options.json = true;
    options.points = 12;
    return Json::parse(next(options).text);
  }
  StoredCampaign campaign_{curve_campaign()};
};

// Between 10³ and 10⁷ the band is widest.
TEST_F(Next, NamesTheValuesThatNarrowTheBandMost) {
  decided(campaign_);
  const Json answer = json();
  const Json& curve = answer["curves"][0];
  EXPECT_EQ(answer["over"], "/peclet");
  EXPECT_EQ(curve["known"], 6);
  ASSERT_GT(curve["width"].get<double>(), 0.05);
  EXPECT_GT(curve["widest_at"].get<double>(), 1000);
  EXPECT_LT(curve["widest_at"].get<double>(), 1e7);
  EXPECT_LE(curve["width_then"].get<double>(), 0.05);
  ASSERT_GE(curve["proposals"].size(), 1U);
  const Json& first = curve["proposals"][0];
  EXPECT_TRUE(first["new"].get<bool>());
  EXPECT_EQ(first["seeds"], Json({0, 8}));
  EXPECT_GT(first["axis"].get<double>(), 1000);
  double width = curve["width"].get<double>();
  for (const Json& proposal : curve["proposals"]) {
    EXPECT_LE(proposal["width_then"].get<double>(), width);
    width = proposal["width_then"].get<double>();
  }
  EXPECT_EQ(json(), answer);
}

// The other pointer of the entry is set as at the nearest value.
TEST_F(Next, WritesACampaignFileWithTheNewValues) {
  decided(campaign_);
  const TemporaryFolder folder;
  NextOptions options;
  options.write = folder.path() / "next.json";
  const Proposal answer = next(options);
  EXPECT_TRUE(says(answer.message, "adds its points to the campaign")) << answer.message;
  const Campaign written = read_campaign(options.write);
  const Campaign before = curve_campaign();
  ASSERT_GT(written.points.size(), before.points.size());
  for (const StatePoint& point : before.points) {
    EXPECT_EQ(std::ranges::count(written.points, point.hash, &StatePoint::hash), 1) << point.label;
  }
  EXPECT_TRUE(std::ranges::is_sorted(written.curves.at(0).axis));
  for (const StatePoint& point : written.points) {
    const double axis = point.settings["/peclet"].get<double>();
    if (axis < 1000) continue;
    EXPECT_EQ(point.settings["/window"], axis <= 1e5 ? 5 : 4) << axis;
  }
  EXPECT_EQ(refusal_by([&] { next(options); }),
            options.write.string() + ": --write: is there already, and is never replaced: name another file");
}

TEST_F(Next, AsksForMoreSeedsByASmallerTolerance) {
  decided(campaign_);
  NextOptions options;
  options.points = 0;
  options.json = true;
  const Json answer = Json::parse(next(options).text);
  EXPECT_FALSE(answer["patch"].contains("sweep"));
  for (const Json& proposal : answer["curves"][0]["proposals"]) EXPECT_FALSE(proposal["new"].get<bool>());
  EXPECT_LT(answer["patch"]["target"]["curve"]["relative_tolerance"].get<double>(), 0.05);
}

TEST_F(Next, SaysWhatIsMissing) {
  complete(campaign_, 0, 10, 8);
  EXPECT_EQ(next({}).text, "the means of 1 point are known, and a curve needs 4\n");
  EXPECT_TRUE(json()["patch"].is_null());
}

// `peclet jamming --propose` adds its points to the same list.
TEST(ProposedFile, HasListsInThePlaceOfRanges) {
  const CampaignSource source{"curve.json", R"({"name": "curve", "scene": {}, // a range
    "sweep": [{"set": "/peclet", "values": {"from": 1, "to": 1000, "points": 4, "spaced": "log"}}],
    "realisations": 8})"};
  EXPECT_EQ(sweep_of(source)[0]["values"], Json::parse("[1, 10, 100, 1000]"));
}

TEST(NextWithoutACurve, IsRefused) {
  StoredCampaign campaign(2, 8, 20);
  NextOptions options;
  options.campaign = campaign.directory().root();
  EXPECT_TRUE(says(refusal_by([&] { propose_next(options); }),
                   "/target: relative_viscosity to 5 %: must have a curve"));
}

}  // namespace
}  // namespace peclet::runner
