// Why points are where they are.
#include "runner/explain.h"

#include <gtest/gtest.h>

#include "contract/input_error.h"
#include "tests/runner/stored_campaign.h"

namespace peclet::runner {
namespace {

bool says(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

TEST(Explain, LossesAreNamedByCauseAndSeedWithTheLastWords) {
  StoredCampaign campaign(1, 6, 20);
  for (int seed = 0; seed < 4; ++seed) campaign.complete(0, seed, 10 + 0.01 * seed);
  campaign.blow_up(0, 4);
  campaign.crash(0, 5);
  const std::string text = explain(campaign.database(), campaign.directory(), "point=0");
  EXPECT_TRUE(says(text, "lost: 1 crashed (seed 5)")) << text;
  EXPECT_TRUE(says(text, "lost: 1 overlap (seed 4)")) << text;
  EXPECT_TRUE(says(text, "attempts: 6 (1 crashed, 5 result)")) << text;
  EXPECT_TRUE(says(text, "seed 5 crashed at step 42: signal 11 (Segmentation fault)")) << text;
  EXPECT_TRUE(says(text, campaign.directory().failures().string())) << text;
}

TEST(Explain, ACappedPointIsToldHowManySeedsItWouldTake) {
  StoredCampaign campaign(1, 4, 4);
  const double values[] = {9, 10, 11, 10};
  for (int seed = 0; seed < 4; ++seed) campaign.complete(0, seed, values[seed]);
  const std::string text = explain(campaign.database(), campaign.directory(), "");
  // Half-width 3.182 * 0.408 = 1.299 of 10 + 0.25; 4 * (0.1267 / 0.05)^2 = 25.7 seeds.
  EXPECT_TRUE(says(text, "all 4 seeds that are allowed give 13 %, not within the tolerance of 5 %")) << text;
  EXPECT_TRUE(says(text, "/realisations/maximum (about 26 seeds)")) << text;
}

TEST(Explain, AnOpenPointSaysWhatItWaitsFor) {
  StoredCampaign campaign(2, 4, 20);
  campaign.complete(1, 0, 10);
  const std::string text = explain(campaign.database(), campaign.directory(), "point=1");
  EXPECT_TRUE(says(text, "1 of the 4 seeds of the next look have ended, 0 run")) << text;
  EXPECT_TRUE(says(text, "no look yet")) << text;
  EXPECT_FALSE(says(text, "point=0")) << text;
}

TEST(Explain, APointIsNamedByItsLabelOrTheBeginningOfItsHash) {
  StoredCampaign campaign(2, 4, 20);
  const std::string hash = campaign.database().points()[1].hash;
  EXPECT_TRUE(explain(campaign.database(), campaign.directory(), hash.substr(0, 4)).starts_with("point=1"));
  for (const char* const name : {"point=2", "zzzz", "p"}) {
    EXPECT_THROW(explain(campaign.database(), campaign.directory(), name), InputError) << name;
  }
  EXPECT_THROW(explain(campaign.database(), campaign.directory(), hash.substr(0, 3)), InputError);
}

}  // namespace
}  // namespace peclet::runner
