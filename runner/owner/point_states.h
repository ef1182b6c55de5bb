// PointStates holds the state of every point of a running campaign: its record, the scheduler, the cost of
// its seeds and the number of them that workers have. It is kept in memory only; CampaignState keeps it in
// step with the database.
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

// Bounds of a run beside those of the campaign.
struct Bounds {
  std::optional<int> ceiling{};            // most seeds of each point
  std::optional<double> budget_seconds{};  // processor time
  std::map<std::string, double> work{};    // work of one realisation, in any unit, by hash of the point
};

constexpr int nowhere = -1;

class PointStates {
 public:
  // Reads the records of the points in the sweep, without their seeds.
  void read_points(Database& database);
  // Reads outcomes, costs and running seeds, and makes the scheduler from them. The caller then begins the
  // seeds that a batch system has. Requires read_points().
  void read_seeds(Database& database, const Campaign& campaign);
  // True once read_seeds() has been called.
  bool has_seeds() const { return scheduler_.has_value(); }

  // Sets the bounds from now on, also after the next read_seeds().
  void set_bounds(Bounds bounds);
  const Bounds& bounds() const { return bounds_; }

  int size() const { return static_cast<int>(points_.size()); }
  const std::vector<PointRecord>& points() const { return points_; }
  const PointRecord& point(int place) const { return points_.at(static_cast<std::size_t>(place)); }
  // Returns nothing if the point is not in the sweep.
  std::optional<int> place_of(const std::string& hash) const;
  std::optional<int> place_of(std::int64_t point_id) const;
  bool is_to_be_run(const PointRecord& about) const {
    return !scheduler_->decided(*about.place) && !about.cancelled;
  }

  Scheduler& scheduler() { return *scheduler_; }
  const Scheduler& scheduler() const { return *scheduler_; }

  // Adds the cost of a seed of the point that has ended, and tells the scheduler the new mean.
  void add_cost(int place, double wall_seconds, double cpu_seconds);
  // Returns the mean wall time [s] of the point's ended seeds, if there are any.
  std::optional<double> wall_seconds(int place) const;
  // begin() counts the seed as held by a worker, leave() as no longer held.
  void begin(SeedId id);
  void leave(SeedId id) { --running_[static_cast<std::size_t>(id.point)]; }
  // Returns the processor time [s] that the seeds that workers have are expected to cost.
  double expected_seconds() const { return scheduler_->expected_seconds(running_); }
  // Returns the time to go; `unfinished` is as in Database::unfinished().
  std::optional<TimeToGo> to_go(std::map<std::int64_t, std::vector<Unfinished>> unfinished,
                                const Campaign& campaign, int workers);

 private:
  void tell_cost(int place);
  // Returns where each point is expected to stop. On curves this takes up to a second, and is done again
  // after stop tests only.
  const std::vector<Expected<int>>& expected_stops(const Campaign& campaign);
  void apply_bounds();

  std::vector<PointRecord> points_;
  std::map<std::string, int> places_;  // by hash
  std::optional<Scheduler> scheduler_;
  std::vector<Cost> processor_;           // processor time of the seeds, for each point
  std::vector<PointForecast> forecasts_;  // for each point, with its cost in wall time
  std::vector<int> running_;              // seeds that workers have, for each point
  std::vector<Expected<int>> stops_;      // after the stop tests of judged_
  std::vector<std::size_t> judged_;       // number of stop tests, of decided points one more, for each point
  Bounds bounds_;
  int maximum_ = 0;  // realisations of a point
};

}  // namespace peclet::runner
