#include "runner/command_line/init.h"

#include <gtest/gtest.h>

#include <fstream>

#include "contract/durable_file.h"
#include "contract/errors.h"
#include "runner/campaign/campaign.h"
#include "tests/runner/runner_fixture.h"

namespace peclet::runner {
namespace {

TEST(Init, WritesACampaignThatIsNamedForItsFile) {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "flow-curve.json";
  init_campaign({file});
  const Campaign campaign = read_campaign(file);
  EXPECT_EQ(campaign.name, "flow-curve");
  EXPECT_EQ(campaign.points.size(), 3U);
}

TEST(Init, EveryExampleIsACampaignThatSaysWhatItIs) {
  const TemporaryFolder folder;
  const std::string list = init_campaign({{}, "", true});
  int count = 0;
  for (const auto& [key, text] : example_texts()) {
    if (!key.starts_with("examples-")) continue;  // a file of an example
    ++count;
    const std::string name = key.substr(key.find('-') + 1);
    const std::filesystem::path file = folder.path() / ("my-" + name + ".json");
    const std::string message = init_campaign({file, name});
    EXPECT_EQ(read_campaign(file).name, "my-" + name);
    EXPECT_TRUE(text.starts_with("// ")) << name;
    const std::string subject = text.substr(3, text.find('\n') - 3);
    EXPECT_NE(list.find(name), std::string::npos);
    EXPECT_NE(list.find(subject), std::string::npos) << name;
    EXPECT_NE(message.find(subject), std::string::npos) << name;
  }
  EXPECT_GE(count, 18);
}

TEST(Init, WritesTheFilesOfTheEngineBesideTheCampaign) {
  const TemporaryFolder folder;
  init_campaign({folder.path() / "mine.json", "own-engine"});
  EXPECT_TRUE(read_file(folder.path() / "trap.py").starts_with("#!"));
  const auto mode = std::filesystem::status(folder.path() / "trap.py").permissions();
  EXPECT_NE(mode & std::filesystem::perms::owner_exec, std::filesystem::perms::none);
  init_campaign({folder.path() / "lammps.json", "lammps"});
  EXPECT_TRUE(exists(folder.path() / "dumbbells.in") && exists(folder.path() / "dumbbell.mol"));
  init_campaign({folder.path() / "again.json", "own-engine"});  // with the same engine
  std::ofstream(folder.path() / "trap.py") << "mine";
  EXPECT_THROW(init_campaign({folder.path() / "other.json", "own-engine"}), InputError);
  EXPECT_FALSE(exists(folder.path() / "other.json"));
  EXPECT_EQ(read_file(folder.path() / "trap.py"), "mine");
}

TEST(Init, NamesTheExamplesIfThereIsNoneOfTheName) {
  const TemporaryFolder folder;
  try {
    init_campaign({folder.path() / "new.json", "reversals"});
    ADD_FAILURE();
  } catch (const InputError& error) {
    EXPECT_EQ(error.pointer(), "--example");
    EXPECT_NE(error.allowed().find("did you mean reversal?"), std::string::npos) << error.what();
  }
  EXPECT_THROW(init_campaign({}), InputError);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(Init, LeavesWhatIsThereAlone) {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "mine.json";
  std::ofstream(file) << "mine";
  EXPECT_THROW(init_campaign({file}), InputError);
  EXPECT_EQ(read_file(file), "mine");
}

TEST(Init, RefusesNamesThatACampaignCannotHave) {
  const TemporaryFolder folder;
  EXPECT_THROW(init_campaign({folder.path() / "flow curve.json"}), InputError);
  EXPECT_THROW(init_campaign({folder.path() / "flow-curve"}), InputError);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

}  // namespace
}  // namespace peclet::runner
