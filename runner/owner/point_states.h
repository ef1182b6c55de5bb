// Where every point of a running campaign stands: its record, the scheduler's picture, what its seeds cost
// and how many of them workers have. In memory only; the state keeps it in step with the database.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "runner/campaign/campaign.h"
#include "runner/statistics/forecast.h"
#include "runner/statistics/scheduler.h"
#include "runner/store/database.h"

namespace peclet::runner {

// What bounds a run beside the campaign itself.
struct Bounds {
  std::optional<int> ceiling{};            // only so many seeds of each point
  std::optional<double> budget_seconds{};  // processor time
  std::map<std::string, double> work{};    // of a realisation, in any unit, by the point's hash
};

constexpr int nowhere = -1;

class PointStates {
 public:
  // Reads the records of the points in the sweep, without what their seeds did.
  void read_points(Database& database);
  // Reads what the seeds did and which of them workers have, and makes the scheduler's picture from it. Seeds
  // in the hands of a batch system are then to be begun. Requires read_points().
  void read_seeds(Database& database, const Campaign& campaign);
  // Whether read_seeds() has been called.
  bool has_seeds() const { return scheduler_.has_value(); }

  // From now on, also after the next read_seeds().
  void set_bounds(Bounds bounds);
  const Bounds& bounds() const { return bounds_; }

  int size() const { return static_cast<int>(points_.size()); }
  const std::vector<PointRecord>& points() const { return points_; }
  const PointRecord& point(int place) const { return points_.at(static_cast<std::size_t>(place)); }
  // Nothing for a point that is not in the sweep.
  std::optional<int> place_of(const std::string& hash) const;
  std::optional<int> place_of(std::int64_t point_id) const;
  bool is_to_be_run(const PointRecord& about) const {
    return !scheduler_->decided(*about.place) && !about.cancelled;
  }

  Scheduler& scheduler() { return *scheduler_; }
  const Scheduler& scheduler() const { return *scheduler_; }

  // A seed of the point has ended that took so long; the scheduler hears of the new mean.
  void add_cost(int place, double wall_seconds, double cpu_seconds);
  // Mean wall time of the point's seeds; nothing while there are none.
  std::optional<double> wall_seconds(int place) const;
  // A worker has the seed from now on, and then no more.
  void begin(SeedId id);
  void leave(SeedId id) { --running_[static_cast<std::size_t>(id.point)]; }
  // Processor seconds that the seeds which workers have are expected to cost.
  double expected_seconds() const { return scheduler_->expected_seconds(running_); }
  // `unfinished`: as Database::unfinished().
  const std::vector<PointForecast>& forecasts(std::map<std::int64_t, std::vector<Unfinished>> unfinished);

 private:
  void tell_cost(int place);
  void apply_bounds();

  std::vector<PointRecord> points_;
  std::map<std::string, int> places_;  // by hash
  std::optional<Scheduler> scheduler_;
  std::vector<Cost> processor_;           // of the seeds of each point
  std::vector<PointForecast> forecasts_;  // of each point, with its cost on the wall
  std::vector<int> running_;
  Bounds bounds_;
  int maximum_ = 0;  // realisations of a point
};

}  // namespace peclet::runner
