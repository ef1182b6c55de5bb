// SIGINT, SIGTERM and SIGHUP (the terminal or connection is gone) as something to poll for.
#pragma once

#include <chrono>
#include <csignal>

namespace peclet::runner {

// From construction to destruction these signals (and one more, when it is given) are blocked in this thread
// and read from a descriptor instead. Threads that are started meanwhile inherit that. SIGHUP is left alone
// where it is ignored, as under nohup.
class StopSignals {
 public:
  explicit StopSignals(int one_more = SIGTERM);
  ~StopSignals();
  StopSignals& operator=(StopSignals&&) = delete;
  int descriptor() const { return descriptor_; }
  // Takes one signal that has come, if any.
  bool take();
  // Waits for one at most so long, and takes it.
  bool wait(std::chrono::milliseconds patience);

 private:
  sigset_t stopping_{};
  int descriptor_ = -1;
};

}  // namespace peclet::runner
