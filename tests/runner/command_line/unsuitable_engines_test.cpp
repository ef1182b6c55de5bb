// Messages about engines that are absent or not engines, and the folder in which engines run.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "tests/runner/command_line/command_line_fixture.h"

namespace peclet::runner {
namespace {

namespace fs = std::filesystem;

TEST_F(CommandLine, AnEngineThatIsNotThereIsNamed) {
  campaign["engine"] = {"./no-such-engine"};
  write();
  const Answer answer = peclet("validate small.json");
  EXPECT_EQ(answer.code, 2);
  EXPECT_NE(answer.text.find("small.json: /engine/0: ./no-such-engine"), std::string::npos) << answer.text;
}

TEST_F(CommandLine, AnEngineThatDoesNotSpeakTheFramesIsAnErrorNotAHang) {
  campaign["engine"] = {"/bin/true"};
  write();
  const Answer answer = peclet("validate small.json");
  EXPECT_EQ(answer.code, 1) << answer.text;
  EXPECT_NE(answer.text.find("/bin/true"), std::string::npos) << answer.text;
}

TEST_F(CommandLine, WhatAnUnsuitableEnginePrintsIsShown) {
  campaign["engine"] = {"/bin/sh", "-c", "for i in 1 2 3 4 5 6 7; do echo line $i >&2; done; exit 3"};
  write();
  const Answer answer = peclet("validate small.json");
  EXPECT_EQ(answer.code, 1);
  EXPECT_TRUE(answer.text.ends_with("It printed:\nline 3\nline 4\nline 5\nline 6\nline 7\n")) << answer.text;
  EXPECT_NE(answer.text.find("exit status 3"), std::string::npos) << answer.text;
  EXPECT_EQ(files(), 1);
}

TEST_F(CommandLine, AnEngineRunsInTheFolderOfTheCampaignFile) {
  const fs::path folder = file().parent_path() / "elsewhere";
  fs::create_directory(folder);
  campaign["engine"] = {"/bin/sh", "-c", "pwd; exit 3"};
  std::ofstream(folder / "small.json") << campaign.dump();
  const Answer answer = peclet("validate elsewhere/small.json");
  EXPECT_TRUE(answer.text.ends_with("It printed:\n" + folder.string() + '\n')) << answer.text;
}

TEST_F(CommandLine, AnEngineMayKnowOfNoTimestep) {
  setenv("PECLET_FAKE_STEPLESS", "1", 1);
  write();
  const Answer valid = peclet("validate small.json"), json = peclet("validate small.json --json");
  unsetenv("PECLET_FAKE_STEPLESS");
  EXPECT_EQ(valid.code, 0) << valid.text;
  EXPECT_TRUE(Json::parse(json.text)["points"][0]["timestep"].is_null()) << json.text;
}

}  // namespace
}  // namespace peclet::runner
