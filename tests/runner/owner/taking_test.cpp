// A result that cannot be taken in leaves nothing behind, whatever step fails.
#include <sqlite3.h>

#include <filesystem>
#include <fstream>
#include <string_view>

#include "contract/durable_file.h"
#include "contract/sha256.h"
#include "runner/store/result_files.h"
#include "tests/runner/owner/dispatcher_fixture.h"

namespace peclet::runner {
namespace {

namespace fs = std::filesystem;

// Every change of a row asks strikes(), which returns true for the change that is to fail.
class Failing {
 public:
  explicit Failing(Connection& connection) {
    sqlite3_create_function(connection.handle(), "strikes", 0, SQLITE_UTF8, this, &strikes, nullptr, nullptr);
    int number = 0;
    for (const char* const table : {"point", "engine", "realisation", "dictionary", "result", "file",
                                    "attempt", "lease", "stop_test", "event", "bundle_seed"}) {
      for (const char* const change : {"INSERT", "UPDATE", "DELETE"}) {
        connection.execute("CREATE TEMP TRIGGER failing_" + std::to_string(++number) + " BEFORE " + change +
                           " ON main." + table +
                           " BEGIN SELECT RAISE(ABORT, 'struck as asked') WHERE strikes(); END");
      }
    }
  }
  Failing(const Failing&) = delete;
  Failing& operator=(const Failing&) = delete;

  // Sets the change that fails, counted from 1; with 0 all succeed.
  void strike(int change) {
    change_ = change;
    changes_ = 0;
  }
  int changes() const { return changes_; }

 private:
  static void strikes(sqlite3_context* context, int, sqlite3_value**) {
    auto* const self = static_cast<Failing*>(sqlite3_user_data(context));
    sqlite3_result_int(context, ++self->changes_ == self->change_ ? 1 : 0);
  }
  int change_ = 0, changes_ = 0;
};

// Returns everything that is stored, except for times and rejections.
std::string stored(Connection& connection) {
  std::string text;
  const auto add_row = [](void* into, int columns, char** values, char** names) {
    for (int column = 0; column < columns; ++column) {
      const std::string_view name = names[column];
      if (name == "at" || name.ends_with("_at") || name == "event_id") continue;
      *static_cast<std::string*>(into) +=
          std::string(name) + '=' + (values[column] == nullptr ? "NULL" : values[column]) + ' ';
    }
    *static_cast<std::string*>(into) += '\n';
    return 0;
  };
  for (const char* const rows :
       {"point", "engine", "realisation", "dictionary", "file", "attempt", "lease", "stop_test",
        "bundle_seed", "(SELECT point_id, seed, hex(document) FROM result)",
        "(SELECT kind, point_id, seed, message FROM event WHERE kind != 'rejected' ORDER BY event_id)"}) {
    const std::string query = std::string("SELECT * FROM ") + rows;
    EXPECT_EQ(sqlite3_exec(connection.handle(), query.c_str(), add_row, &text, nullptr), SQLITE_OK) << rows;
  }
  return text;
}

class Taking : public Dispatching {
 protected:
  Taking() { state_.emplace(database_, campaign_, directory_, listener_, 2); }

  Json result(int seed) const {
    Json document = plain_result(campaign_.points[0].hash, seed, steady(seed));
    document["warnings"] = {{{"code", "timestep"}, {"message", "too long"}}};
    document["files"] = {{{"name", "empty"}, {"bytes", 0}, {"sha256", sha256("")}}};
    return document;
  }
  fs::path put(const Json& document) {
    const fs::path file = directory_.spool() / ("result-" + std::to_string(++files_) + ".json");
    write_durably(left_file(file, "empty"), "");
    write_durably(file, document.dump());
    return file;
  }
  // Returns what the state knows and would do next.
  std::string snapshot() {
    const Scheduler& scheduler = state_->scheduler();
    const std::optional<SeedId> next = state_->next();
    std::string text =
        std::to_string(scheduler.begun(0)) + ' ' + std::to_string(scheduler.ended(0)) + ' ' +
        std::to_string(scheduler.wanted(0)) + ' ' + std::to_string(scheduler.stop_tests(0).size()) + ' ' +
        std::to_string(state_->spent_seconds()) + ' ' + std::to_string(next ? next->seed : -1) + ' ' +
        std::to_string(listener_.events.size()) + ' ' + std::to_string(listener_.notes.size());
    return text + '\n' + stored(database_.connection());
  }
  std::ptrdiff_t turned_down() const {
    return std::distance(fs::directory_iterator(directory_.rejected()), {});
  }

  Failing failing_{database_.connection()};
  int files_ = 0;
};

// The first result of a point brings engine and dictionary; the fourth closes the cohort that decides.
TEST_F(Taking, OfASpoolFileFailsWithoutATraceAtEveryChange) {
  for (int seed = 0; seed < 4; ++seed) {
    const fs::path checkpoint = directory_.checkpoint(campaign_.points[0].hash, seed);
    write_durably(checkpoint, "a state");
    const std::string before = snapshot();
    int change = 1;
    for (;; ++change) {
      const std::ptrdiff_t rejected = turned_down();
      const fs::path file = put(result(seed));
      failing_.strike(change);
      state_->ingest_spool();
      const bool was_struck = failing_.changes() > change;  // the changes that follow store the rejection
      failing_.strike(0);
      EXPECT_FALSE(fs::exists(file));
      if (turned_down() == rejected) break;
      EXPECT_TRUE(was_struck);
      EXPECT_EQ(snapshot(), before) << "seed " << seed << ", change " << change;
      EXPECT_TRUE(fs::exists(checkpoint));
    }
    // These are at least a realisation, its text, a flag and the point.
    EXPECT_GT(change, 4);
    EXPECT_NE(snapshot(), before);
  }
  EXPECT_TRUE(state_->scheduler().decided(0));
  EXPECT_EQ(database_.stop_tests(1).back().stop_test.verdict, Verdict::converged);
  EXPECT_EQ(database_.counts(1).done, 4);
  EXPECT_EQ(listener_.count<SeedEnded>(), 4);
  for (const std::string& warning : listener_.warnings) {
    EXPECT_NE(warning.find("is not taken: "), std::string::npos) << warning;
  }
}

TEST_F(Taking, OfAWorkersResultFailsWithoutATraceAtEveryChange) {
  const std::int64_t engine = [this] {
    Transaction booking(database_.connection());
    const std::int64_t row = state_->admit_engine(plain_engine());
    booking.commit();
    return row;
  }();
  for (int seed = 0; seed < 4; ++seed) {
    Transaction giving(database_.connection());
    GivenSeed given_seed = state_->give_out(0, 4711, engine).value();
    giving.commit();
    ASSERT_EQ(given_seed.id.seed, seed);
    const std::string before = snapshot();
    int change = 1;
    for (bool taken = false; !taken; ++change) {
      write_durably(left_file(given_seed.job.spool, "empty"), "");
      write_durably(given_seed.job.spool, result(seed).dump());
      std::string why;
      failing_.strike(change);
      Transaction booking(database_.connection());
      taken = state_->take_result(given_seed, sha256_of_file(given_seed.job.spool), 100, 8, why);
      booking.commit();
      failing_.strike(0);
      state_->after_commit();
      if (taken) break;
      EXPECT_NE(why.find("struck as asked"), std::string::npos) << why;
      EXPECT_EQ(snapshot(), before) << "seed " << seed << ", change " << change;
    }
    EXPECT_GT(change, 6);  // these also change the attempt and its lease
  }
  EXPECT_EQ(database_.counts(1).done, 4);
  EXPECT_DOUBLE_EQ(state_->spent_seconds(), 8);  // 2 s for each result that counted
  EXPECT_EQ(database_.connection().integer("SELECT count(*) FROM attempt WHERE outcome = 'result'"), 4);
}

TEST_F(Taking, WhatFailsForWantOfRoomIsNoFaultOfTheResult) {
  put(result(0));
  const std::string before = snapshot();
  database_.connection().execute("PRAGMA max_page_count = 1");  // the present size
  Json large = result(1);
  large["ending"]["message"] = noise(200'000);
  put(large);
  EXPECT_THROW(state_->ingest_spool(), DatabaseError);
  EXPECT_EQ(turned_down(), 0);
  state_->roll_back();
  database_.connection().execute("PRAGMA max_page_count = 1000000");
  state_->ingest_spool();
  EXPECT_EQ(database_.counts(1).done, 2);
  EXPECT_NE(snapshot(), before);
}

// A checkpoint below a file cannot be removed. Afterwards the folder is there again, with checkpoints of a
// seed whose attempt has ended and of one whose end was not booked.
TEST_F(Taking, WhatACommitHasLeftToDoOutlivesATransactionThatFails) {
  const auto refused = [this] {
    const std::int64_t engine = state_->admit_engine(plain_engine());
    const GivenSeed given_seed = state_->give_out(0, 4711, engine).value();
    state_->end_attempt(given_seed, {AttemptOutcome::refused});
    return given_seed.job.checkpoint;
  };
  Transaction first(database_.connection());
  const GivenSeed other = state_->give_out(1, 4712, state_->admit_engine(plain_engine())).value();
  const fs::path checkpoint = refused();
  first.commit();
  fs::remove_all(directory_.checkpoints());
  write_durably(directory_.checkpoints(), "no folder");
  EXPECT_THROW(state_->after_commit(), std::system_error);
  EXPECT_EQ(listener_.count<AttemptFailed>(), 0);
  {
    const Transaction second(database_.connection());
    state_->end_attempt(other, {AttemptOutcome::refused});
  }
  state_->roll_back();
  fs::remove(directory_.checkpoints());
  fs::create_directory(directory_.checkpoints());
  for (const fs::path& file : {checkpoint, other.job.checkpoint}) write_durably(file, "a state");
  for (int time = 0; time < 2; ++time) state_->after_commit();
  EXPECT_FALSE(fs::exists(checkpoint));
  EXPECT_TRUE(fs::exists(other.job.checkpoint));
  EXPECT_EQ(listener_.count<AttemptFailed>(), 1);
  EXPECT_EQ(state_->scheduler().begun(0), 1);
}

// The check of the shape finds these faults, so nothing that reads warnings can fail.
TEST_F(Dispatching, AResultWithAWarningThatIsNoneDoesNotCount) {
  for (const Json& warnings :
       {Json::array({{{"message", "no code"}}}), Json::array({1}), Json("overlap"), Json::object()}) {
    bool lied = false;
    pool_.script = [&, this] {
      if (!lied && pool_.has_job(0)) {
        lied = true;
        const Job& job = pool_.job(0);
        Json result = plain_result(job.point, job.seed, 99);
        result["warnings"] = warnings;
        write_durably(job.spool, result.dump());
        pool_.say(ResultSpooled{0, job.attempt, job.spool, sha256_of_file(job.spool)});
        return;
      }
      finish_all();
    };
    EXPECT_EQ(run(), Dispatcher::Ending::finished) << warnings;
    EXPECT_EQ(database_.connection().integer("SELECT count(*) FROM realisations WHERE value > 11"), 0);
    EXPECT_EQ(database_.stop_tests(1).back().stop_test.verdict, Verdict::converged);
    database_.connection().execute(
        "DELETE FROM attempt; DELETE FROM stop_test; DELETE FROM numbers; DELETE FROM result; DELETE FROM "
        "dictionary; DELETE FROM "
        "realisation");
  }
}

// The present engine may have saved a state of the same seed.
TEST_F(Taking, AResultOfAnEngineThatIsSetAsideLeavesTheCheckpointAlone) {
  put(plain_result(campaign_.points[0].hash, 0, 10, "old"));
  state_->ingest_spool();
  state_.emplace(database_, campaign_, directory_, listener_, 2);  // another run
  EXPECT_EQ(state_->accept_engine(engine_identity(plain_engine("new"))), 1);
  const fs::path checkpoint = directory_.checkpoint(campaign_.points[0].hash, 0);
  for (int time = 0; time < 2; ++time) {
    write_durably(checkpoint, "of the new engine");
    put(plain_result(campaign_.points[0].hash, time, 10, "old"));  // a known result, then another one
    state_->ingest_spool();
    EXPECT_TRUE(fs::exists(checkpoint));
    EXPECT_EQ(turned_down(), 0);
  }
}

}  // namespace
}  // namespace peclet::runner
