// A task of a batch system in a process of its own: run again, told to leave, killed.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>

#include "contract/durable_file.h"
#include "contract/errors.h"
#include "runner/batch/bundle_files.h"
#include "tests/runner/batch/batch_fixture.h"

namespace peclet::runner {
namespace {

namespace fs = std::filesystem;

using BatchTask = BatchFixture;

// A task in a process of its own.
class TaskProcess {
 public:
  explicit TaskProcess(const std::function<int()>& run) : process_(fork()) {
    if (process_ == 0) _exit(run());
  }
  void signal(int number) const { kill(process_, number); }
  int finish() const {
    int status = 0;
    waitpid(process_, &status, 0);
    return WIFSIGNALED(status) ? -WTERMSIG(status) : WEXITSTATUS(status);
  }

 private:
  pid_t process_;
};

bool appears(const fs::path& path) {
  return comes_true([&] { return fs::exists(path); });
}

TEST_F(BatchTask, RunAgainItRunsNothingTwice) {
  ASSERT_EQ(hand_over(), 0);
  EXPECT_EQ(run_task(1, 0), 0);
  const auto files = [&] {
    return std::distance(fs::directory_iterator(shared() / "spool"), fs::directory_iterator());
  };
  const std::ptrdiff_t before = files();
  EXPECT_EQ(run_task(1, 0), 0);
  EXPECT_EQ(files(), before);
}

TEST_F(BatchTask, ASignalMakesItSaveAndLeave) {
  set("PECLET_FAKE_STEP_MS", "10");
  set("PECLET_FAKE_STEPS", "100000");
  for (const int number : {SIGTERM, SIGUSR1}) {
    ASSERT_EQ(hand_over(), 0);
    const int bundle_number = static_cast<int>(count("SELECT max(bundle_id) FROM bundle"));
    const TaskProcess task([&] { return run_task(bundle_number, 0); });
    ASSERT_TRUE(appears(bundle(bundle_number) / "tasks" / "0" / "running.json"));
    ASSERT_TRUE(comes_true([&] { return !fs::is_empty(shared() / "checkpoints"); }));
    task.signal(number);
    EXPECT_EQ(task.finish(), 75);
    EXPECT_FALSE(fs::is_empty(shared() / "checkpoints"));
    for (const fs::directory_entry& saved : fs::directory_iterator(shared() / "checkpoints")) {
      fs::remove(saved);  // the next round must wait for its own
    }
    EXPECT_EQ(read_json(bundle(bundle_number) / "tasks" / "0" / "running.json")["outcome"], "drained");
    ASSERT_EQ(ingest(), 0);
    EXPECT_EQ(count("SELECT count(*) FROM attempt"), 0) << "a drain is nobody's attempt to judge";
  }
}

TEST_F(BatchTask, KilledInTheMiddleItIsCountedWithoutBlame) {
  std::ofstream(folder() / "hold") << "";
  set("PECLET_FAKE_HOLD", (folder() / "hold").string());
  set("PECLET_FAKE_HOLD_SEED", "0");
  ASSERT_EQ(hand_over(), 0);
  const TaskProcess task([&] { return run_task(1, 0); });
  ASSERT_TRUE(appears(bundle(1) / "tasks" / "0" / "running.json"));
  task.signal(SIGKILL);
  EXPECT_EQ(task.finish(), -SIGKILL);
  ASSERT_EQ(ingest(), 0);
  EXPECT_EQ(count("SELECT count(*) FROM attempt WHERE outcome = 'killed' AND NOT blamed"), 1);
  EXPECT_EQ(seeds_out(), 0);
}

TEST_F(BatchTask, AnEngineThatRunsSeveralAtOnceIsFilled) {
  set("PECLET_FAKE_CAPACITY", "3");
  options.seeds_per_task = 5;
  ASSERT_EQ(hand_over(), 0);
  for (const int index : {0, 1}) EXPECT_EQ(run_task(1, index), 0);
  ASSERT_EQ(ingest(), 0);
  EXPECT_EQ(count("SELECT count(*) FROM realisation WHERE state = 'done'"), 10);
  EXPECT_EQ(answer(), local_answer());
}

TEST_F(BatchTask, ASignalMakesAnEngineSaveAllItsSeeds) {
  set("PECLET_FAKE_CAPACITY", "3");
  set("PECLET_FAKE_STEP_MS", "10");
  set("PECLET_FAKE_STEPS", "100000");
  options.seeds_per_task = 5;
  ASSERT_EQ(hand_over(), 0);
  const TaskProcess task([&] { return run_task(1, 0); });
  ASSERT_TRUE(appears(bundle(1) / "tasks" / "0" / "running-2.json"));
  task.signal(SIGTERM);
  EXPECT_EQ(task.finish(), 75);
  for (const char* const name : {"running.json", "running-1.json", "running-2.json"}) {
    EXPECT_EQ(read_json(bundle(1) / "tasks" / "0" / name)["outcome"], "drained");
  }
  EXPECT_EQ(std::distance(fs::directory_iterator(shared() / "checkpoints"), fs::directory_iterator()), 3);
  ASSERT_EQ(ingest(), 0);
  EXPECT_EQ(seeds_out(), 0);
  EXPECT_EQ(count("SELECT count(*) FROM attempt"), 0);
}

TEST_F(BatchTask, APoisonousSeedIsFoundInSmallerAndSmallerGroups) {
  set("PECLET_FAKE_CAPACITY", "4");
  set("PECLET_FAKE_FAULTS", "crash:3");
  options.seeds_per_task = 5;
  for (int round = 1; round == 1 || count("SELECT count(*) FROM realisation WHERE state = 'queued'") > 0;
       ++round) {
    ASSERT_LE(round, 6);
    ASSERT_EQ(hand_over(), 0);
    const auto last = static_cast<int>(count("SELECT tasks FROM bundle ORDER BY bundle_id DESC LIMIT 1"));
    for (int index = 0; index < last; ++index) ASSERT_EQ(run_task(round, index), 0);
    ASSERT_EQ(ingest(), 0);
  }
  EXPECT_EQ(count("SELECT count(*) FROM realisation WHERE state = 'quarantined' AND seed = 3"), 2);
  EXPECT_EQ(count("SELECT count(*) FROM realisation WHERE state = 'done'"), 8);
  EXPECT_EQ(count("SELECT count(*) FROM attempt WHERE blamed AND seed = 3"), 6);
  EXPECT_EQ(count("SELECT count(*) FROM attempt WHERE blamed AND seed != 3"), 0);
}

TEST_F(BatchTask, ADeviceIsAskedOfSlurmAndOfTheEngine) {
  options.system = "slurm";
  options.device = "cuda";
  options.options = {"--partition=short"};
  ASSERT_EQ(hand_over(), 0);
  EXPECT_EQ(read_json(bundle(1) / "options.json"), Json({"--gres=gpu:1", "--partition=short"}));
  unsetenv("PECLET_DEVICE");  // as on another machine
  EXPECT_EQ(run_task(1, 0), 0);
  EXPECT_STREQ(std::getenv("PECLET_DEVICE"), "cuda");
  unsetenv("PECLET_DEVICE");
}

TEST_F(BatchTask, AnotherEngineThanTheOwnersRunsNothing) {
  ASSERT_EQ(hand_over(), 0);
  set("PECLET_FAKE_IDENTITY", "another");
  EXPECT_THROW(run_task(1, 0), IntegrityError);
  unsetenv("PECLET_FAKE_IDENTITY");
  ASSERT_EQ(ingest(), 0);
  EXPECT_EQ(count("SELECT count(*) FROM attempt"), 0);
  EXPECT_EQ(count("SELECT count(*) FROM bundle_seed WHERE outcome = 'returned'"), 10);
}

TEST_F(BatchTask, ATaskThatTheManifestLacksIsRefused) {
  ASSERT_EQ(hand_over(), 0);
  EXPECT_THROW(run_task(1, tasks), InputError);
  std::ofstream(folder() / "no.json") << "{}";
  EXPECT_THROW(read_manifest(folder() / "no.json"), InputError);
}

}  // namespace
}  // namespace peclet::runner
