// Temporary hindrances of the owner. Full disks are in tests/runner/store/disk_room_test.cpp.
#include "runner/owner/pause.h"

#include <gtest/gtest.h>
#include <sqlite3.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <fstream>
#include <system_error>

#include "contract/durable_file.h"
#include "runner/store/result_files.h"
#include "tests/runner/owner/dispatcher_fixture.h"

namespace peclet::runner {
namespace {

namespace fs = std::filesystem;

TEST(Hindrance, IsAFullDiskALockOrAFaultOfTheMachine) {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "files" / "x";
  fs::create_directories(file.parent_path());
  const std::optional<Hindrance> full = hindrance_in(NoRoomError(ENOSPC, "", file, 1 << 24), folder.path());
  EXPECT_EQ(full->folder, file.parent_path());
  EXPECT_EQ(full->bytes, 1U << 24);
  EXPECT_TRUE(says(full->text, file.parent_path().string() + " is full: ")) << full->text;
  const std::optional<Hindrance> quota =
      hindrance_in(std::system_error(EDQUOT, std::generic_category(), "x"), folder.path(), 7);
  EXPECT_EQ(quota->folder, folder.path());
  EXPECT_EQ(quota->bytes, 7U);
  EXPECT_TRUE(says(quota->text, "is full: your disk quota is used up")) << quota->text;
  EXPECT_TRUE(
      says(hindrance_in(DatabaseError("", SQLITE_IOERR_WRITE, EDQUOT), folder.path())->text, "quota"));
  EXPECT_TRUE(says(hindrance_in(DatabaseError("", SQLITE_FULL), folder.path())->text, "is full: "));

  const std::optional<Hindrance> lock =
      hindrance_in(DatabaseError("x: is locked by y", SQLITE_BUSY), folder.path());
  EXPECT_EQ(lock->text, "x: is locked by y");
  EXPECT_TRUE(lock->folder.empty());
  const std::optional<Hindrance> fault =
      hindrance_in(std::system_error(EIO, std::generic_category(), "cannot synchronise x"), folder.path());
  EXPECT_TRUE(says(fault->text, "cannot synchronise x: Input/output error")) << fault->text;
  EXPECT_TRUE(fault->folder.empty());

  EXPECT_EQ(hindrance_in(std::system_error(ENOENT, std::generic_category()), folder.path()), std::nullopt);
  EXPECT_EQ(hindrance_in(DatabaseError("", SQLITE_IOERR_FSYNC, EIO), folder.path()), std::nullopt);
  EXPECT_EQ(hindrance_in(std::runtime_error("full"), folder.path()), std::nullopt);
}

TEST(Hindrance, IsOneOnOneFileSystem) {
  const TemporaryFolder folder;
  const fs::path spool = folder.path() / "spool", checkpoints = folder.path() / "checkpoints";
  fs::create_directories(spool);
  fs::create_directories(checkpoints);
  const std::string kind = lack_of_room_in(spool, 1, ENOSPC).kind();
  EXPECT_EQ(lack_of_room_in(checkpoints, 2, ENOSPC).kind(), kind);
  EXPECT_NE(lack_of_room_in("/proc", 1, ENOSPC).kind(), kind);
  EXPECT_NE(hindrance_in(DatabaseError("", SQLITE_BUSY), folder.path())->kind(), kind);
}

class LockedDatabase : public Dispatching {
 protected:
  Connection other_{directory_.database().string(), Connection::Access::read_write, 0};
};

TEST_F(LockedDatabase, IsAPauseThatEndsWithTheLock) {
  int turns = 0;
  pool_.script = [&, this] {
    ++turns;
    if (turns == 2) other_.execute("BEGIN IMMEDIATE");
    if (turns == 20) other_.execute("ROLLBACK");
    ASSERT_LT(turns, 400) << "it does not go on";
    finish_all();
  };
  EXPECT_EQ(run(), Dispatcher::Ending::finished);
  EXPECT_GE(turns, 20);
  EXPECT_EQ(database_.connection().integer("SELECT count(*) FROM attempt"),
            database_.connection().integer("SELECT count(*) FROM result"));
  EXPECT_EQ(database_.connection().integer("SELECT count(*) FROM attempt WHERE outcome != 'result'"), 0);
  EXPECT_TRUE(spool_files(directory_).empty());
  ASSERT_EQ(listener_.warnings.size(), 1U);
  EXPECT_TRUE(was_warned_of("campaign.db: is locked by "));
  EXPECT_TRUE(was_warned_of("the campaign continues by itself when the lock is released"));
  EXPECT_EQ(listener_.count<ShortageBegan>(), 1);
  EXPECT_EQ(listener_.count<ShortageEnded>(), 1);
}

TEST_F(LockedDatabase, CanBeStoppedAndTheSpoolKeepsTheResults) {
  int turns = 0;
  pool_.script = [&, this] {
    ++turns;
    if (turns == 2) other_.execute("BEGIN IMMEDIATE");
    finish_all();
    if (turns == 5) pool_.say(StopSignal{});
    ASSERT_LT(turns, 400) << "it does not stop";
  };
  EXPECT_EQ(run(), Dispatcher::Ending::stopped);
  EXPECT_EQ(spool_files(directory_).size(), 2U);
  EXPECT_TRUE(was_warned_of("what workers did last is booked by the next run"));
}

// The lock is held by another process, because locks of one process do not exclude each other.
TEST(LockText, NamesTheProgramThatHasLockedTheDatabase) {
  const TemporaryFolder folder;
  const std::string path = (folder.path() / "campaign.db").string();
  Connection(path, Connection::Access::create, 0).execute("PRAGMA journal_mode = WAL; CREATE TABLE t (x)");
  std::array<int, 2> ready{};
  ASSERT_EQ(pipe(ready.data()), 0);
  const pid_t child = fork();
  if (child == 0) {
    Connection locker(path, Connection::Access::read_write, 0);
    locker.execute("BEGIN IMMEDIATE");
    if (write(ready[1], "x", 1) == 1) pause();
    _exit(1);
  }
  char signal = 0;
  ASSERT_EQ(read(ready[0], &signal, 1), 1);
  std::string own_name;
  std::getline(std::ifstream("/proc/self/comm"), own_name);
  try {
    Connection(path, Connection::Access::read_write, 0).execute("BEGIN IMMEDIATE");
    ADD_FAILURE() << "the lock excludes nobody";
  } catch (const DatabaseError& error) {
    EXPECT_TRUE(error.is_locked());
    EXPECT_TRUE(
        says(error.what(), path + ": is locked by " + own_name + " (process " + std::to_string(child) + ")"))
        << error.what();
  }
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
}

}  // namespace
}  // namespace peclet::runner
