// ScriptedPool is a worker pool without processes: the test says what its workers say.
#pragma once

#include <chrono>
#include <deque>
#include <functional>
#include <vector>

#include "runner/engines/worker_pool.h"

namespace peclet::runner {

class ScriptedPool : public WorkerPool {
 public:
  explicit ScriptedPool(int workers) : workers_(static_cast<std::size_t>(workers)) {}

  int size() const override { return static_cast<int>(workers_.size()); }
  void start(int worker) override;
  std::int64_t process(int worker) const override { return 1000 + worker; }
  void assign(int worker, const Job& job) override;
  void drain(int worker) override;
  void kill(int worker) override;
  bool is_stopped(int worker) const override { return stopped == worker; }
  // Returns the events said since the last call, after asking `script` for some if there are none. Time
  // passes by `patience` if there still are none.
  std::vector<WorkerEvent> wait(std::chrono::milliseconds patience) override;

  void say(WorkerEvent event) { said_.push_back(std::move(event)); }
  // The worker writes a result of its job at this place, announces it and begins the waiting job.
  void finish(int worker, double viscosity, std::size_t place = 0);
  // Writes a result without announcing it.
  void spool(const Job& job, double viscosity) const;
  // Begins the waiting job after another end of one.
  void begin_next(int worker, std::size_t place = 0);
  bool has_job(int worker) const { return !at(worker).jobs.empty(); }
  const Job& job(int worker) const { return at(worker).jobs.front(); }
  bool has_waiting(int worker) const { return at(worker).jobs.size() > capacity; }
  const Job& waiting(int worker) const { return at(worker).jobs.at(capacity); }
  // All jobs of the worker; one that waits is the last.
  const std::vector<Job>& jobs(int worker) const { return at(worker).jobs; }
  bool alive(int worker) const { return at(worker).alive; }

  // Called whenever the dispatcher waits and nothing has been said.
  std::function<void()> script;
  // Identity that every process says at its start.
  std::string identity = "engine";
  bool says_hello = true;
  bool takes_ahead = false;
  std::size_t capacity = 1;
  double wall_seconds = 4;  // wall time in its results [s]
  bool leaves_when_drained = true;
  std::size_t result_size = 0;  // letters beyond a plain result, others for each seed
  int stopped = -1;             // worker whose process is stopped

  std::chrono::steady_clock::time_point now{};  // the test's time
  int starts = 0;
  std::vector<Job> assigned;

 private:
  struct Worker {
    bool alive = false;
    std::vector<Job> jobs{};
  };
  const Worker& at(int worker) const { return workers_.at(static_cast<std::size_t>(worker)); }
  Worker& at(int worker) { return workers_.at(static_cast<std::size_t>(worker)); }

  std::vector<Worker> workers_;
  std::deque<WorkerEvent> said_;
};

}  // namespace peclet::runner
