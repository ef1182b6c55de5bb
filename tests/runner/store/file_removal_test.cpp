#include "runner/store/file_removal.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>
#include <fstream>

#include "tests/runner/runner_fixture.h"

namespace peclet::runner {
namespace {

namespace fs = std::filesystem;

class FileRemovals : public testing::Test {
 protected:
  fs::path made(const std::string& name) const {
    fs::path path = folder_.path() / name;
    std::ofstream(path) << "x";
    return path;
  }
  TemporaryFolder folder_;
};

TEST_F(FileRemovals, AreThroughWhenItSaysSo) {
  FileRemoval removal;
  for (int round = 0; round < 20; ++round) {
    removal.add({made("a"), made("b"), folder_.path() / "never there"});
    removal.add({made("c")});
    removal.finish();
    EXPECT_TRUE(fs::is_empty(folder_.path()));
  }
}

TEST_F(FileRemovals, AreThroughAtItsEnd) {
  std::vector<fs::path> files(500);
  for (std::size_t number = 0; number < files.size(); ++number) files[number] = made(std::to_string(number));
  FileRemoval().add(files);
  EXPECT_TRUE(fs::is_empty(folder_.path()));
}

TEST_F(FileRemovals, SayOnceWhatCouldNotBeRemoved) {
  const fs::path impossible = made("file") / "name";  // a file cannot have files below it
  FileRemoval removal;
  removal.add({impossible, made("b")});
  try {
    removal.finish();
    FAIL() << "removed";
  } catch (const std::system_error& error) {
    EXPECT_EQ(error.code(), std::errc::not_a_directory);
    EXPECT_NE(std::string(error.what()).find(impossible.string()), std::string::npos);
  }
  EXPECT_FALSE(fs::exists(folder_.path() / "b"));
  removal.finish();
}

TEST_F(FileRemovals, LeaveSignalsToOthers) {
  sigset_t before, after, mine;
  sigemptyset(&mine);
  sigaddset(&mine, SIGUSR2);
  pthread_sigmask(SIG_SETMASK, nullptr, &before);
  const FileRemoval removal;
  pthread_sigmask(SIG_SETMASK, nullptr, &after);
  EXPECT_EQ(sigismember(&before, SIGTERM), sigismember(&after, SIGTERM));
  // A signal of the process that this thread blocks would go to the other one, and end the program.
  pthread_sigmask(SIG_BLOCK, &mine, &before);
  kill(getpid(), SIGUSR2);
  const timespec patience{5, 0};
  EXPECT_EQ(sigtimedwait(&mine, nullptr, &patience), SIGUSR2);
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

}  // namespace
}  // namespace peclet::runner
