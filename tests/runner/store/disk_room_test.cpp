// A database without room, made by SQLite's own limit of pages; full file systems are in
// tests/end_to_end/full_disk.py.
#include "runner/store/disk_room.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cerrno>

#include "contract/durable_file.h"
#include "runner/owner/dispatcher.h"
#include "runner/owner/request_handler.h"
#include "runner/store/point_store.h"
#include "runner/store/result_files.h"
#include "tests/runner/owner/scripted_pool.h"
#include "tests/runner/runner_fixture.h"

namespace peclet::runner {
namespace {

TEST(Room, IsWhatEnospcAndEdquotSayThereIsNot) {
  EXPECT_TRUE(means_no_room(NoRoomError(ENOSPC, "", "", 0)));
  EXPECT_TRUE(means_no_room(std::system_error(EDQUOT, std::generic_category())));
  EXPECT_FALSE(means_no_room(std::system_error(EIO, std::generic_category())));
  EXPECT_FALSE(means_no_room(std::runtime_error("full")));
  EXPECT_THROW(
      {
        try {
          write_durably("/dev/full/x", "x");
        } catch (const NoRoomError&) {
        }
      },
      std::system_error);
}

TEST(Room, IsThereInAnOrdinaryFolderAndLeavesNoTrace) {
  const TemporaryFolder folder;
  EXPECT_TRUE(has_room(folder.path(), 1000));
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(Room, ThatIsLackingIsNamed) {
  const TemporaryFolder folder;
  const std::string place = folder.path().string();
  EXPECT_TRUE(says(shortage_text(place, 3 << 20, ENOSPC), place + " is full: "));
  EXPECT_TRUE(says(shortage_text(place, 3 << 20, ENOSPC), "MB are free there, 3.1 MB are needed"));
  EXPECT_EQ(shortage_text(place, 3 << 20, EDQUOT),
            place + " is full: your disk quota is used up there (`quota -s`), 3.1 MB are needed");
}

// The name of the trial can be guessed.
TEST(Room, IsTriedWithoutFollowingALink) {
  const TemporaryFolder folder;
  const std::filesystem::path victim = folder.path() / "victim";
  write_durably(victim, "precious");
  std::filesystem::create_symlink(victim, folder.path() / (".room." + std::to_string(getpid()) + ".0.tmp"));
  EXPECT_TRUE(has_room(folder.path(), 1000));
  EXPECT_EQ(read_file(victim), "precious");
}

class FullDatabase : public testing::Test {
 protected:
  FullDatabase() {
    create_folders(directory_);
    PointStore(database_).adopt(campaign_);
    state_.emplace(database_, campaign_, directory_, listener_, 2);
    pool_.result_size = 40'000;  // more than the free room in a page of the table of results
  }

  Dispatcher::Ending run(const DispatchSettings& settings = {}) {
    Dispatcher dispatcher(database_, *state_, pool_, listener_, settings, [this] { return pool_.now; });
    return dispatcher.run();
  }
  // Stops the database from growing.
  void fill() {
    Connection& connection = database_.connection();
    connection.execute("PRAGMA max_page_count = " + std::to_string(connection.integer("PRAGMA page_count")));
    // The room inside is used up, too, also for the shortest event.
    for (const char* const message : {"hex(zeroblob(500))", "''"}) {
      try {
        for (;;) {
          connection.execute(std::string("INSERT INTO event (at, kind, message) VALUES ('', 'filler', ") +
                             message + ")");
        }
      } catch (const DatabaseError& error) {
        EXPECT_TRUE(error.no_room());
      }
    }
  }
  void make_room() {
    database_.connection().execute(
        "PRAGMA max_page_count = 1000000; DELETE FROM event WHERE kind = 'filler'");
  }
  void finish_all() {
    for (int worker = 0; worker < pool_.size(); ++worker) {
      if (pool_.has_job(worker)) pool_.finish(worker, pool_.job(worker).seed % 2 == 0 ? 10 : 10.01);
    }
  }
  std::int64_t count(const std::string& sql) { return database_.connection().integer(sql); }

  TemporaryFolder folder_;
  CampaignDirectory directory_{folder_.path()};
  Campaign campaign_ = plain_campaign(1, 8, 40, 0.05);
  Database database_ = Database::open_owner(directory_.database());
  ScriptedPool pool_{2};
  SilentListener listener_;
  std::optional<CampaignState> state_;
};

TEST_F(FullDatabase, LosesNothingGivesOutNothingAndGoesOn) {
  int turns = 0;
  std::size_t assigned = 0;
  pool_.script = [&, this] {
    ++turns;
    if (turns == 3) {
      fill();
      assigned = pool_.assigned.size();
    }
    if (turns > 3 && turns < 60) {  // 30 s of the test's time
      EXPECT_EQ(pool_.assigned.size(), assigned);
    }
    if (turns == 60) make_room();
    finish_all();
  };
  EXPECT_EQ(run(), Dispatcher::Ending::finished);
  EXPECT_GT(turns, 60);
  // Each seed ran once, and no attempt is blamed.
  EXPECT_EQ(count("SELECT count(*) FROM attempt"), count("SELECT count(*) FROM result"));
  EXPECT_EQ(count("SELECT count(*) FROM attempt WHERE outcome != 'result'"), 0);
  EXPECT_TRUE(spool_files(directory_).empty());
  ASSERT_EQ(listener_.warnings.size(), 1U);
  EXPECT_NE(listener_.warnings.at(0).find("is full"), std::string::npos);
  // Events that were rolled back with their booking have been told once all the same.
  EXPECT_EQ(listener_.count<SeedEnded>(), count("SELECT count(*) FROM result"));
  EXPECT_EQ(listener_.count<StopTestMade>(), count("SELECT count(*) FROM stop_test"));
  EXPECT_EQ(listener_.count<ShortageBegan>(), 1);
  EXPECT_EQ(listener_.count<ShortageEnded>(), 1);
}

TEST_F(FullDatabase, SaysOnceWhatElseIsInTheWayMeanwhile) {
  Connection other(directory_.database().string(), Connection::Access::read_write, 0);
  int turns = 0;
  pool_.script = [&, this] {
    ++turns;
    if (turns == 3) fill();
    if (turns == 20) other.execute("BEGIN IMMEDIATE");
    if (turns == 28) other.execute("ROLLBACK");
    if (turns == 60) make_room();
    ASSERT_LT(turns, 400) << "it does not go on";
    finish_all();
  };
  EXPECT_EQ(run(), Dispatcher::Ending::finished);
  ASSERT_EQ(listener_.warnings.size(), 2U);
  EXPECT_TRUE(says(listener_.warnings.at(0), "is full")) << listener_.warnings.at(0);
  EXPECT_TRUE(says(listener_.warnings.at(1), "is locked by")) << listener_.warnings.at(1);
  EXPECT_EQ(listener_.count<ShortageBegan>(), 2);
  EXPECT_EQ(listener_.count<ShortageEnded>(), 1);
}

TEST_F(FullDatabase, LosesNothingOfWorkersThatHaveTwoJobs) {
  pool_.takes_ahead = true;
  pool_.wall_seconds = 0.1;
  int turns = 0;
  std::size_t assigned = 0;
  bool had_waiting = false;
  pool_.script = [&, this] {
    ++turns;
    if (turns == 4) {
      had_waiting = pool_.has_waiting(0) && pool_.has_waiting(1);
      fill();
      assigned = pool_.assigned.size();
    }
    if (turns > 4 && turns < 60) {
      EXPECT_EQ(pool_.assigned.size(), assigned);
    }
    if (turns == 60) make_room();
    finish_all();
  };
  EXPECT_EQ(run(), Dispatcher::Ending::finished);
  EXPECT_TRUE(had_waiting);
  EXPECT_GT(turns, 60);
  EXPECT_EQ(count("SELECT count(*) FROM attempt WHERE outcome = 'result'"),
            count("SELECT count(*) FROM result"));
  // The others were extra when the point was decided.
  EXPECT_EQ(count("SELECT count(*) FROM attempt WHERE outcome NOT IN ('result', 'drained') OR blamed"), 0);
  EXPECT_EQ(count("SELECT count(*) FROM attempt WHERE outcome = 'drained' AND seed < 8"), 0);
  EXPECT_TRUE(spool_files(directory_).empty());
}

TEST_F(FullDatabase, TellsWhatIsCommittedAndNothingThatWasTakenBack) {
  const std::int64_t engine = state_->admit_engine(plain_engine());
  {
    const Transaction booking(database_.connection());
    state_->end_attempt(*state_->give_out(0, 4711, engine), {AttemptOutcome::crashed});
  }
  state_->roll_back();
  state_->after_commit();
  EXPECT_EQ(listener_.count<AttemptFailed>(), 0);

  Transaction booking(database_.connection());
  state_->end_attempt(*state_->give_out(0, 4711, engine), {AttemptOutcome::crashed});
  EXPECT_EQ(listener_.count<AttemptFailed>(), 0);
  booking.commit();
  state_->after_commit();
  EXPECT_EQ(listener_.count<AttemptFailed>(), 1);
}

TEST_F(FullDatabase, KeepsARequestUntilThereIsRoom) {
  RequestHandler requests(database_, *state_, directory_, listener_);
  DispatchSettings settings;
  settings.requests = [&] { return requests.carry_out(); };
  int turns = 0;
  pool_.script = [&, this] {
    ++turns;
    if (turns == 3) {
      fill();
      write_request(directory_, Cancel{{"point=0"}, false});
    }
    if (turns == 40) {
      EXPECT_EQ(waiting_requests(directory_).size(), 1U);
      EXPECT_EQ(count("SELECT cancelled FROM point"), 0);
      make_room();
    }
    ASSERT_LT(turns, 400) << "it does not go on";
  };
  EXPECT_EQ(run(settings), Dispatcher::Ending::finished);
  EXPECT_GE(turns, 40);
  EXPECT_TRUE(waiting_requests(directory_).empty());
  EXPECT_EQ(count("SELECT cancelled FROM point"), 1);
  EXPECT_EQ(count("SELECT count(*) FROM event WHERE request IS NOT NULL"), 1);
  EXPECT_EQ(count("SELECT count(*) FROM attempt WHERE outcome = 'drained' AND blamed = 0"), 2);
  ASSERT_EQ(listener_.warnings.size(), 1U);
  EXPECT_NE(listener_.warnings.at(0).find("is full"), std::string::npos);
}

TEST_F(FullDatabase, CanBeStoppedAndTheSpoolKeepsTheResults) {
  int turns = 0;
  pool_.script = [&, this] {
    ++turns;
    if (turns == 2) fill();
    finish_all();
    if (turns == 10) pool_.say(StopSignal{});
    ASSERT_LT(turns, 200) << "it does not stop";
  };
  EXPECT_EQ(run(), Dispatcher::Ending::stopped);
  EXPECT_EQ(spool_files(directory_).size(), 2U);
  make_room();
  const std::int64_t before = count("SELECT count(*) FROM result");
  state_.emplace(database_, campaign_, directory_, listener_, 2);  // the next run
  EXPECT_EQ(count("SELECT count(*) FROM result"), before + 2);
  EXPECT_TRUE(spool_files(directory_).empty());
}

}  // namespace
}  // namespace peclet::runner
