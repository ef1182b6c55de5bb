// Runs the program in a temporary folder with the file of a campaign of two points.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "contract/json.h"
#include "tests/runner/command_line/shell.h"
#include "tests/runner/runner_fixture.h"

namespace peclet::runner {

class CommandLine : public testing::Test {
 protected:
  CommandLine() {
    campaign = {{"name", "small"},
                {"scene", {{"volume_fraction", 0.5}}},
                {"sweep", {{{"set", "/peclet"}, {"values", {1, 10}}}}},
                {"target", {{"relative_tolerance", 0.2}}},
                {"realisations", {{"minimum", 8}, {"maximum", 40}}},
                {"engine", {FAKE_ENGINE}}};
  }

  std::filesystem::path file() const { return folder_.path() / "small.json"; }
  void write() const { std::ofstream(file()) << campaign.dump(); }

  Answer peclet(const std::string& arguments) const {
    return shell("cd '" + folder_.path().string() + "' || exit; " PECLET_PROGRAM " " + arguments);
  }

  std::ptrdiff_t files() const {
    return std::distance(std::filesystem::recursive_directory_iterator(folder_.path()),
                         std::filesystem::recursive_directory_iterator());
  }

  Json campaign;

 private:
  TemporaryFolder folder_;
};

}  // namespace peclet::runner
