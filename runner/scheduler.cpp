#include "runner/scheduler.h"

#include <algorithm>
#include <cassert>
#include <utility>

namespace peclet::runner {
namespace {

bool decides(const std::vector<Look>& looks) {
  return !looks.empty() && looks.back().verdict != Verdict::more;
}

}  // namespace

Scheduler::Scheduler(std::vector<std::vector<std::optional<Outcome>>> outcomes, Target target, int minimum,
                     int maximum)
    : target_(std::move(target)),
      minimum_(minimum),
      maximum_(maximum),
      schedule_(look_schedule(minimum, maximum)) {
  for (std::vector<std::optional<Outcome>>& known : outcomes) {
    Point point;
    point.outcomes = std::move(known);
    // Seeds beyond the maximum (it was larger once) are kept by the database and have no part in the looks.
    point.outcomes.resize(static_cast<std::size_t>(maximum_));
    for (const std::optional<Outcome>& outcome : point.outcomes) {
      point.phases.push_back(outcome ? Phase::ended : Phase::waiting);
      if (outcome) ++point.begun;
    }
    look_at(point);
    points_.push_back(std::move(point));
  }
}

void Scheduler::look_at(Point& point) {
  while (point.closed < maximum_ && point.outcomes[static_cast<std::size_t>(point.closed)]) ++point.closed;
  point.looks = replay_looks(point.outcomes, target_, minimum_, maximum_);
}

bool Scheduler::decided(int point) const { return decides(point_at(point).looks); }

bool Scheduler::finished() const {
  return std::all_of(points_.begin(), points_.end(), [](const Point& point) { return decides(point.looks); });
}

int Scheduler::look_ahead(const Point& point, int steps) const {
  const std::size_t index = point.looks.size() + static_cast<std::size_t>(steps);
  return schedule_[std::min(index, schedule_.size() - 1)];
}

int Scheduler::wanted(int point) const {
  const Point& about = point_at(point);
  return decides(about.looks) ? about.looks.back().seeds : look_ahead(about, 0);
}

int Scheduler::ended(int point) const {
  const std::vector<Phase>& phases = point_at(point).phases;
  return static_cast<int>(std::count(phases.begin(), phases.begin() + wanted(point), Phase::ended));
}

std::optional<SeedId> Scheduler::next() const {
  if (const std::optional<SeedId> needed = furthest_behind(0)) return needed;
  return furthest_behind(1);
}

std::optional<SeedId> Scheduler::furthest_behind(int steps) const {
  std::optional<SeedId> best;
  for (int number = 0; number < points(); ++number) {
    const Point& point = point_at(number);
    if (decides(point.looks) || (best && point.begun >= point_at(best->point).begun)) continue;
    const auto begin = point.phases.begin() + point.closed;
    const auto end = point.phases.begin() + look_ahead(point, steps);
    const auto waiting = std::find(begin, std::max(begin, end), Phase::waiting);
    if (waiting < end) best = SeedId{number, static_cast<int>(waiting - point.phases.begin())};
  }
  return best;
}

void Scheduler::begin(SeedId id) {
  Point& point = point_at(id.point);
  Phase& phase = point.phases.at(static_cast<std::size_t>(id.seed));
  assert(phase == Phase::waiting);
  phase = Phase::out;
  ++point.begun;
}

void Scheduler::give_back(SeedId id) {
  Point& point = point_at(id.point);
  Phase& phase = point.phases.at(static_cast<std::size_t>(id.seed));
  assert(phase == Phase::out);
  phase = Phase::waiting;
  --point.begun;
}

bool Scheduler::end(SeedId id, const Outcome& outcome) {
  if (id.seed >= maximum_) return false;
  Point& point = point_at(id.point);
  const auto seed = static_cast<std::size_t>(id.seed);
  if (point.phases[seed] == Phase::waiting) ++point.begun;
  point.phases[seed] = Phase::ended;
  const bool again = point.outcomes[seed].has_value();
  point.outcomes[seed] = outcome;
  if (again) {
    look_at(point);
    return true;
  }
  if (id.seed != point.closed || decides(point.looks)) return false;
  while (point.closed < maximum_ && point.outcomes[static_cast<std::size_t>(point.closed)]) ++point.closed;
  if (point.closed < look_ahead(point, 0)) return false;
  look_at(point);
  return true;
}

}  // namespace peclet::runner
