// Workers with short jobs have a second one, which waits for the end of the first.
#include <csignal>
#include <functional>
#include <set>

#include "contract/sha256.h"
#include "runner/owner/request_handler.h"
#include "runner/store/point_store.h"
#include "runner/store/result_store.h"
#include "tests/runner/owner/dispatcher_fixture.h"

namespace peclet::runner {
namespace {

// Seed 0 of each point has ended before, so that the time of a job is known.
class WorkingAhead : public Dispatching {
 protected:
  WorkingAhead() {
    pool_.takes_ahead = true;
    pool_.wall_seconds = 0.1;
    become(plain_campaign(1, 8, 40, 0.05), {0.1});
  }

  // Adopts a campaign whose points are known to take these times [s].
  void become(const Campaign& campaign, const std::vector<double>& wall_seconds) {
    campaign_ = campaign;
    PointStore(database_).adopt(campaign_);
    for (std::size_t point = 0; point < wall_seconds.size(); ++point) {
      Json result = plain_result(campaign_.points[point].hash, 0, steady(0));
      result["cost"]["wall_seconds"] = wall_seconds[point];
      Transaction booking(database_.connection());
      ResultStore(database_).store(parse_result(result.dump()), campaign_.target);
      booking.commit();
    }
  }
  // Calls `begin` once, as soon as both workers have two jobs; then all workers finish.
  void once_both_wait(const std::function<void()>& begin) {
    pool_.script = [this, begin, begun = false]() mutable {
      if (begun) return finish_all();
      if (!pool_.has_waiting(0) || !pool_.has_waiting(1)) return;
      begun = true;
      begin();
    };
  }
  bool ran_once(int seed) {
    const std::vector<AttemptRecord> attempts = attempts_of(seed);
    return std::count_if(attempts.begin(), attempts.end(),
                         [](const AttemptRecord& record) { return record.outcome == "result"; }) == 1;
  }
  void expect_attempt(int seed, std::size_t number, const char* outcome, bool blamed) {
    const std::vector<AttemptRecord> attempts = attempts_of(seed);
    ASSERT_GT(attempts.size(), number) << seed;
    EXPECT_EQ(attempts[number].outcome, outcome) << seed;
    EXPECT_EQ(attempts[number].blamed, blamed) << seed;
  }
  void expect_all_ran_once() {
    for (int seed = 1; seed < 8; ++seed) EXPECT_TRUE(ran_once(seed)) << seed;
    EXPECT_EQ(count("SELECT count(*) FROM result"),
              1 + count("SELECT count(*) FROM attempt WHERE outcome = 'result'"));
    EXPECT_EQ(count("SELECT count(*) FROM lease"), 0);
  }
  std::int64_t count(const std::string& sql) { return database_.connection().integer(sql); }
};

TEST_F(WorkingAhead, EachWorkerHasTwoJobsThatAreDurableAndRunsThemInTurn) {
  once_both_wait([this] {
    Database reader = Database::open_reader(directory_.database());
    std::multiset<std::pair<int, int>> known, told;
    for (const LeaseRecord& lease : reader.leases(1)) known.emplace(lease.worker, lease.seed);
    for (int worker = 0; worker < 2; ++worker) {
      told.emplace(worker, pool_.job(worker).seed);
      told.emplace(worker, pool_.waiting(worker).seed);
    }
    EXPECT_EQ(known, told);
    EXPECT_EQ(std::set<int>({pool_.job(0).seed, pool_.job(1).seed}), (std::set<int>{1, 2}));
    EXPECT_EQ(std::set<int>({pool_.waiting(0).seed, pool_.waiting(1).seed}), (std::set<int>{3, 4}));
  });
  EXPECT_EQ(run(), Dispatcher::Ending::finished);
  expect_all_ran_once();
  EXPECT_EQ(count("SELECT total(blamed) FROM attempt"), 0);
}

TEST_F(WorkingAhead, OnlyEnginesThatSaySoDo) {
  pool_.takes_ahead = false;  // the pool throws if one is given a second job
  pool_.script = [this] { finish_all(); };
  EXPECT_EQ(run(), Dispatcher::Ending::finished);
  EXPECT_EQ(pool_.assigned.size(), 8U);  // 1 ... 7, and an extra one
}

TEST_F(WorkingAhead, OnlyBehindJobsThatAreKnownToBeShort) {
  struct {
    std::vector<double> seconds;  // wall time of a job, if known
    bool waits;
  } const cases[] = {{{0.99}, true}, {{1.0}, false}, {{3600}, false}, {{}, false}};
  int minimum = 8;
  for (const auto& [seconds, waits] : cases) {
    ++minimum;
    Campaign another = plain_campaign(1, minimum, 40, 0.05);
    another.points[0].scene = {{"case", minimum}};
    another.points[0].hash = sha256(canonical_json(another.points[0].scene));
    become(another, seconds);
    pool_.wall_seconds = 3600;  // wall time in new results
    bool waited = false;
    pool_.script = [&, this] {
      waited |= pool_.has_waiting(0) || pool_.has_waiting(1);
      finish_all();
    };
    EXPECT_EQ(run(), Dispatcher::Ending::finished);
    EXPECT_EQ(waited, waits) << minimum;
  }
}

TEST_F(WorkingAhead, AWorkerAtALongPointHasNone) {
  become(plain_campaign(2, 8, 40, 0.05), {0.1, 3600});
  // The seven seeds of the long point go first, so that the last of them runs beside a brief one.
  PointStore(database_).set_priority(database_.points()[1].id, 1);
  const std::string& brief = campaign_.points[0].hash;
  bool saw_both = false;
  pool_.script = [&, this] {
    for (int worker = 0; worker < 2; ++worker) {
      if (!pool_.has_job(worker)) continue;
      const bool is_brief = pool_.job(worker).point == brief;
      EXPECT_TRUE(is_brief || !pool_.has_waiting(worker));
      saw_both |= !is_brief && pool_.has_waiting(1 - worker);
      pool_.wall_seconds = is_brief ? 0.1 : 3600;
      pool_.finish(worker, steady(pool_.job(worker).seed));
    }
  };
  EXPECT_EQ(run(), Dispatcher::Ending::finished);
  EXPECT_TRUE(saw_both);
}

TEST_F(WorkingAhead, IdleWorkersGoFirst) {
  become(plain_campaign(1, 4, 4, 0.05), {0.1});
  int calls = 0;
  pool_.script = [&, this] {
    if (++calls > 1 || !pool_.has_job(1)) return finish_all();
    EXPECT_EQ(pool_.has_waiting(0) + pool_.has_waiting(1), 1);  // three seeds are left
    finish_all();
  };
  run();
  EXPECT_EQ(pool_.assigned.size(), 3U);
}

TEST_F(WorkingAhead, ADrainGivesBothBackUnblamed) {
  once_both_wait([this] { pool_.say(StopSignal{}); });
  EXPECT_EQ(run(), Dispatcher::Ending::stopped);
  for (int seed = 1; seed <= 4; ++seed) {
    expect_attempt(seed, 0, "drained", false);
    EXPECT_EQ(state_of(seed), SeedState::queued);
  }
  EXPECT_EQ(attempts_of(1).at(0).message, "");
  EXPECT_EQ(attempts_of(3).at(0).message, "waited behind another job");
  pool_.script = [this] { finish_all(); };
  EXPECT_EQ(run(), Dispatcher::Ending::finished);
  expect_all_ran_once();
}

TEST_F(WorkingAhead, AStopAtOnceGivesBothBackUnblamed) {
  pool_.leaves_when_drained = false;
  int signals = 0;
  pool_.script = [&, this] {
    if (pool_.has_waiting(0) && signals < 2) {
      ++signals;
      pool_.say(StopSignal{});
    }
  };
  EXPECT_EQ(run(), Dispatcher::Ending::stopped);
  for (int seed = 1; seed <= 4; ++seed) expect_attempt(seed, 0, "drained", false);
  EXPECT_EQ(count("SELECT count(*) FROM realisation WHERE state = 'running'"), 0);
}

TEST_F(WorkingAhead, ACrashIsNotBlamedOnTheSeedThatWaits) {
  int present = 0, waiting = 0;
  once_both_wait([&, this] {
    present = pool_.job(0).seed;
    waiting = pool_.waiting(0).seed;
    pool_.say(Exited{0, {{}, SIGSEGV}});
  });
  EXPECT_EQ(run(), Dispatcher::Ending::finished);
  expect_attempt(present, 0, "crashed", true);
  expect_attempt(waiting, 0, "drained", false);
  EXPECT_EQ(count("SELECT total(blamed) FROM attempt"), 1);
  expect_all_ran_once();
}

TEST_F(WorkingAhead, ACrashAfterAResultIsBlamedOnTheSeedThatWaited) {
  int present = 0, waiting = 0;
  once_both_wait([&, this] {
    present = pool_.job(0).seed;
    waiting = pool_.waiting(0).seed;
    pool_.finish(0, steady(present));
    pool_.say(Exited{0, {{}, SIGSEGV}});
  });
  EXPECT_EQ(run(), Dispatcher::Ending::finished);
  EXPECT_EQ(attempts_of(present).size(), 1U);
  expect_attempt(waiting, 0, "crashed", true);
  expect_all_ran_once();
}

TEST_F(WorkingAhead, AResultThatIsNoneIsNotBlamedOnTheSeedThatWaits) {
  int present = 0, waiting = 0;
  once_both_wait([&, this] {
    const Job job = pool_.job(0);
    present = job.seed;
    waiting = pool_.waiting(0).seed;
    pool_.spool(job, 99);
    pool_.say(ResultSpooled{0, job.attempt, job.spool, std::string(64, '0')});
    pool_.begin_next(0);
    pool_.say(Progressed{0, pool_.job(0).attempt, 2, 1, 100, 0.1});
  });
  EXPECT_EQ(run(), Dispatcher::Ending::finished);
  expect_attempt(present, 0, "garbled", true);
  expect_attempt(waiting, 0, "drained", false);
  expect_all_ran_once();
}

TEST_F(WorkingAhead, AFailureLetsTheNextJobBegin) {
  int present = 0, waiting = 0;
  once_both_wait([&, this] {
    present = pool_.job(0).seed;
    waiting = pool_.waiting(0).seed;
    pool_.say(JobFailed{0, pool_.job(0).attempt, "as asked"});
    pool_.begin_next(0);
  });
  EXPECT_EQ(run(), Dispatcher::Ending::finished);
  expect_attempt(present, 0, "refused", true);
  EXPECT_EQ(attempts_of(waiting).size(), 1U);
  EXPECT_EQ(pool_.starts, 2);
  expect_all_ran_once();
}

TEST_F(WorkingAhead, OnlyTheJobThatStandsStillIsHung) {
  int present = 0, waiting = 0;
  pool_.script = [&, this] {
    if (present == 0 && pool_.has_waiting(0)) {
      present = pool_.job(0).seed;
      waiting = pool_.waiting(0).seed;
    }
    if (pool_.starts > 2) return finish_all();
    pool_.now += std::chrono::milliseconds(900);
    if (pool_.has_job(1)) {
      pool_.say(Progressed{1, pool_.job(1).attempt, 2, pool_.now.time_since_epoch().count(), 100, 0.1});
    }
  };
  EXPECT_EQ(run(), Dispatcher::Ending::finished);
  expect_attempt(present, 0, "hung", true);
  expect_attempt(waiting, 0, "drained", false);
  expect_all_ran_once();
}

TEST_F(WorkingAhead, ALeaseBeginsWhenTheJobDoes) {
  // There are 100 s of steps at the first job, then 100 s without a step at the second. The lease is 120 s.
  const auto moment = [this] { return pool_.now.time_since_epoch(); };
  bool finished_first = false;
  pool_.script = [&, this] {
    if (moment() > std::chrono::seconds(200)) return finish_all();
    pool_.now += std::chrono::milliseconds(900);
    if (moment() < std::chrono::seconds(100)) {
      for (int worker = 0; worker < 2; ++worker) {
        if (!pool_.has_job(worker)) continue;
        pool_.say(Progressed{worker, pool_.job(worker).attempt, 2, moment().count(), 100, 0.1});
      }
    } else if (!finished_first) {
      finished_first = true;
      finish_all();
    }
  };
  EXPECT_EQ(run(), Dispatcher::Ending::finished);
  EXPECT_EQ(count("SELECT count(*) FROM attempt WHERE outcome = 'hung'"), 0);
}

TEST_F(WorkingAhead, ResultsThatNobodyCouldAnnounceAreTakenBoth) {
  int present = 0, waiting = 0;
  once_both_wait([&, this] {
    present = pool_.job(0).seed;
    waiting = pool_.waiting(0).seed;
    pool_.spool(pool_.job(0), steady(present));
    pool_.spool(pool_.waiting(0), steady(waiting));
    pool_.say(Exited{0, {{}, SIGSEGV}});
  });
  EXPECT_EQ(run(), Dispatcher::Ending::finished);
  expect_attempt(present, 0, "result", false);
  expect_attempt(waiting, 0, "result", false);
  expect_all_ran_once();
}

TEST_F(WorkingAhead, AWorkerWhoseNextSeedNobodyWantsLeaves) {
  become(plain_campaign(2, 8, 40, 0.05), {0.1, 0.1});
  RequestHandler requests(database_, state_.emplace(database_, campaign_, directory_, listener_, 2),
                          directory_, listener_);
  settings_.requests = [&] { return requests.carry_out(); };
  std::int64_t cancelled = 0;
  pool_.script = [&, this, turns = 0]() mutable {
    if (cancelled == 0 && pool_.has_waiting(0)) {
      const bool first = pool_.waiting(0).point == campaign_.points[0].hash;
      cancelled = first ? 1 : 2;
      write_request(directory_, Cancel{{first ? "point=0" : "point=1"}, false});
      return;
    }
    // Workers do not finish meanwhile, so recalled jobs are given back.
    if (++turns > 4) finish_all();
  };
  Dispatcher(database_, *state_, pool_, listener_, settings_, [this] { return pool_.now; }).run();
  ASSERT_NE(cancelled, 0);
  EXPECT_EQ(count("SELECT count(*) FROM attempt WHERE outcome NOT IN ('result', 'drained') OR blamed"), 0);
  EXPECT_GT(count("SELECT count(*) FROM attempt WHERE outcome = 'drained' AND message LIKE 'waited%'"), 0);
  EXPECT_EQ(count("SELECT count(*) FROM attempt WHERE outcome = 'result' AND point_id = " +
                  std::to_string(cancelled)),
            0);
  EXPECT_EQ(count("SELECT count(*) FROM realisation WHERE state = 'done' AND seed < 8 AND point_id = " +
                  std::to_string(3 - cancelled)),
            8);
}

TEST_F(WorkingAhead, ResultsCostWhatTheyTookAndSeedsThatHadNotBegunNothing) {
  // Both jobs of worker 0 end between two turns, with 2 s of processor time each (plain_result()).
  once_both_wait([this] {
    pool_.now += std::chrono::milliseconds(500);
    pool_.say(Progressed{1, pool_.job(1).attempt, 2, 1, 100, 0.1});
    pool_.now += std::chrono::seconds(10);
    pool_.finish(0, steady(pool_.job(0).seed));
    pool_.finish(0, steady(pool_.job(0).seed));
    pool_.say(StopSignal{});
  });
  EXPECT_EQ(run(), Dispatcher::Ending::stopped);
  EXPECT_EQ(count("SELECT count(*) FROM attempt WHERE outcome = 'result'"), 2);
  // Worker 1 gives back a job that it had for 10.5 s; the seed behind it adds nothing.
  EXPECT_NEAR(state_->spent_seconds(), 2 * 2.0 + 10.5, 0.6);
}

}  // namespace
}  // namespace peclet::runner
