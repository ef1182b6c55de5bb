// The changes that a live page gets when the database of its campaign changes.
#include "runner/page/live_campaign.h"

#include <gtest/gtest.h>

#include <thread>

#include "contract/errors.h"
#include "tests/runner/stored_campaign.h"

namespace peclet::runner {
namespace {

Json parsed(const std::shared_ptr<const std::string>& text) {
  return text ? Json::parse(*text) : Json(nullptr);
}

class LivePage : public testing::Test {
 protected:
  LiveCampaign live() { return {campaign_.directory().root(), ""}; }
  // Waits for changes since the token and returns them; null if there are none within some seconds.
  static Json news(LiveCampaign& live, const std::string& token) {
    for (int attempt = 0; attempt < 1000; ++attempt) {
      live.refresh();
      if (const auto found = live.changes_since(token)) return Json::parse(*found);
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return nullptr;
  }
  static std::string token_of(const Json& state) { return state["live"]["token"].get<std::string>(); }

  StoredCampaign campaign_{3, 4, 8};
};

TEST_F(LivePage, TellsEverythingAtFirstAndThenOnlyWhatHasChanged) {
  campaign_.complete(0, 0, 10);
  LiveCampaign live = this->live();
  const Json first = parsed(live.changes_since(""));
  EXPECT_EQ(first["count"], 3);
  EXPECT_EQ(first["points"].size(), 3U);
  EXPECT_EQ(first["head"]["progress"]["seeds"]["ended"], 1);
  EXPECT_FALSE(first["head"].contains("points"));
  EXPECT_EQ(live.changes_since(token_of(first)), nullptr);

  campaign_.complete(1, 0, 12);
  const Json second = news(live, token_of(first));
  ASSERT_EQ(second["points"].size(), 1U) << second.dump();
  EXPECT_EQ(second["points"]["1"]["seeds"]["ended"], 1);
  EXPECT_EQ(second["head"]["progress"]["seeds"]["ended"], 2);
  // A token of another process gets everything.
  EXPECT_EQ(parsed(live.changes_since("1-2.1"))["points"].size(), 3U);
  EXPECT_EQ(live.exit_code(), ExitCode::unfinished);
}

// A bounded number of texts is kept, for any tokens.
TEST_F(LivePage, TokensThatWereMadeUpAreToldEverythingInOneText) {
  campaign_.complete(0, 0, 10);
  LiveCampaign live = this->live();
  const auto everything = live.changes_since("");
  const std::string token = token_of(parsed(everything));
  const std::string process = token.substr(0, token.rfind('.') + 1);
  for (const char* const made_up : {"-1", "-2147483648", "17", "2147483647", "9999999999999", "x", ""}) {
    EXPECT_EQ(live.changes_since(process + made_up), everything) << made_up;
  }
}

TEST_F(LivePage, WhatHasNotChangedIsNoNews) {
  campaign_.complete(0, 0, 10);
  LiveCampaign live = this->live();
  const std::string token = token_of(parsed(live.changes_since("")));
  // A commit that changes nothing on the page.
  campaign_.database().connection().execute("UPDATE point SET priority = priority");
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  live.refresh();
  EXPECT_EQ(live.changes_since(token), nullptr);
}

TEST_F(LivePage, ShowsTheSameAsAReportButForWhatTakesLong) {
  for (int seed = 0; seed < 4; ++seed) campaign_.complete(0, seed, 10 + 0.01 * seed);
  LiveCampaign live = this->live();
  const Json state = parsed(live.changes_since(""));
  Json report = page_data(campaign_.database(), std::nullopt);
  for (std::size_t place = 0; place < 3; ++place) {
    const Json details = report["points"][place]["details"];
    EXPECT_EQ(parsed(live.details(report["points"][place]["hash"])), details);
    report["points"][place].erase("details");
    EXPECT_EQ(state["points"][std::to_string(place)], report["points"][place]);
  }
  report.erase("points");
  for (const auto& [key, value] : report.items()) {
    if (key != "commands" && key != "provenance") {
      EXPECT_EQ(state["head"][key], value) << key;
    }
  }
  EXPECT_EQ(live.details("none"), nullptr);
}

TEST_F(LivePage, AFaultIsToldBesideWhatWasKnown) {
  for (int seed = 0; seed < 4; ++seed) campaign_.complete(0, seed, 10 + 0.01 * seed);
  LiveCampaign live = this->live();
  const std::string token = token_of(parsed(live.changes_since("")));
  campaign_.database().connection().execute("UPDATE stop_test SET count = count + 1");
  campaign_.database().connection().execute("UPDATE realisation SET cpu_seconds = 7");
  const Json state = news(live, token);
  EXPECT_TRUE(says(state["head"]["fault"], "stop test"));
  EXPECT_EQ(state["count"], 3);
  campaign_.database().connection().execute("UPDATE stop_test SET count = count - 1");
  const Json mended = news(live, token_of(state));
  EXPECT_FALSE(mended["head"].contains("fault")) << mended["head"].dump();
}

TEST_F(LivePage, AllPointsThatAreDecidedAreAStanding) {
  for (int point = 0; point < 3; ++point) {
    for (int seed = 0; seed < 4; ++seed) campaign_.complete(point, seed, 10 + 0.01 * seed);
  }
  EXPECT_EQ(live().exit_code(), ExitCode::done);
}

TEST(LivePageOfNothing, IsRefusedUnlessItIsACampaignThatMayBegin) {
  const TemporaryFolder folder;
  EXPECT_THROW(LiveCampaign(folder.path() / "none.json", ""), InputError);
  EXPECT_THROW(LiveCampaign(folder.path(), ""), InputError);
}

TEST(DatabaseStamp, ChangesWithEveryCommitAndIsFreshForAMoment) {
  StoredCampaign campaign(1, 4, 8);
  DatabaseStamp before = stamp_of(campaign.directory());
  EXPECT_EQ(stamp_of(campaign.directory()), before);
  EXPECT_TRUE(before.is_fresh(std::chrono::system_clock::now()));
  for (int seed = 0; seed < 3; ++seed) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    campaign.complete(0, seed, 10);
    EXPECT_NE(stamp_of(campaign.directory()), before);
    before = stamp_of(campaign.directory());
  }
  EXPECT_FALSE(before.is_fresh(std::chrono::system_clock::now() + std::chrono::seconds(1)));
}

}  // namespace
}  // namespace peclet::runner
