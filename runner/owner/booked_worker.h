// BookedWorker is a worker with its jobs, as the dispatcher has booked them.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <vector>

#include "runner/engines/worker_process.h"
#include "runner/owner/campaign_state.h"

namespace peclet::runner {

struct Assignment {
  using Time = std::chrono::steady_clock::time_point;

  std::int64_t job() const { return given_seed.job.attempt; }

  GivenSeed given_seed;
  Time given{};                // when the worker got it
  Time begun{};                // when the worker could begin it: it had a place free
  bool shown = false;          // the database has its latest progress
  bool lost_a_folder = false;  // a folder into which it writes was deleted
};

struct BookedWorker {
  WorkerWatch watch{};
  std::int64_t engine = 0;
  bool takes_ahead = false;
  int capacity = 1;
  std::vector<Assignment> running{};     // those that `watch` has, at most `capacity`
  std::optional<Assignment> waiting{};   // job behind those
  std::vector<std::int64_t> finished{};  // last attempts that ended, as many as the capacity

  // True if the worker may get a job, which it then begins.
  bool has_place() const { return watch.takes_jobs() && watch.jobs() < capacity; }
  // True if the worker may get a job that then waits.
  bool takes_one_ahead() const {
    return takes_ahead && !waiting && watch.takes_jobs() && watch.jobs() == capacity;
  }
  // Returns the job that the worker runs, or null.
  Assignment* find(std::int64_t job);
  bool has_finished(std::int64_t job) const;
  void begin(Assignment about, Awake now);
  // Ends a job that the worker runs; the waiting job begins in its place.
  void end(std::int64_t job, Awake now, Assignment::Time time);
  // Returns the company of the next job.
  Company company() const;
  void mark_lost_folders();
};

}  // namespace peclet::runner
