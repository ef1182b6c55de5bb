// Seeds and the attempts at them: which are queued, which run and how far, and how each attempt ended.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "runner/store/blame.h"
#include "runner/store/database.h"
#include "runner/store/point_store.h"

namespace peclet::runner {

class SeedStore {
 public:
  // Requires a Database of open_owner, which must outlive it. recover() commits by itself; the others are for
  // use inside one Transaction of the caller, who so decides what becomes durable together.
  explicit SeedStore(Database& database)
      : database_(database), connection_(database.connection()), events_(connection_) {}

  // Puts the seeds that a dead owner left running back, without blame. Returns how many.
  int recover();

  // The seeds 0 .. end - 1 that are not known yet become queued.
  void enqueue(std::int64_t point, int end);
  // The seed runs; returns the attempt's number.
  std::int64_t begin_attempt(std::int64_t point, int seed, int worker, std::int64_t process,
                             std::int64_t engine);
  // An attempt that a batch system's node made, and that has ended; the seed's state is the caller's to
  // change.
  void attempt_elsewhere(std::int64_t point, int seed, int task, const AttemptReport& report);
  void renew_lease(std::int64_t attempt, const char* phase, std::int64_t step, std::int64_t steps,
                   double strain);
  void end_attempt(std::int64_t attempt, const AttemptEnd& end);
  // Attempts that count: not those from before a retry.
  std::vector<PastAttempt> history(std::int64_t point, int seed);
  bool has_ended(std::int64_t point, int seed);
  void requeue(std::int64_t point, int seed);
  void quarantine(std::int64_t point, int seed, const std::string& cause);

  // A seed that was given up is queued again, and its attempts no longer count against it. False: it was not.
  bool retry(std::int64_t point, int seed);

 private:
  std::int64_t add_attempt(std::int64_t point, int seed, int worker, std::int64_t process,
                           const std::string& host, std::int64_t engine, const std::string& started_at);

  Database& database_;
  Connection& connection_;
  EventStore events_;
};

}  // namespace peclet::runner
