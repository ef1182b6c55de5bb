// The real worker pool: engines as child processes, one poll() loop, no threads.
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
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

// Returns the number of cores in the affinity mask (taskset, Slurm's cpusets), or fewer if a control group or
// the job of a batch system has fewer; at least 1.
int usable_cores();

// Returns the cores on this node of the job of Slurm, PBS, LSF or Grid Engine in which this process runs, by
// the variables of that system; nothing outside of a job.
std::optional<int> cores_of_job();

// Returns the limit of processor time by control groups [cores], if any. `groups` is the text of the
// process's /proc/self/cgroup; `root` is where control groups are mounted (/sys/fs/cgroup).
std::optional<double> core_quota(const fs::path& root, const std::string& groups);

// Time during which this process ran [s]. Leases are measured in it, because an owner that was stopped, or
// frozen together with its workers, receives no messages meanwhile.
using Awake = std::chrono::duration<double>;

class AwakeClock {
 public:
  using Time = std::chrono::steady_clock::time_point;

  AwakeClock(Time now, Awake lease) : lease_(lease), heard_(now) {}

  // Adds the time of a turn that has ended, after all messages have been fetched. A turn counts for one
  // second or half a lease at most, because the process was stopped during a longer one.
  void end_turn(Time now);

  Awake awake() const { return awake_; }
  // The end of the last turn.
  Time heard() const { return heard_; }

 private:
  Awake lease_, awake_{};
  Time heard_;
};

struct AttemptReason {
  AttemptOutcome outcome = AttemptOutcome::result;
  std::string message{};
  std::int64_t job = 0;  // job that did it; 0 if that is not known
};

// Returns how a job ended with its engine, which had `others` beside it and died for this reason. In company
// it is not blamed unless it is known to have done it; then the others are not suspect.
AttemptEnd end_with_engine(const AttemptReason& how, const ExitStatus& ending, std::int64_t job, int others);

struct JobProgress {
  int phase = 0;  // as in Progressed
  std::int64_t step = 0, steps = 0;
  double strain = 0;
};

// The stage of one worker and the progress of its jobs, as its owner knows them, and whether the worker is
// overdue. It has no clock and no process, but is told events and their times. The dispatcher and the tasks
// of a batch system use it.
class WorkerWatch {
 public:
  bool is_there() const { return stage_ != Stage::absent; }
  bool is_starting() const { return stage_ == Stage::starting; }
  // True if the worker may get jobs: it has said hello, and is neither being killed nor told to leave.
  bool takes_jobs() const { return stage_ == Stage::ready && !condemned_ && !is_recalled_; }
  bool is_busy() const { return !jobs_.empty(); }
  // Returns the number of jobs that the worker runs.
  int jobs() const { return static_cast<int>(jobs_.size()); }

  // Records that the process was started, and how long its hello may take; forgets all about an earlier one.
  void start(Awake now, Awake hello_patience = Awake{60});
  // Records that the worker said hello.
  void greet() { stage_ = Stage::ready; }
  void begin_job(std::int64_t job, Awake now) { jobs_[job] = {now, {}}; }
  void end_job(std::int64_t job) { jobs_.erase(job); }
  // Records the progress of a job that it has. A new step renews the lease; a message without one does not.
  void hear(const Progressed& progress, Awake now);
  // Renews the leases without a step, because the worker waits for something that is not its fault.
  void renew(Awake now);
  // Records that the worker gave the job back at that step.
  void leave_at(std::int64_t job, std::int64_t step) { jobs_.at(job).progress.step = step; }
  // Records that the worker was told to leave its jobs.
  void recall() { is_recalled_ = true; }
  // Records that the owner has killed the worker for that reason. The first reason stays.
  void condemn(AttemptReason reason);

  bool is_recalled() const { return is_recalled_; }
  const std::optional<AttemptReason>& condemned() const { return condemned_; }
  const JobProgress& progress(std::int64_t job) const { return jobs_.at(job).progress; }

  // True if a job made no new step for longer than `lease`, or no hello came in time.
  bool is_overdue(Awake now, Awake lease) const;
  // Returns the reason to kill an overdue worker. One that is stopped (SIGSTOP) or recalled is not to blame.
  AttemptReason overdue(Awake lease, bool is_stopped) const;
  // Returns the outcome of attempts whose process has ended. `all_recalled`: all workers were recalled.
  AttemptReason ended(const ExitStatus& ending, bool all_recalled) const;

 private:
  enum class Stage { absent, starting, ready };
  struct Course {
    Awake renewed{};
    JobProgress progress{};
  };
  // Returns the course of the job that has made no step for longest. Requires a job.
  const Course& slowest() const;

  Stage stage_ = Stage::absent;
  Awake started_{}, hello_patience_{};
  std::map<std::int64_t, Course> jobs_;
  bool is_recalled_ = false;
  std::optional<AttemptReason> condemned_;
};

// Returns true if an engine may write this file for the job.
bool is_file_of(const Job& job, const fs::path& path);

// Returns the first folder of a job that does not exist or has no room, if any. An engine that cannot wait
// for room may then fail, and is not to blame.
std::optional<fs::path> unwritable_folder(const Job& job);

// Raises this process's limit of open files to the need of `workers` workers. Throws InputError if it cannot.
void allow_open_files(int workers);

class ProcessPool : public WorkerPool {
 public:
  // One worker for each command. `signals` must outlive the pool. From now on this process ignores SIGPIPE,
  // and so do its engines.
  ProcessPool(std::vector<EngineCommand> commands, CampaignDirectory directory, StopSignals& signals);
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
    bool deaf = false;     // its socket has ended, or its messages no longer count
    std::optional<std::chrono::steady_clock::time_point> grace{};  // time after which it is killed
  };

  void keep_what_is_printed();
  void send(int worker, const Json& message);
  void flush(Worker& worker);
  void receive(int number, std::vector<WorkerEvent>& events);
  void hear(int number, std::vector<WorkerEvent>& events);
  void reap(int number, std::vector<WorkerEvent>& events);

  std::vector<EngineCommand> commands_;  // one for each worker
  CampaignDirectory directory_;
  StopSignals& signals_;
  std::vector<std::unique_ptr<Worker>> workers_;
  std::vector<std::unique_ptr<RotatingFile>> logs_;  // one for each worker
  std::chrono::steady_clock::time_point logs_kept_{};
};

}  // namespace peclet::runner
