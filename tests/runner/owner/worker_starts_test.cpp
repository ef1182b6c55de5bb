#include "runner/owner/worker_starts.h"

#include <gtest/gtest.h>

namespace peclet::runner {
namespace {

using std::chrono::seconds;

TEST(WorkerStarts, PauseTwiceAsLongAfterEachEnd) {
  WorkerStarts starts({"a"});
  WorkerStarts::Time now{};
  EXPECT_TRUE(starts.may_start(0, now));
  starts.greet(0);
  for (const int pause : {1, 2, 4, 8, 16, 32, 64, 64}) {
    EXPECT_EQ(starts.end(0, "exit status 255", now).empty(), pause != 1);
    EXPECT_FALSE(starts.may_start(0, now + seconds(pause) - std::chrono::milliseconds(1)));
    now += seconds(pause);
    EXPECT_TRUE(starts.may_start(0, now));
  }
  starts.get_on(0);
  EXPECT_NE(starts.end(0, "exit status 255", now), "");
  EXPECT_TRUE(starts.may_start(0, now + seconds(1)));
  EXPECT_FALSE(starts.is_over());
}

TEST(WorkerStarts, LeaveAHostThatNeverWorked) {
  WorkerStarts starts({"a", "b", "a"});
  const WorkerStarts::Time now{};
  starts.greet(1);
  int warnings = 0;
  for (int times = 0; times < 10; ++times) {
    for (const int worker : {0, 1, 2})
      warnings += starts.end(worker, "no route to host", now).empty() ? 0 : 1;
  }
  EXPECT_EQ(warnings, 4);  // each worker at first, and host a
  const WorkerStarts::Time later = now + std::chrono::hours(1);
  EXPECT_FALSE(starts.may_start(0, later));
  EXPECT_TRUE(starts.may_start(1, later));
  EXPECT_FALSE(starts.may_start(2, later));
  EXPECT_FALSE(starts.is_over());
}

TEST(WorkerStarts, AreOverWhenEveryHostIsLeft) {
  WorkerStarts starts({"a", "b"});
  for (int times = 0; times < 5; ++times) {
    EXPECT_FALSE(starts.is_over());
    starts.end(0, "exit status 127", {});
    starts.end(1, "exit status 127", {});
  }
  EXPECT_TRUE(starts.is_over());
  EXPECT_FALSE(WorkerStarts({}).is_over());
}

}  // namespace
}  // namespace peclet::runner
