// The engine's handling of jobs that arrive while one runs.
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <thread>

#include "contract/durable_file.h"
#include "contract/frames.h"
#include "tests/engine/realisation/small_result.h"
#include "tests/engine/temporary_folder.h"

namespace peclet::engine {
namespace {

// Durations of tenths of a second and of minutes: the engine polls its socket ten times a second.
const Json brief = small_scene({{"duration", {{"production", {{"time", 20}}}}}});
const Json endless = small_scene({{"duration", {{"production", {{"time", 20000}}}}}});

class Serving : public testing::Test {
 protected:
  Serving() {
    engine_ = std::thread([this] {
      status_ = serve(ends_[1]);
      shutdown(ends_[1], SHUT_RDWR);
    });
    hello_ = answer();
  }
  ~Serving() override {
    leave();
    for (const int end : ends_) close(end);
  }

  void leave() {
    shutdown(ends_[0], SHUT_RDWR);
    if (engine_.joinable()) engine_.join();
  }
  // Returns the next message other than progress, or null if the engine has left.
  Json answer() {
    for (Json message; runner_.receive(message, std::chrono::minutes(1)) == FrameChannel::Status::message;) {
      if (message.at("type") != "progress") return message;
    }
    return nullptr;
  }
  void expect_answer(const char* type, int job) {
    const Json message = answer();
    ASSERT_TRUE(message.is_object());
    EXPECT_EQ(message.at("type"), type) << message;
    EXPECT_EQ(message.at("job"), job);
  }
  void give(int job, const Json& scene) {
    runner_.send({{"type", "job"},
                  {"job", job},
                  {"point", std::string(64, 'a')},
                  {"seed", 100 + job},
                  {"scene", scene},
                  {"checkpoint", checkpoint(job).string()},
                  {"progress_seconds", 0},
                  {"spool", spool(job).string()}});
  }
  void wait_for_progress() {
    Json message;
    ASSERT_EQ(runner_.receive(message, std::chrono::minutes(1)), FrameChannel::Status::message);
    ASSERT_EQ(message.at("type"), "progress");
  }
  void drain() { runner_.send({{"type", "drain"}}); }
  // Leaves; the job that ran has a checkpoint, the one that waited has none.
  void expect_to_leave_one_checkpoint() {
    leave();
    EXPECT_EQ(status_, 0);
    EXPECT_TRUE(std::filesystem::exists(checkpoint(1)));
    EXPECT_FALSE(std::filesystem::exists(checkpoint(2)));
  }

  std::filesystem::path checkpoint(int job) const { return folder_ / ("checkpoint-" + std::to_string(job)); }
  std::filesystem::path spool(int job) const { return folder_ / ("spool-" + std::to_string(job)); }

  static std::array<int, 2> connected() {
    std::array<int, 2> ends{};
    if (socketpair(AF_UNIX, SOCK_STREAM, 0, ends.data()) != 0) throw std::runtime_error("socketpair");
    return ends;
  }

  TemporaryFolder folder_;
  const std::array<int, 2> ends_ = connected();
  FrameChannel runner_{ends_[0]};
  std::thread engine_;
  int status_ = -1;
  Json hello_;
};

TEST_F(Serving, BeginsTheJobThatWaitsWhenTheOtherHasEnded) {
  EXPECT_EQ(hello_.at("ahead"), true);
  give(1, brief);
  wait_for_progress();
  give(2, brief);
  for (const int job : {1, 2}) {
    expect_answer("result", job);
    EXPECT_EQ(Json::parse(read_file(spool(job))).at("seed"), 100 + job);
  }
}

TEST_F(Serving, ADrainGivesUpTheJobThatWaitsWithoutAWord) {
  give(1, endless);
  wait_for_progress();
  give(2, endless);
  drain();
  expect_answer("drained", 1);
  drain();
  EXPECT_TRUE(answer().is_null());
  expect_to_leave_one_checkpoint();
}

TEST_F(Serving, ARunnerThatIsGoneWantsNoJobThatWaits) {
  give(1, endless);
  wait_for_progress();
  give(2, endless);
  expect_to_leave_one_checkpoint();
}

TEST_F(Serving, AThirdJobIsOneTooMany) {
  give(1, endless);
  wait_for_progress();
  give(2, endless);
  give(3, endless);
  const Json message = answer();
  EXPECT_EQ(message.at("type"), "failed");
  EXPECT_EQ(message.at("job"), 1);
  EXPECT_TRUE(contains(message.at("message"), "another one waits"));
  wait_for_progress();  // of the second job
  drain();
  expect_answer("drained", 2);
}

}  // namespace
}  // namespace peclet::engine
