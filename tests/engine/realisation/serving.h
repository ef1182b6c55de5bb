// Plays the runner of an engine that serves in a thread.
#pragma once

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <thread>

#include "contract/durable_file.h"
#include "contract/frames.h"
#include "engine/realisation/serve.h"
#include "tests/engine/realisation/small_result.h"
#include "tests/engine/temporary_folder.h"

namespace peclet::engine {

// Durations of tenths of a second and of minutes: the engine polls its socket ten times a second.
inline const Json brief = small_scene({{"duration", {{"production", {{"time", 20}}}}}});
inline const Json endless = small_scene({{"duration", {{"production", {{"time", 20000}}}}}});

class Serving : public testing::Test {
 protected:
  explicit Serving(Ensemble* ensemble = nullptr, Device device = Device::automatic) {
    engine_ = std::thread([this, ensemble, device] {
      status_ = serve(ends_[1], ensemble, device);
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
  Json message_of(int job, const Json& scene) const {
    return {{"type", "job"},
            {"job", job},
            {"point", std::string(64, 'a')},
            {"seed", 100 + job},
            {"scene", scene},
            {"checkpoint", checkpoint(job).string()},
            {"progress_seconds", 0},
            {"spool", spool(job).string()}};
  }
  void give(int job, const Json& scene) { runner_.send(message_of(job, scene)); }
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

}  // namespace peclet::engine
