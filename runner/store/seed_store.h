// SeedStore records seeds and the attempts at them: which are queued, which run and how far, and how each
// attempt ended.
#pragma once

#include <compare>
#include <cstdint>
#include <string>
#include <vector>

#include "runner/store/blame.h"
#include "runner/store/database.h"
#include "runner/store/point_store.h"

namespace peclet::runner {

struct KnownSeed {
  std::int64_t point = 0;  // PointRecord::id
  int seed = 0;
  auto operator<=>(const KnownSeed&) const = default;
};

class SeedStore {
 public:
  // Requires a Database of open_owner(), which must outlive it. recover() commits by itself. The others are
  // for use inside a Transaction of the caller, who decides what becomes durable together.
  explicit SeedStore(Database& database)
      : database_(database), connection_(database.connection()), events_(connection_) {}

  // Queues again the seeds that a dead owner left running, without blame. Returns how many.
  int recover();

  // Queues the seeds 0 .. end - 1 that are not known yet.
  void enqueue(std::int64_t point, int end);
  // Marks the seed as running. Returns the attempt's number.
  std::int64_t begin_attempt(std::int64_t point, int seed, int worker, std::int64_t process,
                             std::int64_t engine);
  // Stores an ended attempt of a batch system's node. The caller changes the seed's state.
  void attempt_elsewhere(std::int64_t point, int seed, int task, const AttemptReport& report);
  void renew_lease(std::int64_t attempt, const char* phase, std::int64_t step, std::int64_t steps,
                   double strain);
  void end_attempt(std::int64_t attempt, const AttemptEnd& end);
  // Returns the attempts that count, without those made before a retry.
  std::vector<PastAttempt> history(std::int64_t point, int seed);
  // Returns the seeds that have not ended and were in an engine when it died or was killed.
  std::vector<KnownSeed> seeds_with_deaths();
  bool has_ended(std::int64_t point, int seed);
  void requeue(std::int64_t point, int seed);
  void quarantine(std::int64_t point, int seed, const std::string& cause);

  // Queues a given-up seed again; its attempts no longer count against it. Returns false if it was not given
  // up.
  bool retry(std::int64_t point, int seed);

 private:
  std::int64_t add_attempt(std::int64_t point, int seed, int worker, std::int64_t process,
                           const std::string& host, std::int64_t engine, const std::string& started_at);

  Database& database_;
  Connection& connection_;
  EventStore events_;
};

}  // namespace peclet::runner
