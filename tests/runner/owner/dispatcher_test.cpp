#include <csignal>
#include <filesystem>

#include "contract/durable_file.h"
#include "contract/errors.h"
#include "runner/engines/engine_process.h"
#include "runner/store/point_store.h"
#include "runner/store/result_files.h"
#include "runner/store/result_store.h"
#include "tests/runner/owner/dispatcher_fixture.h"

namespace peclet::runner {
namespace {

TEST_F(Dispatching, RunsUntilEveryPointIsDecidedAndLeavesNoFiles) {
  pool_.script = [this] { finish_all(); };
  EXPECT_EQ(run(), Dispatcher::Ending::finished);
  EXPECT_EQ(database_.stop_tests(1).back().stop_test.verdict, Verdict::converged);
  EXPECT_TRUE(spool_files(directory_).empty());
}

TEST_F(Dispatching, AnAttemptIsDurableBeforeItsWorkerHearsOfIt) {
  pool_.script = [this] {
    Database reader = Database::open_reader(directory_.database());
    for (int worker = 0; worker < 2; ++worker) {
      if (!pool_.has_job(worker)) continue;
      const std::vector<LeaseRecord> leases = reader.leases(1);
      EXPECT_TRUE(std::any_of(leases.begin(), leases.end(), [&](const LeaseRecord& lease) {
        return lease.seed == pool_.job(worker).seed && lease.worker == worker;
      }));
    }
    finish_all();
  };
  run();
}

TEST_F(Dispatching, ASeedThatCrashesThreeTimesIsGivenUpAndCountsAsLost) {
  pool_.script = [this] {
    for (int worker = 0; worker < 2; ++worker) {
      if (!pool_.has_job(worker)) continue;
      if (pool_.job(worker).seed == 1) {
        pool_.say(Exited{worker, {{}, SIGSEGV}});
      } else {
        pool_.finish(worker, steady(pool_.job(worker).seed));
      }
    }
  };
  EXPECT_EQ(run(), Dispatcher::Ending::finished);
  EXPECT_EQ(attempts_of(1).size(), 3U);
  EXPECT_EQ(state_of(1), SeedState::quarantined);
  EXPECT_EQ(database_.realisations(1).at(1).cause, "crashed");
  EXPECT_EQ(database_.stop_tests(1).back().stop_test.verdict, Verdict::converged_with_losses);
}

TEST_F(Dispatching, AKillFromOutsideCostsNothing) {
  int kills = 0;
  pool_.script = [&, this] {
    if (pool_.has_job(0) && kills < 10) {
      ++kills;
      pool_.say(Exited{0, {{}, SIGKILL}});
      return;
    }
    finish_all();
  };
  EXPECT_EQ(run(), Dispatcher::Ending::finished);
  EXPECT_EQ(database_.stop_tests(1).back().stop_test.verdict, Verdict::converged);
  EXPECT_EQ(database_.connection().integer("SELECT count(*) FROM attempt WHERE outcome = 'killed'"), 10);
  EXPECT_EQ(database_.connection().integer("SELECT total(blamed) FROM attempt"), 0);
}

TEST_F(Dispatching, AResultThatNobodyCouldAnnounceIsTaken) {
  pool_.script = [this] {
    if (pool_.has_job(0) && pool_.job(0).seed == 0) {
      pool_.spool(pool_.job(0), steady(0));
      pool_.say(Exited{0, {{}, SIGSEGV}});
      return;
    }
    finish_all();
  };
  EXPECT_EQ(run(), Dispatcher::Ending::finished);
  EXPECT_EQ(attempts_of(0).size(), 1U);
  EXPECT_EQ(attempts_of(0).at(0).outcome, "result");
}

TEST_F(Dispatching, AResultWhoseHashIsWrongIsKeptAsideAndTheSeedRunAgain) {
  bool lied = false;
  pool_.script = [&, this] {
    if (!lied && pool_.has_job(0)) {
      lied = true;
      pool_.spool(pool_.job(0), 99);
      pool_.say(ResultSpooled{0, pool_.job(0).attempt, pool_.job(0).spool, std::string(64, '0')});
      return;
    }
    finish_all();
  };
  EXPECT_EQ(run(), Dispatcher::Ending::finished);
  EXPECT_EQ(attempts_of(0).at(0).outcome, "garbled");
  EXPECT_EQ(database_.outcomes(1).at(0)->value, 10);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(directory_.rejected()), {}), 1);
  EXPECT_TRUE(was_warned_of("is not taken"));
}

TEST_F(Dispatching, AResultOfAnotherSeedIsNotTaken) {
  bool lied = false;
  pool_.script = [&, this] {
    if (!lied && pool_.has_job(0)) {
      lied = true;
      const Job& job = pool_.job(0);
      write_durably(job.spool, plain_result(job.point, 39, 10).dump());
      pool_.say(ResultSpooled{0, job.attempt, job.spool, ""});
      return;
    }
    finish_all();
  };
  run();
  EXPECT_EQ(attempts_of(0).at(0).outcome, "garbled");
  EXPECT_EQ(database_.connection().integer("SELECT count(*) FROM realisation WHERE seed = 39"), 0);
}

TEST_F(Dispatching, ARepeatedResultFrameIsNoOffence) {
  pool_.script = [this] {
    if (!pool_.has_job(0)) return finish_all();
    const Job job = pool_.job(0);
    pool_.finish(0, steady(job.seed));
    pool_.say(ResultSpooled{0, job.attempt, job.spool, ""});
  };
  EXPECT_EQ(run(), Dispatcher::Ending::finished);
  EXPECT_EQ(pool_.starts, 2);
  EXPECT_TRUE(listener_.warnings.empty());
}

TEST_F(Dispatching, WordsAboutSomebodyElsesJobEndTheWorker) {
  bool spoke = false;
  pool_.script = [&, this] {
    if (!spoke && pool_.has_job(0)) {
      spoke = true;
      pool_.say(Progressed{0, 12345, 0, 1, 2, 0});
      return;
    }
    finish_all();
  };
  EXPECT_EQ(run(), Dispatcher::Ending::finished);
  EXPECT_EQ(attempts_of(0).at(0).outcome, "garbled");
}

TEST_F(Dispatching, AnotherEngineIsRefusedForAPointWithResults) {
  ResultStore(database_).store(parse_result(plain_result(campaign_.points[0].hash, 0, 10, "old").dump()),
                               campaign_.target);
  pool_.identity = "new";
  try {
    run();
    FAIL() << "mixed";
  } catch (const IntegrityError& error) {
    EXPECT_NE(std::string(error.what()).find(engine_identity(plain_engine("old"))), std::string::npos);
    EXPECT_NE(std::string(error.what()).find(engine_identity(plain_engine("new"))), std::string::npos);
  }
}

TEST_F(Dispatching, AnEngineThatChangesDuringTheRunIsRefused) {
  pool_.script = [this] {
    if (!pool_.has_job(0)) return;
    pool_.identity = "new";
    pool_.say(Exited{0, {{}, SIGKILL}});
  };
  EXPECT_THROW(run(), IntegrityError);
}

TEST_F(Dispatching, AnEngineThatDoesNotStartEndsTheRunSoon) {
  pool_.says_hello = false;
  pool_.script = [this] { pool_.say(Exited{0, {127, {}}}); };
  EXPECT_THROW(run(), EngineError);
  EXPECT_LE(pool_.starts, 6);
  EXPECT_TRUE(database_.attempts(1).empty());
}

TEST_F(Dispatching, AnEngineThatNeverSaysHelloEndsTheRun) {
  pool_.says_hello = false;
  EXPECT_THROW(run(), EngineError);
}

TEST_F(Dispatching, AMissingObservableIsSaidAfterTheResultIsSafe) {
  campaign_.target.observable = "colour";
  PointStore(database_).adopt(campaign_);
  pool_.script = [this] { finish_all(); };
  try {
    run();
    FAIL() << "went on";
  } catch (const InputError& error) {
    EXPECT_EQ(error.pointer(), "/target/observable");
    EXPECT_NE(error.allowed().find("pressure, relative_viscosity"), std::string::npos);
  }
  EXPECT_EQ(state_of(0), SeedState::failed);
}

TEST_F(Dispatching, LeftoversOfTheSpoolAreTakenBeforeAnythingIsGivenOut) {
  for (int seed = 0; seed < 3; ++seed) {
    write_durably(directory_.spool_file(campaign_.points[0].hash, seed, 77),
                  plain_result(campaign_.points[0].hash, seed, steady(seed)).dump());
  }
  write_durably(directory_.spool() / "damaged.json", "{\"schema_version\":");
  pool_.script = [this] { finish_all(); };
  EXPECT_EQ(run(), Dispatcher::Ending::finished);
  EXPECT_EQ(pool_.assigned.at(0).seed, 3);
  EXPECT_TRUE(was_warned_of("damaged.json is not taken"));
  EXPECT_TRUE(std::filesystem::exists(directory_.rejected() / "damaged.json"));
}

TEST_F(Dispatching, ASpoolFileThatIsNamedForAnotherSeedIsSetAside) {
  const std::string& point = campaign_.points[0].hash;
  write_durably(directory_.spool_file(point, 1, 77), plain_result(point, 2, 99).dump());
  write_durably(directory_.spool_file(std::string(64, 'a'), 1, 77), plain_result(point, 1, 99).dump());
  write_durably(directory_.spool() / "brought-by-hand.json", plain_result(point, 0, 10).dump());
  pool_.script = [this] { finish_all(); };
  EXPECT_EQ(run(), Dispatcher::Ending::finished);
  EXPECT_EQ(pool_.assigned.at(0).seed, 1);
  EXPECT_EQ(database_.connection().integer("SELECT count(*) FROM realisations WHERE value = 99"), 0);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(directory_.rejected()), {}), 2);
}

TEST_F(Dispatching, ASpoolFileThatIsTooLargeToBeAResultIsSetAsideUnread) {
  const std::filesystem::path large = directory_.spool() / "large.json";
  write_durably(large, "{");
  std::filesystem::resize_file(large, std::uintmax_t{1} << 40);  // a hole: it takes no room on the disk
  pool_.script = [this] { finish_all(); };
  EXPECT_EQ(run(), Dispatcher::Ending::finished);
  EXPECT_TRUE(was_warned_of("large.json is not taken: "));
  EXPECT_TRUE(std::filesystem::exists(directory_.rejected() / "large.json"));
}

TEST_F(Dispatching, ACheckpointThatCameAfterTheResultGoesAtTheNextStart) {
  pool_.script = [this] { finish_all(); };
  run();
  const std::filesystem::path stale = directory_.checkpoint(campaign_.points[0].hash, 1);
  write_durably(stale, "of a worker that outlived its owner");
  write_durably(growing_beside(stale), "and what grew beside it");
  // Files of open seeds and of another point, and files that are not checkpoints, stay.
  std::string hash = campaign_.points[0].hash;
  const std::string open = directory_.checkpoint(hash, 30).filename().string();
  const std::string copied = stale.filename().string() + ".rejected";
  hash[0] = hash[0] == '0' ? '1' : '0';
  const std::string of_another = directory_.checkpoint(hash, 1).filename().string();
  const std::string growing = open + "@growing";
  for (const std::string& name :
       {open, growing, copied, of_another, std::string("-"), std::string("notes")}) {
    write_durably(directory_.checkpoints() / name, "of somebody");
  }
  run();
  EXPECT_FALSE(std::filesystem::exists(stale));
  EXPECT_FALSE(std::filesystem::exists(growing_beside(stale)));
  for (const std::string& name :
       {open, growing, copied, of_another, std::string("-"), std::string("notes")}) {
    EXPECT_TRUE(std::filesystem::exists(directory_.checkpoints() / name)) << name;
  }
}

}  // namespace
}  // namespace peclet::runner
