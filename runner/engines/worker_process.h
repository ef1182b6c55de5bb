// The real worker pool: engines as child processes, one poll() loop, no threads.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "contract/frames.h"
#include "runner/campaign/paths.h"
#include "runner/engines/engine_process.h"
#include "runner/engines/worker_pool.h"
#include "runner/store/blame.h"
#include "runner/store/campaign_directory.h"
#include "runner/store/rotating_file.h"

namespace peclet::runner {

// Returns the cores of the affinity mask (taskset, Slurm's cpusets), or fewer where a control group limits
// processor time to fewer; at least 1.
int usable_cores();

// The processor time, in cores, to which the control groups limit a process whose /proc/self/cgroup reads
// `groups`, below `root`, where they are mounted (/sys/fs/cgroup); nothing if they do not.
std::optional<double> core_quota(const fs::path& root, const std::string& groups);

// Time during which this process ran. Leases and patience are measured in it: an owner that was stopped, or
// frozen together with its workers, has heard nothing meanwhile and must not hold that against them.
using Awake = std::chrono::duration<double>;

class AwakeClock {
 public:
  using Time = std::chrono::steady_clock::time_point;

  AwakeClock(Time now, Awake lease) : lease_(lease), heard_(now) {}

  // A turn has ended: all news has been fetched, so it is never older than the time by which it is judged. A
  // turn of more than a second, or of more than half a lease, counts as no more: the process stood still.
  void end_turn(Time now);

  Awake awake() const { return awake_; }
  // The end of the last turn.
  Time heard() const { return heard_; }

 private:
  Awake lease_, awake_{};
  Time heard_;
};

// How an attempt ended, and why, for people.
struct AttemptReason {
  AttemptOutcome outcome = AttemptOutcome::result;
  std::string message{};
};

// How far a realisation is.
struct JobProgress {
  int phase = 0;  // as in Progressed
  std::int64_t step = 0, steps = 0;
  double strain = 0;
};

// One worker as its owner sees it: started, greeted, busy with a job; and when the owner's patience with it
// ends. Pure: it is told what happened and at what time, and says what follows. The dispatcher and the task
// of a batch system judge their workers by it.
class WorkerWatch {
 public:
  bool is_there() const { return stage_ != Stage::absent; }
  bool is_starting() const { return stage_ == Stage::starting; }
  // And fit for a job: not one that is being killed.
  bool is_idle() const { return stage_ == Stage::idle && !condemned_; }
  bool is_busy() const { return stage_ == Stage::busy; }

  // Its process was started. Whatever was known of an earlier one is forgotten.
  void start(Awake now);
  // It said hello, or has no job any more.
  void rest(Awake now);
  // It has a job from now on.
  void begin_job(Awake now);
  // Takes down how far the job is. A new step renews the lease; being alive does not.
  void hear(const Progressed& progress, Awake now);
  // Renews the lease without a step: the worker waits for something that is not its fault.
  void renew(Awake now) { renewed_ = now; }
  // It gave its job back at that step.
  void leave_at(std::int64_t step) { progress_.step = step; }
  // It has been told to leave its job.
  void recall() { is_recalled_ = true; }
  // It has been killed by the owner, for that reason. The first reason stays.
  void condemn(AttemptReason reason);

  bool is_recalled() const { return is_recalled_; }
  const std::optional<AttemptReason>& condemned() const { return condemned_; }
  const JobProgress& progress() const { return progress_; }

  // Whether no new step came for longer than `lease`, or no hello for a minute.
  bool is_overdue(Awake now, Awake lease) const;
  // What an overdue worker is condemned for. A process that was stopped (SIGSTOP), or was told to leave, is
  // not blamed.
  AttemptReason overdue(Awake lease, bool is_stopped) const;
  // How the attempt ended whose process has ended in this way. `all_recalled`: every worker has been told to
  // leave.
  AttemptReason ended(const ExitStatus& ending, bool all_recalled) const;

 private:
  enum class Stage { absent, starting, idle, busy };

  Stage stage_ = Stage::absent;
  Awake since_{}, renewed_{};
  JobProgress progress_;
  bool is_recalled_ = false;
  std::optional<AttemptReason> condemned_;
};

// Returns the first folder into which an engine writes for its job that is not there or has no room; nothing
// if it can write in all of them. An engine that does not know how to wait for room may crash or give up
// instead, which is not its fault.
std::optional<fs::path> unwritable_folder(const Job& job);

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
