// Everything that is written to the campaign's database: seeds, attempts, leases, results, looks, events.
//
// Requires a Database of open_owner. adopt() and recover() commit by themselves; the other writing functions
// are for use inside one Transaction of the caller, who so decides what becomes durable together. What people
// ask for is in queue_requests.cpp.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "runner/database/database.h"
#include "runner/engines/blame.h"
#include "runner/folder/realisation_result.h"

namespace peclet::runner {

struct AttemptReport;  // attempt_report.h

struct AttemptEnd {
  AttemptOutcome outcome = AttemptOutcome::result;
  std::int64_t step = 0;
  ExitStatus ending{};
  std::string message{};
  double held_seconds = 0;  // processor time at most: that it lasted, times its threads
};

// What became of a result that was offered.
enum class Stored {
  stored,
  stored_apart,  // in the row of an engine that another one has replaced, now or before: no part of the
                 // campaign
  duplicate,     // the seed has this very content already
  conflict,      // the seed has another content: the point is now suspect
  mixed_engine,  // the point has results of another engine
  unknown_point
};

class Queue {
 public:
  explicit Queue(Database& database) : database_(database), connection_(database.connection()) {}

  // Makes the database that of `campaign`: its points in their order, its target. Points that are no longer
  // in the sweep stay, inactive. Throws InputError, with nothing written, when finished realisations lack the
  // observable.
  void adopt(const Campaign& campaign);
  // The same within the caller's transaction, which is to be rolled back when it throws.
  void take_over(const Campaign& campaign);
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

  // One without a number for the observable is lost with the cause no_value.
  Stored store(const RealisationResult& result, const std::string& observable);
  void store_looks(std::int64_t point, const std::vector<Look>& looks);
  void set_priority(std::int64_t point, int priority);
  void set_cancelled(std::int64_t point, bool cancelled);
  // A seed that was given up is queued again, and its attempts no longer count against it. False: it was not.
  bool retry(std::int64_t point, int seed);
  // The point's results stay as they are, but no longer are the campaign's: a row of its own takes its place
  // in the sweep, that of `engine` when there has been one.
  void keep_apart(const PointRecord& point, const std::string& engine);

  // The engine's row, new when it was never seen before.
  std::int64_t engine(const Json& provenance);
  // `request`: the name of the request that caused it, "" when none did.
  void event(const std::string& kind, std::optional<std::int64_t> point, std::optional<int> seed,
             const std::string& message, const std::string& request = "");
  // Whether the request has been carried out, or refused.
  bool has_answered(const std::string& request);

 private:
  std::int64_t adopt_target(const Campaign& campaign);
  void adopt_points(const Campaign& campaign);
  void observe_again(const Campaign& campaign);
  void store_numbers(std::int64_t point, const RealisationResult& result, const std::string& observable,
                     std::int64_t engine);

  Database& database_;
  Connection& connection_;
};

}  // namespace peclet::runner
