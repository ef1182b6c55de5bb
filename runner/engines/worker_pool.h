// What the dispatcher needs of workers: start one, give it a seed, hear what becomes of it.
//
// The real pool (worker_process.h) runs engines; tests put a scripted one in its place.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "contract/json.h"
#include "runner/campaign/paths.h"
#include "runner/store/blame.h"

namespace peclet::runner {

// One realisation as a worker is told about it.
struct Job {
  std::int64_t attempt = 0;  // names the job in frames
  std::string point;         // hash
  int seed = 0;
  Json scene;
  int threads = 1;
  fs::path checkpoint, spool, failures;
  double checkpoint_seconds = 60;
  double progress_seconds = 1;
};

// What a worker says or does. `worker` is its number, from 0.
struct Hello {
  int worker;
  Json engine;
  bool ahead = false;  // it takes one further job while it has one, and begins it after that
};
struct Progressed {
  int worker;
  std::int64_t job;
  int phase;  // 0 packing, 1 equilibration, 2 production
  std::int64_t step, steps;
  double strain;
};
// The phase as the frames spell it.
const char* phase_name(int phase);
struct ResultSpooled {
  int worker;
  std::int64_t job;
  fs::path spool;
  std::string sha256;
};
struct JobFailed {  // the engine could not run it at all
  int worker;
  std::int64_t job;
  std::string message;
};
struct Drained {
  int worker;
  std::int64_t job;
  std::int64_t step;
};
struct ShortOfRoom {  // could not write a file of its job, keeps its work and tries again
  int worker;
  std::int64_t job;
  fs::path path;
  std::uint64_t bytes;
};
struct Garbled {  // said something that is no message; it has been killed, Exited follows
  int worker;
  std::string message;
};
struct Exited {  // always the last one of a process
  int worker;
  ExitStatus ending;
};
struct StopSignal {};  // SIGINT or SIGTERM came

using WorkerEvent = std::variant<Hello, Progressed, ResultSpooled, JobFailed, Drained, ShortOfRoom, Garbled,
                                 Exited, StopSignal>;

class WorkerPool {
 public:
  virtual ~WorkerPool() = default;

  virtual int size() const = 0;
  // Starts the process of a worker that has none. Throws std::system_error when that is impossible.
  virtual void start(int worker) = 0;
  // Number of the worker's process; for people.
  virtual std::int64_t process(int worker) const = 0;
  // Requires that the worker said hello and has no job, or takes jobs ahead and has only one. A worker that
  // has died meanwhile will say Exited.
  virtual void assign(int worker, const Job& job) = 0;
  // Asks for a checkpoint; Drained (when it had a job) and Exited follow. A job that it has not begun is
  // given up without a word.
  virtual void drain(int worker) = 0;
  virtual void kill(int worker) = 0;
  // Whether its process is stopped (SIGSTOP), which is nobody's fault.
  virtual bool is_stopped(int worker) const = 0;

  // What happened, in order for each worker; waits for the first event, at most for `patience`.
  virtual std::vector<WorkerEvent> wait(std::chrono::milliseconds patience) = 0;
};

}  // namespace peclet::runner
