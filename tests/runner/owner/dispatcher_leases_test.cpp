// Workers that the dispatcher takes for hung, and others that it must not.
#include <chrono>

#include "tests/runner/owner/dispatcher_fixture.h"

namespace peclet::runner {
namespace {

TEST_F(Dispatching, AWorkerThatTakesNoStepDuringALeaseIsHung) {
  bool first = true;
  pool_.script = [&, this] {
    if (first && pool_.has_job(0)) {
      // Alive and sending messages, but without a new step.
      pool_.say(Progressed{0, pool_.job(0).attempt, 2, 7, 100, 0.1});
      pool_.now += std::chrono::milliseconds(900);
      first = pool_.now.time_since_epoch() < std::chrono::seconds(200);
      if (pool_.has_job(1))
        pool_.say(Progressed{1, pool_.job(1).attempt, 2, pool_.now.time_since_epoch().count(), 100, 0.1});
      return;
    }
    finish_all();
  };
  EXPECT_EQ(run(), Dispatcher::Ending::finished);
  EXPECT_EQ(attempts_of(0).at(0).outcome, "hung");
  EXPECT_TRUE(attempts_of(0).at(0).blamed);
  EXPECT_EQ(attempts_of(0).at(0).step, 7);
  EXPECT_EQ(attempts_of(0).at(1).outcome, "result");
  EXPECT_EQ(attempts_of(1).size(), 1U);  // the worker that took steps was left alone
}

TEST_F(Dispatching, AWorkerThatWasStoppedIsReplacedWithoutBlame) {
  pool_.stopped = 0;
  pool_.script = [&, this] {
    if (pool_.now.time_since_epoch() > std::chrono::seconds(200)) return finish_all();
    pool_.now += std::chrono::milliseconds(900);
    if (!pool_.has_job(1)) return;
    pool_.say(Progressed{1, pool_.job(1).attempt, 2, pool_.now.time_since_epoch().count(), 100, 0.1});
  };
  EXPECT_EQ(run(), Dispatcher::Ending::finished);
  EXPECT_EQ(attempts_of(0).at(0).outcome, "killed");
  EXPECT_EQ(attempts_of(0).at(1).outcome, "result");
  EXPECT_EQ(database_.connection().integer("SELECT total(blamed) FROM attempt"), 0);
}

TEST_F(Dispatching, FilesOnTheirWayRenewTheLeaseOfALaunchedWorker) {
  settings_.hosts = {"a", "a"};
  pool_.script = [&, this] {
    if (pool_.now.time_since_epoch() > std::chrono::seconds(400)) return finish_all();
    pool_.now += std::chrono::milliseconds(900);
    for (const int worker : {0, 1}) {
      if (pool_.has_job(worker)) pool_.say(Carrying{worker, pool_.job(worker).attempt});
    }
  };
  EXPECT_EQ(run(), Dispatcher::Ending::finished);
  EXPECT_EQ(attempts_of(0).size(), 1U);
  EXPECT_EQ(attempts_of(1).size(), 1U);
}

TEST_F(Dispatching, AWorkerOfThisMachineCarriesNoFiles) {
  bool first = true;
  pool_.script = [&, this] {
    if (std::exchange(first, false)) return pool_.say(Carrying{0, pool_.job(0).attempt});
    finish_all();
  };
  EXPECT_EQ(run(), Dispatcher::Ending::finished);
  EXPECT_EQ(attempts_of(0).at(0).outcome, "garbled");
  EXPECT_TRUE(attempts_of(0).at(0).blamed);
}

TEST_F(Dispatching, ALostLinkIsNotBlamedAndNonsenseIs) {
  settings_.hosts = {"a", "b"};
  bool first = true;
  pool_.script = [&, this] {
    if (std::exchange(first, false)) {
      pool_.say(Lost{0, "the launcher ended", "link"});
      return pool_.say(Lost{1, "sent nonsense", "nonsense"});
    }
    pool_.now += std::chrono::milliseconds(900);  // the pause before they are started again
    finish_all();
  };
  EXPECT_EQ(run(), Dispatcher::Ending::finished);
  EXPECT_EQ(attempts_of(0).at(0).outcome, "killed");
  EXPECT_FALSE(attempts_of(0).at(0).blamed);
  EXPECT_EQ(attempts_of(1).at(0).outcome, "garbled");
  EXPECT_TRUE(attempts_of(1).at(0).blamed);
  EXPECT_TRUE(was_warned_of("worker 0 of a ended: the launcher ended"));
}

TEST_F(Dispatching, AFullDiskOfAnotherMachineCostsNoSeed) {
  settings_.hosts = {"a", "b"};
  int losses = 0;
  pool_.script = [&, this] {
    pool_.now += std::chrono::seconds(64);  // the longest pause
    if (losses == 30) return finish_all();
    if (pool_.has_job(0) && ++losses <= 30) pool_.say(Lost{0, "no room", "no-room"});
  };
  EXPECT_EQ(run(), Dispatcher::Ending::finished);
  EXPECT_EQ(database_.connection().integer("SELECT count(*) FROM attempt WHERE outcome = 'drained'"), 30);
  EXPECT_EQ(database_.connection().integer("SELECT count(*) FROM realisation WHERE state != 'done'"), 0);
}

TEST_F(Dispatching, AnEngineThatCrashesIsLaunchedAgainWithoutAPause) {
  settings_.hosts = {"a", "b"};
  int turns = 0;
  pool_.script = [&, this] {
    if (++turns == 1) return pool_.say(Exited{0, {{}, SIGSEGV}});
    EXPECT_TRUE(turns == 2 || pool_.has_job(0)) << turns;
    if (turns > 2) finish_all();
  };
  EXPECT_EQ(run(), Dispatcher::Ending::finished);
  EXPECT_EQ(database_.connection().integer("SELECT total(blamed) FROM attempt"), 1);
}

TEST_F(Dispatching, AnOwnerThatWasStoppedBlamesNobody) {
  int stops = 0;
  pool_.script = [&, this] {
    if (stops < 5 && pool_.has_job(0) && pool_.has_job(1)) {
      ++stops;
      pool_.now += std::chrono::hours(1);  // stopped before it heard anything
      if (stops % 2 == 0) pool_.say(Progressed{0, pool_.job(0).attempt, 2, stops, 100, 0.1});
      return;
    }
    finish_all();
  };
  EXPECT_EQ(run(), Dispatcher::Ending::finished);
  EXPECT_EQ(stops, 5);
  EXPECT_EQ(database_.connection().integer("SELECT total(blamed) FROM attempt"), 0);
  EXPECT_EQ(attempts_of(0).size(), 1U);
  EXPECT_EQ(attempts_of(1).size(), 1U);
}

}  // namespace
}  // namespace peclet::runner
