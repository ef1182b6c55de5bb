// All that `status` shows of a point, from aggregates: no result is read, however many there are.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "runner/store/database.h"

namespace peclet::runner {

// How the seeds that a point is judged by have ended: those of its last stop test; before the first one, all
// that have ended. Whether a point has jammed is said here and nowhere else.
struct Endings {
  int ended = 0;
  int jammed = 0;  // is_jam(), with a result or without
  int lost = 0;    // without a value, for another reason

  // Whether half of the seeds that have ended have jammed, or more.
  bool has_jammed() const { return jammed > 0 && 2 * jammed >= ended; }
  // Whether more than a tenth have jammed, and less than half: means are of seeds that happened to flow.
  bool has_partly_jammed() const { return !has_jammed() && 10 * jammed > ended; }
};

struct PointSummary {
  PointRecord point;
  StateCounts counts;
  Endings endings;
  // Of value + control, over all seeds that have ended with a value, in whatever order they came.
  Estimate all_seeds;
  std::map<std::string, int> losses;  // seeds by cause
  // Why, in words, by cause: of the first seed of which it is known.
  std::map<std::string, std::string> loss_reasons{};
  std::map<std::string, int> flags;  // completed seeds by what they say against themselves
  std::vector<StopTest> stop_tests;  // for the present target
  int earlier_stop_test =
      0;  // seeds of the largest look for an earlier target, if it is beyond the deciding one
  double confidence = 0.95;                     // that was asked for
  std::vector<std::string> without_interval{};  // observables of the last stop test
  bool decided = false;
  std::vector<SetAside> set_aside{};  // results of other engines
  int wanted = 0;                 // seeds of the next stop test; of a decided point those of the deciding one
  int wanted_ended = 0;           // of these, how many have ended
  double wanted_cpu_seconds = 0;  // that these took
  std::optional<StoredPrediction> prediction{};
  std::vector<LeaseRecord> leases;

  // Neither decided nor cancelled.
  bool open() const { return !decided && !point.cancelled; }
  int lost() const { return counts.failed + counts.quarantined; }
  // Seeds of a decided point that have ended beyond the deciding stop test.
  int extra() const { return decided ? counts.terminal() - wanted_ended : 0; }
};

// {"ended", "jammed", "lost", "has_jammed"}
Json to_json(const Endings& endings);

// The points of the sweep, in its order.
std::vector<PointSummary> summarise_points(Database& database, const TargetRecord& target);
// Returns what the seeds of these points have cost and said so far, for time_to_go().
std::vector<PointForecast> forecasts_of(Database& database, const std::vector<PointSummary>& points);

// The last stop test at a point for the present target, checked by replaying it; nothing before the first.
// Throws IntegrityError when stored stop tests are not what the stored results say.
std::optional<StopTest> checked_stop_test(Database& database, const PointRecord& point,
                                          const TargetRecord& target);

// Queries of `peclet doctor`: what in a database contradicts itself.
//
// Returns how many results of the point were deflated with another dictionary than the one that is there.
int unreadable_results(Database& database, std::int64_t point);

// Returns the text of a stored result, or its bytes if it cannot be read; "" for a seed without one.
std::string readable_result(Database& database, std::int64_t point, int seed);

struct StateFaults {
  std::int64_t unclaimed = 0;  // results of seeds that have not ended
  std::int64_t adrift = 0;     // leases and running seeds that do not belong together
  std::int64_t running = 0;    // seeds that run
};
StateFaults state_faults(Database& database);

struct ClockFaults {
  std::int64_t backwards = 0;  // events that are earlier than the one before
  std::int64_t negative = 0;   // attempts that end before they begin
  std::int64_t future = 0;     // events and attempts after `now`
};
ClockFaults clock_faults(Database& database, const std::string& now);

}  // namespace peclet::runner
