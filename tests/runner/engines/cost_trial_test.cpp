// What a realisation may cost, from the beginning of one.
#include "runner/engines/cost_trial.h"

#include <gtest/gtest.h>

#include <cstdlib>

#include "tests/runner/runner_fixture.h"

namespace peclet::runner {
namespace {

// Faults of the fake engine, in whose processes they are inherited.
class FakeFaults {
 public:
  explicit FakeFaults(const char* faults) { setenv("PECLET_FAKE_FAULTS", faults, 1); }
  ~FakeFaults() { unsetenv("PECLET_FAKE_FAULTS"); }
  FakeFaults(const FakeFaults&) = delete;
  FakeFaults& operator=(const FakeFaults&) = delete;
};

std::optional<double> seconds_of_a_trial() {
  const TemporaryFolder folder;
  return try_cost({{"fluid", {{"viscosity", 1}}}, {"peclet", 1}},
                  {.program = FAKE_ENGINE, .arguments = {"serve"}, .folder = folder.path()});
}

TEST(CostTrial, ARealisationThatEndsWithinItTellsItsTime) {
  const std::optional<double> seconds = seconds_of_a_trial();
  ASSERT_TRUE(seconds);
  EXPECT_GT(*seconds, 0);
  EXPECT_LT(*seconds, 10);
}

// What jams ends sooner than what flows, and would make a campaign look cheap.
TEST(CostTrial, OneThatEndsEarlyTellsNothing) {
  const FakeFaults jams("overlap:0");
  EXPECT_FALSE(seconds_of_a_trial());
}

}  // namespace
}  // namespace peclet::runner
