#include "runner/scheduler.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include "runner/forecast.h"

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
  point.expected = expected_seeds(point.looks, target_, minimum_, maximum_);
}

bool Scheduler::decided(int point) const { return decides(point_at(point).looks); }

bool Scheduler::finished() const {
  return std::none_of(points_.begin(), points_.end(), [this](const Point& point) { return is_open(point); });
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

bool Scheduler::is_open(const Point& point) const { return !point.cancelled && !decides(point.looks); }

std::optional<SeedId> Scheduler::next() const {
  if (const std::optional<SeedId> needed = most_urgent(0)) return needed;
  return most_urgent(1);
}

double Scheduler::mean_seconds() const {
  double sum = 0;
  int known = 0;
  for (const Point& point : points_) {
    sum += point.seconds.value_or(0);
    known += point.seconds ? 1 : 0;
  }
  return known > 0 && sum > 0 ? sum / known : 1;
}

double Scheduler::rank(const Point& point, double seconds) const {
  if (allocation_ == Allocation::longest_first) {
    // A point may have begun more seeds than it was expected to need: it is not done for all that.
    return std::max(1, point.expected - point.begun) * seconds;
  }
  constexpr double unknown = 1e6;  // before the first look nothing is known, and nothing tells more
  const double width = point.looks.empty() ? unknown : relative_width(point.looks.back());
  return (std::isfinite(width) ? width : 1) / (2 * std::max(1, point.begun) * seconds);
}

std::optional<int> Scheduler::waiting_seed(const Point& point, int steps) const {
  const auto begin = point.phases.begin() + point.closed;
  const auto end = std::max(begin, point.phases.begin() + look_ahead(point, steps));
  const auto waiting = std::find(begin, end, Phase::waiting);
  if (waiting == end) return std::nullopt;
  return static_cast<int>(waiting - point.phases.begin());
}

std::optional<SeedId> Scheduler::most_urgent(int steps) const {
  const double mean = mean_seconds();
  std::optional<SeedId> best;
  std::pair<int, double> best_rank;
  for (int number = 0; number < points(); ++number) {
    const Point& point = point_at(number);
    if (!is_open(point)) continue;
    const std::pair<int, double> own{point.priority, rank(point, point.seconds.value_or(mean))};
    if (best && own <= best_rank) continue;
    if (const std::optional<int> seed = waiting_seed(point, steps)) {
      best = SeedId{number, *seed};
      best_rank = own;
    }
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
