#include <gtest/gtest.h>

#include <chrono>
#include <csignal>

#include "runner/engines/worker_process.h"

namespace peclet::runner {
namespace {

using std::chrono::seconds;

constexpr Awake lease{120};

WorkerWatch busy_since(Awake now) {
  WorkerWatch watch;
  watch.start(now);
  watch.greet();
  watch.begin_job(1, now);
  return watch;
}

Progressed at(int phase, std::int64_t step) { return {0, 1, phase, step, 100, 0.1}; }

TEST(AwakeClock, CountsNoMoreThanASecondOfATurnAndNoMoreThanHalfALease) {
  const AwakeClock::Time start{};
  AwakeClock clock(start, lease), short_lease(start, Awake(0.5));
  for (const auto turn : {std::chrono::milliseconds(250), std::chrono::milliseconds(750)}) {
    clock.end_turn(clock.heard() + turn);
  }
  EXPECT_DOUBLE_EQ(clock.awake().count(), 1);
  clock.end_turn(clock.heard() + std::chrono::hours(1));  // the process was stopped
  EXPECT_DOUBLE_EQ(clock.awake().count(), 2);
  short_lease.end_turn(start + seconds(1));
  EXPECT_DOUBLE_EQ(short_lease.awake().count(), 0.25);
}

TEST(WorkerWatch, AWorkerIsOverdueAMinuteAfterItWasStartedWithoutHello) {
  WorkerWatch watch;
  EXPECT_FALSE(watch.is_overdue(Awake(1000), lease));
  watch.start(Awake(1000));
  EXPECT_FALSE(watch.is_overdue(Awake(1060), lease));
  EXPECT_TRUE(watch.is_overdue(Awake(1061), lease));
  EXPECT_EQ(watch.overdue(lease, true).outcome, AttemptOutcome::hung);
  watch.greet();
  EXPECT_FALSE(watch.is_overdue(Awake(9000), lease));  // an idle one waits for us
}

TEST(WorkerWatch, OnlyANewStepRenewsTheLease) {
  WorkerWatch watch = busy_since(Awake(0));
  watch.hear(at(1, 7), Awake(100));
  watch.hear(at(1, 7), Awake(150));  // alive, and standing still
  EXPECT_FALSE(watch.is_overdue(Awake(220), lease));
  EXPECT_TRUE(watch.is_overdue(Awake(221), lease));
  watch.hear(at(2, 0), Awake(221));  // a new phase begins at step 0
  EXPECT_FALSE(watch.is_overdue(Awake(341), lease));
  watch.renew(Awake(341));  // it waits for room on the disk
  EXPECT_FALSE(watch.is_overdue(Awake(461), lease));
  EXPECT_TRUE(watch.is_overdue(Awake(462), lease));
}

TEST(WorkerWatch, AnOverdueWorkerIsBlamedUnlessItWasStoppedOrToldToLeave) {
  WorkerWatch watch = busy_since(Awake(0));
  watch.hear(at(2, 7), Awake(0));
  EXPECT_EQ(watch.overdue(lease, false).outcome, AttemptOutcome::hung);
  EXPECT_EQ(watch.overdue(lease, false).message, "no new step after 7 for 120 s");
  EXPECT_EQ(watch.overdue(lease, true).outcome, AttemptOutcome::killed);
  watch.recall();
  EXPECT_EQ(watch.overdue(lease, false).outcome, AttemptOutcome::killed);
}

TEST(WorkerWatch, TheFirstReasonForWhichItIsKilledStays) {
  WorkerWatch watch = busy_since(Awake(0));
  watch.condemn({AttemptOutcome::hung, "first"});
  watch.condemn({AttemptOutcome::garbled, "its socket broke when it was killed"});
  EXPECT_FALSE(watch.is_overdue(Awake(9000), lease));
  EXPECT_EQ(watch.ended({{}, SIGKILL}, false).outcome, AttemptOutcome::hung);
  EXPECT_EQ(watch.ended({{}, SIGKILL}, false).message, "first");
}

TEST(WorkerWatch, AnIdleWorkerThatIsBeingKilledGetsNoJob) {
  WorkerWatch watch;
  watch.start(Awake(0));
  watch.greet();
  EXPECT_TRUE(watch.takes_jobs());
  watch.condemn({AttemptOutcome::garbled, "rubbish after its result"});
  EXPECT_FALSE(watch.takes_jobs());
  EXPECT_FALSE(watch.is_starting());
}

TEST(WorkerWatch, AnExitIsADrainOnlyWhereItWasAskedFor) {
  WorkerWatch watch = busy_since(Awake(0));
  EXPECT_EQ(watch.ended({0, {}}, false).outcome, AttemptOutcome::crashed);
  EXPECT_EQ(watch.ended({0, {}}, true).outcome, AttemptOutcome::drained);
  EXPECT_EQ(watch.ended({1, {}}, true).outcome, AttemptOutcome::crashed);
  EXPECT_EQ(watch.ended({{}, SIGTERM}, true).outcome, AttemptOutcome::killed);
  watch.recall();
  EXPECT_EQ(watch.ended({0, {}}, false).outcome, AttemptOutcome::drained);
}

TEST(WorkerWatch, AStartForgetsTheProcessBefore) {
  WorkerWatch watch = busy_since(Awake(0));
  watch.hear(at(2, 7), Awake(0));
  watch.recall();
  watch.condemn({AttemptOutcome::hung, ""});
  watch.start(Awake(5));
  EXPECT_TRUE(watch.is_starting());
  EXPECT_FALSE(watch.is_recalled());
  EXPECT_FALSE(watch.condemned());
  EXPECT_EQ(watch.jobs(), 0);
}

TEST(WorkerWatch, AJobBeginsWithANewLeaseAndNoSteps) {
  WorkerWatch watch = busy_since(Awake(0));
  watch.hear(at(2, 70), Awake(10));
  watch.begin_job(1, Awake(100));  // the one that waited behind it
  EXPECT_EQ(watch.progress(1).step, 0);
  watch.hear(at(0, 1), Awake(200));
  EXPECT_FALSE(watch.is_overdue(Awake(320), lease));
}

}  // namespace
}  // namespace peclet::runner
