// PointSummary is what `status` shows of a point, from aggregates: no result is read.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "runner/campaign/campaign.h"
#include "runner/store/database.h"

namespace peclet::runner {

// Endings count how the seeds that judge a point have ended: the seeds of its last stop test, or all ended
// seeds before the first. Whether a point has jammed is decided here only.
struct Endings {
  int ended = 0;
  int jammed = 0;  // seeds with is_jam(), whether or not they have a value
  int lost = 0;    // seeds without a value for another reason

  // True if at least half of the ended seeds have jammed.
  bool has_jammed() const { return jammed > 0 && 2 * jammed >= ended; }
  // True if more than a tenth and less than half have jammed: means are of seeds that happened to flow.
  bool has_partly_jammed() const { return !has_jammed() && 10 * jammed > ended; }
};

struct PointSummary {
  PointRecord point;
  StateCounts counts;
  Endings endings;
  // Estimate of value + control from all seeds with a value.
  Estimate all_seeds;
  std::map<std::string, int> losses;  // seeds without a value, by cause
  // Reason in words, by cause, from the first seed that gives one.
  std::map<std::string, std::string> loss_reasons{};
  std::map<std::string, int> flags;  // completed seeds, by warning code
  std::vector<StopTest> stop_tests;  // for the present target
  // Seeds of the largest stop test for an earlier target, if it is beyond the deciding one.
  int earlier_stop_test = 0;
  double confidence = 0.95;                     // requested level
  std::vector<std::string> without_interval{};  // observables of the last stop test
  bool decided = false;
  bool waits = false;                 // for other points of its curve
  std::vector<SetAside> set_aside{};  // results of other engines
  int wanted = 0;                     // seeds of the next stop test, or of the deciding one
  int wanted_ended = 0;               // how many of these have ended
  double wanted_cpu_seconds = 0;      // processor time of the ended ones
  std::optional<StoredPrediction> prediction{};
  std::vector<LeaseRecord> leases;

  // True if neither decided nor cancelled.
  bool open() const { return !decided && !point.cancelled; }
  int lost() const { return counts.failed + counts.quarantined; }
  // Returns the ended seeds beyond the deciding stop test; 0 if the point is undecided.
  int extra() const { return decided ? counts.terminal() - wanted_ended : 0; }
};

// Returns {"ended", "jammed", "lost", "has_jammed"}.
Json to_json(const Endings& endings);

// Returns the points of the sweep, in its order.
std::vector<PointSummary> summarise_points(Database& database, const TargetRecord& target);
// Returns the cost and the estimates of the seeds of these points, for time_to_go().
std::vector<PointForecast> forecasts_of(Database& database, const std::vector<PointSummary>& points);

// Checks the stored stop tests for the present target by replaying them.
class StopTestCheck {
 public:
  // The database must outlive it, and must not change meanwhile.
  explicit StopTestCheck(Database& database);

  // Returns the last stop test at a point of the sweep; nothing before the first. Throws IntegrityError if
  // the stored stop tests do not follow from the stored results.
  std::optional<StopTest> last(const PointRecord& point);
  // Returns all stop tests that the stored results allow.
  std::vector<StopTest> replayed(const PointRecord& point);

 private:
  Database& database_;
  TargetRecord target_;
  std::vector<Curve> curves_;
  std::map<int, std::vector<StopTest>> of_curves_{};  // by place, once the curve has been replayed
};

// Queries of `peclet doctor` for contradictions in a database.
//
// Returns how many results of the point were deflated with another dictionary than the stored one.
int unreadable_results(Database& database, std::int64_t point);

// Returns the text of a stored result, or its bytes if it cannot be read; "" if the seed has no result.
std::string readable_result(Database& database, std::int64_t point, int seed);

struct StateFaults {
  std::int64_t unclaimed = 0;  // results of seeds that have not ended
  std::int64_t adrift = 0;     // leases without a running seed, running seeds without a lease
  std::int64_t running = 0;    // running seeds
};
StateFaults state_faults(Database& database);

struct ClockFaults {
  std::int64_t backwards = 0;  // events earlier than the one before
  std::int64_t negative = 0;   // attempts that end before they begin
  std::int64_t future = 0;     // events and attempts later than `now`
};
ClockFaults clock_faults(Database& database, const std::string& now);

}  // namespace peclet::runner
