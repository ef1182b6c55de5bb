// Which seed runs next, and when a point is decided. Pure: no clock, no process, no database.
//
// A point that is not decided needs the seeds of its next look. Among such points the one with the fewest
// seeds begun goes first (then the order of the sweep, then the order of the seeds), so that all points come
// forward together. When every needed seed is out, workers run ahead with the seeds of the look after that:
// surplus, which costs nothing when the point goes on, and which does not count when it stops.
#pragma once

#include <optional>
#include <vector>

#include "runner/cohorts.h"

namespace peclet::runner {

// `point` is the index in the order of the sweep.
struct SeedId {
  int point = 0;
  int seed = 0;
  friend bool operator==(const SeedId&, const SeedId&) = default;
};

class Scheduler {
 public:
  // `outcomes[point][seed]` is what earlier runs left; seeds beyond the end have none.
  Scheduler(std::vector<std::vector<std::optional<Outcome>>> outcomes, Target target, int minimum,
            int maximum);

  // The next seed for an idle worker; nothing when every seed that could be wanted now is out or ended.
  std::optional<SeedId> next() const;

  // The seed has been given to a worker.
  void begin(SeedId id);
  // The seed has come back without an outcome.
  void give_back(SeedId id);
  // The seed has ended, for the first time or (a late result of a quarantined seed) for the second.
  // True when the looks of its point may have changed.
  bool end(SeedId id, const Outcome& outcome);

  // All looks that the outcomes allow. The last one decides unless its verdict is `more`.
  const std::vector<Look>& looks(int point) const { return point_at(point).looks; }
  bool decided(int point) const;
  bool finished() const;

  // Seeds that the next look needs; of a decided point those of the deciding look.
  int wanted(int point) const;
  // Of these, how many have ended.
  int ended(int point) const;
  // Seeds of the point that run or have ended.
  int begun(int point) const { return point_at(point).begun; }
  int points() const { return static_cast<int>(points_.size()); }

 private:
  enum class Phase : unsigned char { waiting, out, ended };
  struct Point {
    std::vector<std::optional<Outcome>> outcomes;  // maximum long
    std::vector<Phase> phases;
    std::vector<Look> looks;
    int begun = 0;   // out or ended
    int closed = 0;  // the seeds 0 .. closed - 1 have ended
  };

  const Point& point_at(int point) const { return points_[static_cast<std::size_t>(point)]; }
  Point& point_at(int point) { return points_[static_cast<std::size_t>(point)]; }
  void look_at(Point& point);
  // The look after the last one made, and the one after that.
  int look_ahead(const Point& point, int steps) const;
  std::optional<SeedId> furthest_behind(int steps) const;

  Target target_;
  int minimum_, maximum_;
  std::vector<int> schedule_;
  std::vector<Point> points_;
};

}  // namespace peclet::runner
