#include "runner/command_line/watch.h"

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdio>
#include <fstream>
#include <sstream>

#include "runner/campaign/text_table.h"
#include "runner/reports/status.h"
#include "tests/runner/campaign_process.h"
#include "tests/runner/stored_campaign.h"

namespace peclet::runner {
namespace {

TEST(Watch, WhatFitsIsShownAsItIs) {
  EXPECT_EQ(fitted("one\ntwo\n", 2, 3), "one\ntwo\n");
  EXPECT_EQ(fitted("one\n\ntwo", 3, 80), "one\n\ntwo\n");
  EXPECT_EQ(fitted("", 24, 80), "");
}

TEST(Watch, LongLinesAreCutAtACharacterAndSaySo) {
  EXPECT_EQ(fitted("5.66 ± 0.11\n", 24, 8), "5.66 ± …\n");
  EXPECT_EQ(fitted("± ± ±\n", 24, 5), "± ± ±\n");
  EXPECT_EQ(fitted("abc", 24, 1), "…\n");
}

TEST(Watch, LinesBelowTheScreenAreCounted) {
  EXPECT_EQ(fitted("a\nb\nc\nd\n", 3, 80), "a\nb\nand 2 more lines: `peclet status` has them\n");
  EXPECT_EQ(fitted("a\nb\nc\nd\n", 1, 10), "and 4 mor…\n");
}

// Two points, with a control variate; the verdict of the second is the longest that a decided point has.
CampaignStatus status_with_reservations(StoredCampaign& campaign) {
  const Json flagged = {{{"code", "timestep"}, {"message", "why"}}};
  for (int seed = 0; seed < 4; ++seed) campaign.complete(0, seed, 10 + 0.01 * seed);
  for (int seed = 0; seed < 3; ++seed) campaign.complete(1, seed, 10 + 0.01 * seed, flagged);
  campaign.blow_up(1, 3);
  CampaignStatus status = read_status(campaign.database());
  EXPECT_EQ(verdict_text(status.points.at(1)), "converged-with-losses(1), 3 flagged timestep");
  return status;
}

std::vector<std::string> lines(const std::string& text) {
  std::istringstream all(text);
  std::vector<std::string> found;
  for (std::string line; std::getline(all, line);) found.push_back(line);
  return found;
}

// Returns all words of the text in one line.
std::string words(const std::string& text) {
  std::istringstream all(text);
  std::string joined;
  for (std::string word; all >> word;) joined += word + ' ';
  return joined;
}

TEST(Watch, TheVerdictIsWholeHoweverNarrowTheTerminalIs) {
  StoredCampaign campaign{2, 4, 4};
  const CampaignStatus status = status_with_reservations(campaign);
  for (const std::size_t width : {132U, 100U, 80U, 64U, 50U, 40U, 30U}) {
    const std::string table = status_table(status, width);
    for (const std::string& line : lines(table)) {
      EXPECT_LE(width_of(line), width) << table;
      EXPECT_EQ(line.find("…"), std::string::npos) << table;
    }
    EXPECT_NE(words(table).find(" converged "), std::string::npos) << table;
    EXPECT_NE(words(table).find("2 points: 1 converged, 1 converged-with-losses"), std::string::npos)
        << table;
  }
  // In one line where there is room for it: mean 10.01 + 0.25, half-width t = 4.303 times 0.01 / sqrt(3).
  EXPECT_NE(
      status_table(status, 80).find("10.260 ± 0.025 (0.2 %)  converged-with-losses(1), 3 flagged timestep\n"),
      std::string::npos)
      << status_table(status, 80);
}

TEST(Watch, ColumnsGoByImportanceAndAreNamed) {
  StoredCampaign campaign{1, 4, 4};
  for (int seed = 0; seed < 4; ++seed) campaign.complete(0, seed, 10 + 0.01 * seed);
  const CampaignStatus status = read_status(campaign.database());
  const auto header = [&](std::size_t width) {
    for (const std::string& line : lines(status_table(status, width))) {
      if (line.find("verdict") != std::string::npos) return words(line);
    }
    return std::string();
  };
  EXPECT_EQ(header(unlimited_width), "point seeds all seeds stop test verdict ");
  EXPECT_EQ(header(55), "point seeds stop test verdict ");
  EXPECT_EQ(header(45), "point stop test verdict ");
  EXPECT_EQ(header(25), "point verdict ");
  EXPECT_NE(words(status_table(status, 55)).find("too narrow for: all seeds "), std::string::npos);
  EXPECT_EQ(status_table(status).find("too narrow for"), std::string::npos);
}

TEST(Watch, ACampaignThatHasNotBegunIsWaitedFor) {
  CampaignOnDisk campaign{1};
  std::ofstream(campaign.options.campaign) << campaign.document.dump(2);
  const std::string command =
      std::string(PECLET_PROGRAM) + " watch --interval 0.1 " + campaign.options.campaign.string() + " 2>&1";
  FILE* const watch = popen(command.c_str(), "r");
  ASSERT_NE(watch, nullptr);
  char line[4096] = "";
  ASSERT_NE(fgets(line, sizeof line, watch), nullptr);
  EXPECT_EQ(std::string(line), "test: nothing has been run yet; waiting for `peclet run " +
                                   campaign.options.campaign.string() + "`\n");
  EXPECT_EQ(campaign.run(), 0);
  std::string rest;
  while (fgets(line, sizeof line, watch) != nullptr) rest += line;
  EXPECT_EQ(WEXITSTATUS(pclose(watch)), 0);
  EXPECT_NE(rest.find("1 point: 1 converged"), std::string::npos) << rest;
}

}  // namespace
}  // namespace peclet::runner
