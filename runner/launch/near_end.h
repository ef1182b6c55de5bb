// NearEnd is the end of a launched worker on the owner's machine.
#pragma once

#include <map>
#include <optional>

#include "runner/launch/carried_files.h"
#include "runner/launch/launched_worker.h"

namespace peclet::runner {

class NearEnd {
 public:
  // Starts the launcher. The owner's socket is standard input.
  explicit NearEnd(const WorkerOptions& options);
  // Returns, or ends this process, as run_worker().
  int run();

 private:
  using Clock = FrameLink::Clock;

  struct NearJob {
    CarriedJob paths;
    std::map<fs::path, bool> files{};  // those that were begun; true: the last one has come as a whole
  };

  void take_turn();
  void hear_owner();
  void take_job(const Json& frame);
  // Hears the far end until a piece of a file does not fit onto the disk.
  void hear_far_end();
  bool take(Json frame);
  bool take_piece(const Json& piece);
  NearJob& job_of(const Json& frame);
  void keep_in_touch();
  // Sends the owner what is left for it, waits for the launcher, and ends this process as the engine ended.
  [[noreturn]] void leave();
  void tell_owner();
  [[noreturn]] void lose(const std::string& why, bool is_nonsense = false);

  const WorkerOptions& options_;
  FrameLink owner_;
  PipedProgram launcher_;
  FrameLink far_;
  Outbox outbox_;  // for the far end
  Inbox inbox_;
  std::map<std::int64_t, NearJob> jobs_;
  std::optional<Json> waiting_;  // piece that did not fit onto the disk
  Clock::time_point retried_{}, said_carrying_ = Clock::now();
  std::optional<ExitStatus> ended_;        // the engine
  std::optional<Clock::time_point> left_;  // when the owner left
  bool is_ready_ = false;
};

}  // namespace peclet::runner
