// The cost of a realisation, estimated from its beginning.
#include <gtest/gtest.h>

#include <cstdlib>

#include "runner/engines/scene_check.h"
#include "tests/runner/runner_fixture.h"

namespace peclet::runner {
namespace {

// Sets the faults of the fake engine, whose processes inherit the variable.
class FakeFaults {
 public:
  explicit FakeFaults(const char* faults) { setenv("PECLET_FAKE_FAULTS", faults, 1); }
  ~FakeFaults() { unsetenv("PECLET_FAKE_FAULTS"); }
  FakeFaults(const FakeFaults&) = delete;
  FakeFaults& operator=(const FakeFaults&) = delete;
};

CostTrial trial(int seeds = 1) {
  const TemporaryFolder folder;
  return try_cost({{"fluid", {{"viscosity", 1}}}, {"peclet", 1}},
                  {.program = FAKE_ENGINE, .arguments = {"serve"}, .folder = folder.path()}, seeds);
}

TEST(CostTrial, ARealisationThatEndsWithinItTellsItsTime) {
  const std::optional<double> seconds = trial().seconds;
  ASSERT_TRUE(seconds);
  EXPECT_GT(*seconds, 0);
  EXPECT_LT(*seconds, 10);
}

// Only the first seed counts, whatever becomes of those that share its engine.
TEST(CostTrial, RunsAsManySideBySideAsTheEngineCan) {
  const FakeFaults others_fail("overlap:1 refuse:2");
  setenv("PECLET_FAKE_CAPACITY", "4", 1);
  const CostTrial found = trial(3);
  unsetenv("PECLET_FAKE_CAPACITY");
  EXPECT_TRUE(found.seconds);
  EXPECT_EQ(found.broke_off, "");
}

// A realisation that jams ends sooner than one that flows, and would make a campaign look cheap.
TEST(CostTrial, OneThatEndsEarlyTellsNoTimeButWhy) {
  const FakeFaults jams("overlap:0");
  const CostTrial found = trial();
  EXPECT_FALSE(found.seconds);
  EXPECT_TRUE(found.broke_off.starts_with("overlap: ")) << found.broke_off;
}

}  // namespace
}  // namespace peclet::runner
