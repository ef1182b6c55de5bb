// Workers whose engines run several jobs at once.
#include <algorithm>
#include <csignal>
#include <set>

#include "contract/durable_file.h"
#include "tests/runner/owner/dispatcher_fixture.h"

namespace peclet::runner {
namespace {

class ManyAtOnce : public Dispatching {
 protected:
  ManyAtOnce() {
    pool_.capacity = 8;
    become(32);
  }

  void become(int seeds) {
    campaign_ = plain_campaign(1, seeds, seeds, 0.05);
    PointStore(database_).adopt(campaign_);
  }
  // All jobs of all workers end with a result.
  void finish_them() {
    for (int worker = 0; worker < pool_.size(); ++worker) {
      while (pool_.has_job(worker)) pool_.finish(worker, steady(pool_.job(worker).seed));
    }
  }
  bool has(int worker, const std::set<int>& seeds) const {
    return std::ranges::any_of(pool_.jobs(worker), [&](const Job& job) { return seeds.contains(job.seed); });
  }
  // An engine dies as soon as it has one of these seeds. Returns the number of deaths with several jobs.
  int run_with_poison(const std::set<int>& poison, const ExitStatus& ending) {
    int deaths = 0;
    pool_.script = [&, this] {
      for (int worker = 0; worker < pool_.size(); ++worker) {
        if (!has(worker, poison)) continue;
        deaths += pool_.jobs(worker).size() > 1 ? 1 : 0;
        return pool_.say(Exited{worker, ending});
      }
      finish_them();
    };
    EXPECT_EQ(run(), Dispatcher::Ending::finished);
    return deaths;
  }
  void expect_only_these_given_up(const std::set<int>& seeds, const std::string& cause) {
    for (const RealisationRecord& record : database_.realisations(1)) {
      const bool is_given_up = record.state == SeedState::quarantined;
      EXPECT_EQ(is_given_up, seeds.contains(record.seed)) << record.seed;
      EXPECT_EQ(record.cause, is_given_up ? cause : "completed") << record.seed;
    }
    for (const AttemptRecord& attempt : database_.attempts(1)) {
      EXPECT_FALSE(attempt.blamed && !seeds.contains(attempt.seed)) << attempt.seed;
    }
  }
  std::int64_t count(const std::string& sql) { return database_.connection().integer(sql); }
};

TEST_F(ManyAtOnce, WorkersShareTheSeedsEvenly) {
  become(12);
  bool looked = false;
  pool_.script = [&, this] {
    if (!looked && pool_.has_job(0) && pool_.has_job(1)) {
      looked = true;
      EXPECT_EQ(pool_.jobs(0).size(), 6U);
      EXPECT_EQ(pool_.jobs(1).size(), 6U);
      std::set<fs::path> files;
      for (const Job& job : pool_.assigned) files.insert({job.checkpoint, job.spool});
      EXPECT_EQ(files.size(), 24U);
      EXPECT_EQ(Database::open_reader(directory_.database()).leases(1).size(), 12U);
    }
    finish_them();
  };
  EXPECT_EQ(run(), Dispatcher::Ending::finished);
  EXPECT_TRUE(looked);
  EXPECT_EQ(count("SELECT count(*) FROM attempt"), 12);
}

TEST_F(ManyAtOnce, APlaceIsFilledAgainAtOnceWhicheverJobHasEnded) {
  std::vector<int> ended;
  pool_.script = [&, this] {
    for (int worker = 0; worker < pool_.size(); ++worker) {
      if (!pool_.has_job(worker)) continue;
      EXPECT_TRUE(pool_.assigned.size() == 32 || pool_.jobs(worker).size() == 8);
      const std::size_t last = pool_.jobs(worker).size() - 1;
      ended.push_back(pool_.jobs(worker)[last].seed);
      pool_.finish(worker, steady(ended.back()), last);
    }
  };
  EXPECT_EQ(run(), Dispatcher::Ending::finished);
  EXPECT_FALSE(std::ranges::is_sorted(ended));
  EXPECT_EQ(count("SELECT count(*) FROM result"), 32);
}

TEST_F(ManyAtOnce, AJobAheadWaitsBehindAllPlaces) {
  pool_.takes_ahead = true;
  pool_.wall_seconds = 0.1;
  bool waited = false;
  pool_.script = [&, this] {
    for (int worker = 0; worker < pool_.size(); ++worker) {
      waited |= pool_.has_waiting(worker);
      if (pool_.has_job(worker)) pool_.finish(worker, steady(pool_.job(worker).seed));
    }
  };
  EXPECT_EQ(run(), Dispatcher::Ending::finished);
  EXPECT_TRUE(waited);
  EXPECT_EQ(count("SELECT count(*) FROM attempt WHERE outcome = 'result'"), 32);
}

TEST_F(ManyAtOnce, ADrainGivesAllBackUnblamed) {
  pool_.script = [this] {
    if (pool_.has_job(0)) pool_.say(StopSignal{});
  };
  EXPECT_EQ(run(), Dispatcher::Ending::stopped);
  EXPECT_EQ(count("SELECT count(*) FROM attempt WHERE outcome = 'drained' AND step = 5 AND NOT blamed"), 16);
  EXPECT_EQ(count("SELECT count(*) FROM realisation WHERE state = 'queued'"), 32);
  EXPECT_EQ(count("SELECT count(*) FROM lease"), 0);
}

TEST_F(ManyAtOnce, ResultsThatWereLeftAreTakenAndTheOthersAreTriedAgain) {
  bool died = false;
  pool_.script = [&, this] {
    if (died || !pool_.has_job(0)) return finish_them();
    died = true;
    for (std::size_t number = 0; number < 3; ++number)
      pool_.spool(pool_.jobs(0)[number], steady(pool_.jobs(0)[number].seed));
    pool_.say(Exited{0, {{}, SIGSEGV}});
  };
  EXPECT_EQ(run(), Dispatcher::Ending::finished);
  EXPECT_EQ(count("SELECT count(*) FROM attempt WHERE outcome = 'crashed' AND NOT blamed"), 5);
  EXPECT_EQ(count("SELECT count(*) FROM attempt"), 32 + 5);
  EXPECT_TRUE(was_warned_of("worker 0: crashed with 5 realisations: signal 11"));
}

TEST_F(ManyAtOnce, APoisonousSeedIsFoundByHalvingAndOnlyItIsGivenUp) {
  EXPECT_EQ(run_with_poison({5}, {{}, SIGSEGV}), 3);  // with 8, 4 and 2 jobs
  expect_only_these_given_up({5}, "crashed");
  EXPECT_EQ(count("SELECT total(blamed) FROM attempt WHERE seed = 5"), 3);
  EXPECT_EQ(count("SELECT count(*) FROM result"), 31);
}

TEST_F(ManyAtOnce, SeveralPoisonousSeedsAreFound) {
  EXPECT_LE(run_with_poison({0, 3, 17, 31}, {3, {}}), 4 * 3);
  expect_only_these_given_up({0, 3, 17, 31}, "crashed");
}

// As one that does not fit into memory, for which the kernel kills the engine.
TEST_F(ManyAtOnce, ASeedWithWhichTheEngineIsKilledAgainAndAgainIsFound) {
  run_with_poison({5}, {{}, SIGKILL});
  expect_only_these_given_up({5}, "killed repeatedly");
  EXPECT_EQ(count("SELECT total(blamed) FROM attempt"), 0);
}

TEST_F(ManyAtOnce, AKillFromOutsideCostsNoPlaces) {
  bool killed = false;
  std::size_t most = 0;
  pool_.script = [&, this] {
    if (killed) most = std::max(most, pool_.jobs(0).size());
    if (killed || !pool_.has_job(0)) return finish_them();
    killed = true;
    pool_.say(Exited{0, {{}, SIGKILL}});
  };
  EXPECT_EQ(run(), Dispatcher::Ending::finished);
  EXPECT_EQ(most, 8U);
}

TEST_F(ManyAtOnce, SuspicionOutlivesTheOwner) {
  int turns = 0;
  pool_.script = [&, this] {
    if (!pool_.has_job(0)) return;
    if (++turns == 1) return pool_.say(Exited{0, {{}, SIGSEGV}});
    pool_.say(StopSignal{});
  };
  EXPECT_EQ(run(), Dispatcher::Ending::stopped);
  std::set<int> suspects;
  for (const AttemptRecord& attempt : database_.attempts(1)) {
    if (attempt.outcome == "crashed") suspects.insert(attempt.seed);
  }
  ASSERT_EQ(suspects.size(), 8U);
  std::size_t most = 0;
  pool_.script = [&, this] {
    for (int worker = 0; worker < pool_.size(); ++worker) {
      if (has(worker, suspects)) most = std::max(most, pool_.jobs(worker).size());
    }
    finish_them();
  };
  EXPECT_EQ(run(), Dispatcher::Ending::finished);
  EXPECT_EQ(most, 4U);
}

TEST_F(ManyAtOnce, AJobWithoutAStepDuringALeaseEndsItsEngineWithoutBlame) {
  pool_.script = [&, this] {
    if (pool_.now.time_since_epoch() > std::chrono::seconds(200)) return finish_them();
    pool_.now += std::chrono::milliseconds(900);
    for (int worker = 0; worker < pool_.size(); ++worker) {
      for (const Job& job : pool_.jobs(worker)) {
        const std::int64_t step = job.seed == 4 ? 7 : pool_.now.time_since_epoch().count();
        pool_.say(Progressed{worker, job.attempt, 2, step, 100, 0.1});
      }
    }
  };
  EXPECT_EQ(run(), Dispatcher::Ending::finished);
  EXPECT_EQ(attempts_of(4).at(0).outcome, "hung");
  EXPECT_EQ(attempts_of(4).at(0).step, 7);
  EXPECT_EQ(count("SELECT count(*) FROM attempt WHERE outcome = 'hung'"), 8);
  EXPECT_EQ(count("SELECT total(blamed) FROM attempt"), 0);
  EXPECT_EQ(count("SELECT count(*) FROM result"), 32);
}

TEST_F(ManyAtOnce, AWrongResultIsBlamedOnItsSeedAlone) {
  pool_.script = [this] {
    for (int worker = 0; worker < pool_.size(); ++worker) {
      for (const Job& job : pool_.jobs(worker)) {
        if (job.seed != 5) continue;
        pool_.spool(job, 99);
        return pool_.say(ResultSpooled{worker, job.attempt, job.spool, std::string(64, '0')});
      }
    }
    finish_them();
  };
  EXPECT_EQ(run(), Dispatcher::Ending::finished);
  expect_only_these_given_up({5}, "garbled");
  EXPECT_EQ(attempts_of(5).size(), 3U);
  EXPECT_EQ(count("SELECT count(*) FROM attempt WHERE outcome = 'killed'"), 7) << "later it was alone";
}

TEST_F(ManyAtOnce, OneThatFailsLeavesTheOthersAlone) {
  pool_.script = [this] {
    for (int worker = 0; worker < pool_.size(); ++worker) {
      for (std::size_t number = 0; number < pool_.jobs(worker).size(); ++number) {
        const Job job = pool_.jobs(worker)[number];
        if (job.seed != 5) continue;
        pool_.begin_next(worker, number);
        return pool_.say(JobFailed{worker, job.attempt, "no such file"});
      }
    }
    finish_them();
  };
  EXPECT_EQ(run(), Dispatcher::Ending::finished);
  expect_only_these_given_up({5}, "refused");
  EXPECT_EQ(pool_.starts, 2);
}

TEST_F(ManyAtOnce, AReportCountsWorkersAndRealisations) {
  int most = 0;
  pool_.script = [&, this] {
    pool_.now += std::chrono::seconds(2);
    most = std::max(most, listener_.last.running);
    if (most < 16 && pool_.now.time_since_epoch() < std::chrono::seconds(60)) return;
    finish_them();
  };
  run();
  EXPECT_EQ(most, 16);
  EXPECT_LE(listener_.last.busy, 2);
}

}  // namespace
}  // namespace peclet::runner
