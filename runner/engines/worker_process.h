// The real worker pool: engines as child processes, one poll() loop, no threads.
#pragma once

#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "contract/frames.h"
#include "runner/engines/engine_process.h"
#include "runner/engines/stop_signals.h"
#include "runner/engines/worker_pool.h"
#include "runner/store/campaign_directory.h"
#include "runner/store/rotating_file.h"

namespace peclet::runner {

// Allows this process as many open files as so many workers take. Throws InputError when the system does not.
void allow_open_files(int workers);

class ProcessPool : public WorkerPool {
 public:
  // `signals` must outlive the pool. From now on this process ignores SIGPIPE, and so do its engines.
  ProcessPool(int workers, EngineCommand command, CampaignDirectory directory, StopSignals& signals);
  // Hangs up on all workers: those that still run checkpoint and leave, or are killed after some seconds.
  ~ProcessPool() override;

  int size() const override { return static_cast<int>(workers_.size()); }
  void start(int worker) override;
  std::int64_t process(int worker) const override;
  void assign(int worker, const Job& job) override;
  void drain(int worker) override;
  void kill(int worker) override;
  bool is_stopped(int worker) const override;
  std::vector<WorkerEvent> wait(std::chrono::milliseconds patience) override;

 private:
  struct Worker {
    EngineProcess process;
    FrameDecoder decoder{largest_answer};
    std::string unsent{};  // bytes that the socket did not take yet
    bool deaf = false;     // its socket has ended, or what it says no longer counts
    std::optional<std::chrono::steady_clock::time_point> grace{};  // then it is killed
  };

  void keep_what_is_printed();
  void send(int worker, const Json& message);
  void flush(Worker& worker);
  void receive(int number, std::vector<WorkerEvent>& events);
  void hear(int number, std::vector<WorkerEvent>& events);
  void reap(int number, std::vector<WorkerEvent>& events);

  EngineCommand command_;
  CampaignDirectory directory_;
  StopSignals& signals_;
  std::vector<std::unique_ptr<Worker>> workers_;
  std::vector<std::unique_ptr<RotatingFile>> logs_;  // by worker
  std::chrono::steady_clock::time_point logs_kept_{};
};

}  // namespace peclet::runner
