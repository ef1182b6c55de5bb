// The interface of a pool of workers, through which the dispatcher starts them and gives them seeds.
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

// One realisation, as it is given to a worker.
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

// Events of workers. `worker` is the number of the worker, from 0.
struct Hello {
  int worker;
  Json engine;
  bool ahead = false;  // takes one job more than it runs, and begins it when one has ended
  int capacity = 1;    // jobs that it runs at once
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
struct ShortOfRoom {  // it could not write a file of its job, keeps its work and tries again
  int worker;
  std::int64_t job;
  fs::path path;
  std::uint64_t bytes;
};
struct Carrying {  // files of the job are coming from another machine
  int worker;
  std::int64_t job;
};
struct Lost {  // its part on another machine, or the link to it, is gone
  int worker;
  std::string message;
  std::string cause;  // link, nonsense, no-room
};
struct Garbled {  // it sent something that is not a message and has been killed; Exited follows
  int worker;
  std::string message;
};
struct Exited {  // the last event of a process
  int worker;
  ExitStatus ending;
};
struct StopSignal {};  // SIGINT or SIGTERM came

using WorkerEvent = std::variant<Hello, Progressed, ResultSpooled, JobFailed, Drained, ShortOfRoom, Carrying,
                                 Lost, Garbled, Exited, StopSignal>;

class WorkerPool {
 public:
  virtual ~WorkerPool() = default;

  virtual int size() const = 0;
  // Starts the process of a worker that has none. Throws std::system_error if that fails.
  virtual void start(int worker) = 0;
  // Returns the number of the worker's process, for messages.
  virtual std::int64_t process(int worker) const = 0;
  // Gives the worker a job. Requires that the worker said hello and has fewer jobs than its capacity, or
  // takes jobs ahead and has no more than that. If the worker has died meanwhile, Exited follows.
  virtual void assign(int worker, const Job& job) = 0;
  // Tells the worker to save checkpoints and exit; Drained (for each job) and Exited follow. A further job
  // that has not begun is dropped without an event.
  virtual void drain(int worker) = 0;
  virtual void kill(int worker) = 0;
  // True if the worker's process is stopped, as by SIGSTOP.
  virtual bool is_stopped(int worker) const = 0;

  // Waits at most `patience` for an event, and returns all events, those of each worker in order.
  virtual std::vector<WorkerEvent> wait(std::chrono::milliseconds patience) = 0;
};

}  // namespace peclet::runner
