// How runs end: by signals, by the time limit, and when everything is decided.
#include <chrono>

#include "runner/store/point_store.h"
#include "tests/runner/owner/dispatcher_fixture.h"

namespace peclet::runner {
namespace {

TEST_F(Dispatching, TheFirstSignalLetsWorkersCheckpoint) {
  pool_.script = [this] {
    if (pool_.has_job(0)) pool_.say(StopSignal{});
  };
  EXPECT_EQ(run(), Dispatcher::Ending::stopped);
  EXPECT_EQ(attempts_of(0).at(0).outcome, "drained");
  EXPECT_EQ(state_of(0), SeedState::queued);
  EXPECT_EQ(database_.connection().integer("SELECT count(*) FROM realisation WHERE state = 'running'"), 0);
}

TEST_F(Dispatching, TheSecondSignalStopsAtOnceWithoutBlame) {
  pool_.leaves_when_drained = false;
  int signals = 0;
  pool_.script = [&, this] {
    if (pool_.has_job(0) && signals < 2) {
      ++signals;
      pool_.say(StopSignal{});
    }
  };
  EXPECT_EQ(run(), Dispatcher::Ending::stopped);
  EXPECT_LT(pool_.now.time_since_epoch(), std::chrono::seconds(10));
  EXPECT_EQ(database_.connection().integer("SELECT total(blamed) FROM attempt"), 0);
  EXPECT_EQ(state_of(0), SeedState::queued);
}

TEST_F(Dispatching, WorkersThatDoNotDrainAreKilledInTheEnd) {
  pool_.leaves_when_drained = false;
  bool signalled = false;
  pool_.script = [&, this] {
    if (pool_.has_job(0) && !signalled) {
      signalled = true;
      pool_.say(StopSignal{});
    }
  };
  EXPECT_EQ(run(), Dispatcher::Ending::stopped);
  EXPECT_FALSE(pool_.alive(0));
}

TEST_F(Dispatching, ATimeLimitDrains) {
  settings_.time_limit = std::chrono::seconds(20);
  pool_.script = [this] {
    pool_.now += std::chrono::seconds(1);
    for (int worker = 0; worker < 2; ++worker) {
      if (!pool_.has_job(worker)) continue;
      pool_.say(Progressed{worker, pool_.job(worker).attempt, 2, pool_.now.time_since_epoch().count(), 1, 0});
    }
  };
  EXPECT_EQ(run(), Dispatcher::Ending::stopped);
  EXPECT_EQ(attempts_of(0).at(0).outcome, "drained");
  EXPECT_GE(pool_.now.time_since_epoch(), std::chrono::seconds(20));
}

TEST_F(Dispatching, AResultThatComesDuringADrainIsStored) {
  bool signalled = false;
  pool_.script = [&, this] {
    if (signalled || !pool_.has_job(0)) return;
    signalled = true;
    pool_.say(StopSignal{});
    pool_.finish(0, steady(0));
  };
  EXPECT_EQ(run(), Dispatcher::Ending::stopped);
  EXPECT_EQ(state_of(0), SeedState::done);
}

TEST_F(Dispatching, ExtraSeedsAreCheckpointedWhenTheCampaignIsDecided) {
  campaign_ = plain_campaign(1, 2, 40, 0.05);
  PointStore(database_).adopt(campaign_);
  // Seeds finish one at a time; the worker that is free first runs ahead.
  pool_.script = [this] {
    for (int worker = 0; worker < 2; ++worker) {
      if (!pool_.has_job(worker) || pool_.job(worker).seed >= 2) continue;
      pool_.finish(worker, steady(pool_.job(worker).seed));
      return;
    }
  };
  EXPECT_EQ(run(), Dispatcher::Ending::finished);
  EXPECT_EQ(state_of(2), SeedState::queued);
  EXPECT_EQ(attempts_of(2).at(0).outcome, "drained");
}

}  // namespace
}  // namespace peclet::runner
