// Files beside results: each is in its place, once, wherever the owner died.
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "contract/durable_file.h"
#include "contract/errors.h"
#include "contract/sha256.h"
#include "runner/owner/after_commit.h"
#include "runner/store/result_files.h"
#include "tests/runner/owner/dispatcher_fixture.h"

namespace peclet::runner {
namespace {

namespace fs = std::filesystem;

class TakingFiles : public Dispatching {
 protected:
  TakingFiles() { start(); }

  // Starts another owner, which takes in the spool.
  void start() { state_.emplace(database_, campaign_, directory_, listener_, 2); }

  std::string text(int seed, int number) const {
    return "seed " + std::to_string(seed) + ", file " + std::to_string(number);
  }
  // Leaves two files of an attempt at a seed, and a result that lists them.
  fs::path leave(int seed, int attempt = 1, const std::string& identity = "engine") {
    const std::string& hash = campaign_.points[0].hash;
    const fs::path spool = directory_.spool_file(hash, seed, attempt);
    write_durably(spool, result(seed, identity).dump());
    for (const int number : {0, 1}) write_durably(left(spool, number), text(seed, number));
    return spool;
  }
  Json result(int seed, const std::string& identity = "engine") const {
    Json document = plain_result(campaign_.points[0].hash, seed, steady(seed), identity);
    for (const int number : {0, 1}) {
      const std::string bytes = text(seed, number);
      document["files"].push_back(
          {{"name", name(number)}, {"bytes", bytes.size()}, {"sha256", sha256(bytes)}});
    }
    return document;
  }
  static std::string name(int number) { return "file-" + std::to_string(number) + ".txt"; }
  static fs::path left(const fs::path& spool, int number) { return left_file(spool, name(number)); }
  fs::path place(int seed, int number, std::int64_t point = 1) const {
    return directory_.left_files(campaign_.points[0].hash, point, seed) / name(number);
  }
  void expect_in_place(int seed, std::int64_t point = 1) {
    for (const int number : {0, 1}) {
      ASSERT_TRUE(fs::exists(place(seed, number, point)));
      EXPECT_EQ(read_file(place(seed, number, point)), text(seed, number));
    }
    EXPECT_EQ(files_of_seed(database_.connection(), point, seed).size(), 2U);
    EXPECT_TRUE(files_of_seed(database_.connection(), point, seed)[0].kept);
  }
  void expect_empty_spool() {
    EXPECT_TRUE(spool_files(directory_).empty());
    EXPECT_TRUE(fs::is_empty(directory_.left()));
  }
  std::ptrdiff_t rejected() const { return std::distance(fs::directory_iterator(directory_.rejected()), {}); }

  FileRemoval removal_;
};

TEST_F(TakingFiles, BringsThemToTheirPlaces) {
  leave(0);
  state_->ingest_spool();
  expect_in_place(0);
  expect_empty_spool();
  EXPECT_EQ(database_.connection().text("SELECT path FROM files WHERE name = 'file-1.txt'"),
            place(0, 1).lexically_relative(directory_.root()).string());
}

TEST_F(TakingFiles, GoesOnWhereverTheOwnerDied) {
  // The owner dies after this number of files was moved.
  for (const int moved : {0, 1, 2}) {
    const int seed = moved;
    const fs::path spool = leave(seed);
    {
      // Commits, and does nothing that follows the commit.
      Transaction booking(database_.connection());
      AfterCommit never;
      ResultStore results(database_);
      const RealisationResult read = read_spool_file(spool, "");
      const StoredResult stored = results.store(read, campaign_.target);
      take_files(database_.connection(), directory_, read, spool, stored, true, never);
      booking.commit();
    }
    for (int number = 0; number < moved; ++number) rename_durably(left(spool, number), place(seed, number));
    start();
    expect_in_place(seed);
    expect_empty_spool();
  }
  // Before the commit the result is unknown, and the spool has everything.
  const fs::path spool = leave(3);
  {
    Transaction booking(database_.connection());
    AfterCommit never;
    const RealisationResult read = read_spool_file(spool, "");
    const StoredResult stored = ResultStore(database_).store(read, campaign_.target);
    take_files(database_.connection(), directory_, read, spool, stored, true, never);
  }
  EXPECT_FALSE(fs::exists(place(3, 0)));
  start();
  expect_in_place(3);
  expect_empty_spool();
  EXPECT_EQ(database_.counts(1).done, 4);
  EXPECT_EQ(rejected(), 0);
}

TEST_F(TakingFiles, RefusesAResultWhoseFilesAreNotWhatItSays) {
  const std::vector<std::pair<std::string, std::function<void(const fs::path&)>>> damages{
      {"its file file-1.txt is missing", [](const fs::path& file) { fs::remove(file); }},
      {"its file file-1.txt does not have its hash",
       [this](const fs::path& file) { write_durably(file, text(0, 9)); }},
      {"its file file-1.txt has 3 bytes instead of 14",
       [](const fs::path& file) { write_durably(file, "cut"); }},
      {"its file file-1.txt is a link", [](const fs::path& file) {
         fs::remove(file);
         fs::create_symlink("/etc/hostname", file);
       }}};
  for (const auto& [why, damage] : damages) {
    const fs::path spool = leave(0);
    damage(left(spool, 1));
    const std::ptrdiff_t before = rejected();
    state_->ingest_spool();
    EXPECT_TRUE(was_warned_of(spool.filename().string() + " is not taken: " + why)) << why;
    EXPECT_GE(rejected(), before + 2);  // the result and its sound files
    EXPECT_EQ(database_.counts(1).done, 0);
    EXPECT_TRUE(files_in(database_.connection()).empty());
    EXPECT_FALSE(fs::exists(directory_.files())) << why;
    fs::remove(left(spool, 1));
    expect_empty_spool();
  }
  leave(0, 2);
  state_->ingest_spool();
  expect_in_place(0);
}

TEST_F(TakingFiles, OfSeedsBeyondTheRuleThrowsThemAwayAndSaysSo) {
  campaign_.seeds_with_files = 1;
  start();
  leave(0);
  leave(1);
  state_->ingest_spool();
  expect_in_place(0);
  EXPECT_FALSE(fs::exists(place(1, 0)));
  const std::vector<FileRecord> thrown = files_of_seed(database_.connection(), 1, 1);
  ASSERT_EQ(thrown.size(), 2U);
  EXPECT_FALSE(thrown[0].kept);
  EXPECT_EQ(thrown[1].file.sha256, sha256(text(1, 1)));
  expect_empty_spool();
  // Later files follow the new rule; these are gone.
  campaign_.seeds_with_files = most_realisations;
  start();
  leave(1, 2);
  leave(2);
  state_->ingest_spool();
  EXPECT_FALSE(fs::exists(place(1, 0)));
  expect_in_place(2);
  expect_empty_spool();
}

TEST_F(TakingFiles, OfTwoRunsOfASeedKeepsOneAndHealsIt) {
  leave(0, 1);
  leave(0, 2);
  state_->ingest_spool();
  expect_in_place(0);
  expect_empty_spool();
  fs::remove(place(0, 1));
  leave(0, 3);
  state_->ingest_spool();
  expect_in_place(0);
  expect_empty_spool();
}

TEST_F(TakingFiles, OfAnotherAnswerKeepsThemWithTheRejectedResult) {
  leave(0, 1);
  state_->ingest_spool();
  const fs::path spool = leave(0, 2);
  Json other = result(0);
  other["mean"]["relative_viscosity"] = 11;
  write_durably(spool, other.dump());
  state_->ingest_spool();
  EXPECT_EQ(rejected(), 3);
  expect_in_place(0);
  expect_empty_spool();
}

TEST_F(TakingFiles, OfEnginesThatAreSetAsideStandSideBySide) {
  leave(0, 1, "old");
  state_->ingest_spool();
  start();
  EXPECT_EQ(state_->accept_engine(engine_identity(plain_engine("new"))), 1);
  leave(0, 2, "new");
  leave(1, 3, "old");  // left by a slow worker
  state_->ingest_spool();
  const std::int64_t now = database_.points().at(0).id;
  ASSERT_NE(now, 1);
  expect_in_place(0, 1);
  expect_in_place(1, 1);
  expect_in_place(0, now);
  expect_empty_spool();
  EXPECT_EQ(database_.connection().integer("SELECT count(*) FROM files"), 2);  // files of the sweep
}

TEST_F(TakingFiles, RemovesThoseOfDeadAttemptsAndOfNobodyElse) {
  const std::int64_t engine = [this] {
    Transaction booking(database_.connection());
    const std::int64_t row = state_->admit_engine(plain_engine());
    booking.commit();
    return row;
  }();
  const pid_t dead = fork();
  if (dead == 0) _exit(0);
  ASSERT_EQ(waitpid(dead, nullptr, 0), dead);
  std::vector<fs::path> spools;
  for (const pid_t process : {dead, getpid()}) {
    Transaction giving(database_.connection());
    spools.push_back(state_->give_out(0, process, engine).value().job.spool);
    giving.commit();
    write_durably(left(spools.back(), 0), "half of it");
  }
  write_durably(directory_.left() / "of-nobody", "");
  start();
  EXPECT_FALSE(fs::exists(left(spools[0], 0)));
  EXPECT_TRUE(fs::exists(left(spools[1], 0))) << "its worker may be about to write the result";
  EXPECT_TRUE(fs::exists(directory_.left() / "of-nobody"));
}

// A restored database may come from anywhere.
TEST_F(TakingFiles, ByARowThatLeadsElsewhereIsRefused) {
  leave(0);
  state_->ingest_spool();
  for (const char* const change : {"file SET name = '../../../escaped' WHERE name = 'file-0.txt'",
                                   "file SET sha256 = '../../escaped'", "point SET hash = '../../escaped'"}) {
    Transaction taken_back(database_.connection());
    database_.connection().execute(std::string("UPDATE ") + change);
    EXPECT_THROW(files_in(database_.connection()), IntegrityError) << change;
  }
  EXPECT_EQ(files_in(database_.connection()).size(), 2U);
}

// A folder shared with a batch system, or a spool that is a mount, may be on another file system.
TEST_F(TakingFiles, FromAnotherFileSystemTheyComeAsCopies) {
  struct stat here {
  }, there{};
  const fs::path memory = "/dev/shm";
  ASSERT_EQ(stat(memory.c_str(), &there), 0);
  ASSERT_EQ(stat(folder_.path().c_str(), &here), 0);
  ASSERT_NE(here.st_dev, there.st_dev) << "TMPDIR must be on another file system than /dev/shm";
  const fs::path elsewhere = memory / folder_.path().filename();
  const CampaignDirectory shared(elsewhere);
  create_folders(shared);
  const fs::path spool =
      shared.spool() / (campaign_.points[0].hash.substr(0, 16) + "-000000-0123456789abcdef.json");
  write_durably(spool, result(0).dump());
  for (const int number : {0, 1}) write_durably(left(spool, number), text(0, number));
  const auto take_in = [&](bool to_the_end) {
    Transaction booking(database_.connection());
    AfterCommit after;
    const RealisationResult read = read_spool_file(spool, "");
    const StoredResult stored = ResultStore(database_).store(read, campaign_.target);
    take_files(database_.connection(), directory_, read, spool, stored, true, after);
    booking.commit();
    for (const int number : {0, 1}) EXPECT_TRUE(fs::exists(left(spool, number))) << "until it has its place";
    if (!to_the_end) return;
    after.carry_out(listener_, removal_);
    removal_.finish();
  };
  take_in(false);  // the owner dies after the commit
  take_in(true);
  expect_in_place(0);
  EXPECT_TRUE(fs::is_empty(shared.left()));
  EXPECT_EQ(std::distance(fs::directory_iterator(place(0, 0).parent_path()), {}), 2) << "no copy is left";
  fs::remove_all(elsewhere);
}

TEST_F(TakingFiles, KeepsWhatWasCheckedWhateverHasItsNameSince) {
  const fs::path spool = leave(0);
  AfterCommit after;
  {
    Transaction booking(database_.connection());
    const RealisationResult read = read_spool_file(spool, "");
    const StoredResult stored = ResultStore(database_).store(read, campaign_.target);
    take_files(database_.connection(), directory_, read, spool, stored, true, after);
    fs::remove(left(spool, 0));
    fs::remove(left(spool, 1));
    fs::create_directories(left(spool, 1) / "inside");
    booking.commit();
  }
  after.carry_out(listener_, removal_);
  EXPECT_NO_THROW(removal_.finish());
  expect_in_place(0);
}

TEST_F(TakingFiles, MovesAsideWhatIsInTheirPlaces) {
  fs::create_directories(place(0, 1) / "inside");
  leave(0);
  state_->ingest_spool();
  expect_in_place(0);
  EXPECT_TRUE(fs::exists(place(0, 1).string() + "@aside/inside"));
  EXPECT_TRUE(
      was_warned_of("file-1.txt: was a folder in the place of a regular file; moved to file-1.txt@aside"));
  // A file lies in the place of a seed's folder.
  write_durably(place(1, 0).parent_path(), "in the way");
  leave(1);
  state_->ingest_spool();
  expect_in_place(1);
  EXPECT_EQ(read_file(place(1, 0).parent_path().string() + "@aside"), "in the way");
}

TEST_F(TakingFiles, CountsNoFolderAsAFile) {
  leave(0);
  state_->ingest_spool();
  fs::remove(place(0, 0));
  fs::create_directory(place(0, 0));
  leave(0, 2);
  state_->ingest_spool();
  expect_in_place(0);
}

TEST_F(TakingFiles, OfAFolderThatIsGoneTakesNothing) {
  leave(0);
  fs::remove_all(directory_.spool());
  EXPECT_NO_THROW(state_->ingest_spool());
  EXPECT_EQ(database_.counts(1).done, 0);
}

// Another program may change these folders, too.
TEST_F(TakingFiles, ReplacesNoFolderAndMissesNoFileThatHasGone) {
  AfterCommit after;
  const fs::path result = directory_.spool() / "x.json", place = directory_.root() / "files" / "x";
  fs::create_directories(place.parent_path());
  write_durably(result, "result");
  write_durably(directory_.root() / "files" / "@x", "file");
  after.keep(directory_.root() / "files" / "@x", place);
  after.reject(directory_.spool() / "vanished.json");
  after.remove(result);
  after.discard(directory_.checkpoints() / "c.checkpoint");
  fs::create_directories(directory_.checkpoints() / "c.checkpoint" / "inside");
  fs::remove_all(directory_.rejected());
  after.carry_out(listener_, removal_);
  removal_.finish();
  EXPECT_EQ(read_file(place), "file");
  EXPECT_FALSE(fs::exists(result));
  EXPECT_FALSE(fs::exists(directory_.checkpoints() / "c.checkpoint"));
  EXPECT_TRUE(fs::exists(directory_.checkpoints() / "c.checkpoint@aside" / "inside"));
}

}  // namespace
}  // namespace peclet::runner
