#include "runner/statistics/scheduler.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <compare>
#include <iterator>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "runner/campaign/number_text.h"
#include "runner/statistics/forecast.h"

namespace peclet::runner {

namespace {

bool decides(const std::vector<StopTest>& stop_tests) {
  return !stop_tests.empty() && stop_tests.back().verdict != Verdict::more;
}

std::string sum_text(const SummedError& error) {
  if (error.unknown == 0) return rough(error.sum);
  return fmt::format("{} ({} of them without an interval, each counted as 1)", rough(error.sum),
                     error.unknown);
}

}  // namespace

Scheduler::Scheduler(std::vector<std::vector<std::optional<Outcome>>> outcomes, Target target, int minimum,
                     int maximum, std::vector<Curve> curves)
    : target_(std::move(target)),
      minimum_(minimum),
      maximum_(maximum),
      ceiling_(maximum),
      schedule_(stop_test_schedule(minimum, maximum)) {
  for (std::vector<std::optional<Outcome>>& known : outcomes) {
    Point point;
    point.all_seeds.resize(target_.observables().size());
    point.outcomes = std::move(known);
    // The database keeps seeds beyond a maximum that was lowered. The stop tests leave them out.
    if (std::ssize(point.outcomes) > maximum_) point.outcomes.resize(static_cast<std::size_t>(maximum_));
    for (const std::optional<Outcome>& outcome : point.outcomes) {
      point.phases.push_back(outcome ? Phase::ended : Phase::waiting);
      if (!outcome) continue;
      ++point.begun;
      ++point.all_ended;
      count_in(point, *outcome);
    }
    points_.push_back(std::move(point));
  }
  for (Curve& curve : curves) {
    std::vector<int> places;
    for (const std::size_t place : curve.points) {
      points_[place].curve = curves_.size();
      points_[place].member = places.size();
      places.push_back(static_cast<int>(place));
    }
    CurveStopTests stop_tests(curve, target_, minimum_, maximum_);
    curves_.push_back({std::move(places), std::move(curve), std::move(stop_tests)});
  }
  for (int number = 0; number < points(); ++number) stop_test_at(number, false);
}

Scheduler::Phase& Scheduler::phase_of(SeedId id) {
  if (id.seed < 0 || id.seed >= maximum_) throw std::out_of_range("the seed is not below the maximum");
  Point& point = point_at(id.point);
  const auto seed = static_cast<std::size_t>(id.seed);
  if (seed >= point.phases.size()) {
    point.outcomes.resize(seed + 1);
    point.phases.resize(seed + 1, Phase::waiting);
  }
  return point.phases[seed];
}

void Scheduler::close(Point& point) {
  while (point.closed < std::ssize(point.outcomes) && point.outcomes[static_cast<std::size_t>(point.closed)])
    ++point.closed;
}

std::vector<Change> Scheduler::stop_test_at(int number, bool again) {
  Point& point = point_at(number);
  close(point);
  if (point.curve) return stop_test_at(curves_[*point.curve], again);
  return {take(number, replay_stop_tests(point.outcomes, target_, minimum_, maximum_))};
}

std::vector<Change> Scheduler::stop_test_at(JointStopTests& curve, bool again) {
  if (again) curve.stop_tests = CurveStopTests(curve.along, target_, minimum_, maximum_);
  std::vector<CurveStopTests::Member> members;
  for (const int number : curve.points)
    members.push_back({&point_at(number).outcomes, point_at(number).cancelled});
  std::vector<std::size_t> changed = curve.stop_tests.advance(members);
  if (again) {
    changed.resize(members.size());
    std::iota(changed.begin(), changed.end(), 0);
  }
  std::vector<Change> changes;
  changes.reserve(changed.size());
  for (const std::size_t member : changed)
    changes.push_back(take(curve.points[member], curve.stop_tests.stop_tests(member)));
  return changes;
}

Change Scheduler::take(int number, std::vector<StopTest> stop_tests) {
  Point& point = point_at(number);
  const Change change{number, point.stop_tests.size(), decides(point.stop_tests)};
  point.stop_tests = std::move(stop_tests);
  point.expected = expected_seeds(point.stop_tests, target_, minimum_, maximum_);
  point.fall = decides(point.stop_tests) ? 0 : expected_fall(point);
  return change;
}

void Scheduler::set_cancelled(int number, bool cancelled) {
  Point& point = point_at(number);
  if (std::exchange(point.cancelled, cancelled) == cancelled || !point.curve) return;
  stop_test_at(curves_[*point.curve], true);
}

void Scheduler::count_in(Point& point, const Outcome& outcome) {
  for (std::size_t place = 0; place < point.all_seeds.size(); ++place)
    add(point.all_seeds[place], outcome.of(place));
}

std::vector<Estimate> Scheduler::all_seeds(int point) const {
  return estimates_of(point_at(point).all_seeds);
}

bool Scheduler::decided(int point) const { return decides(point_at(point).stop_tests); }

bool Scheduler::finished() const {
  return std::none_of(points_.begin(), points_.end(), [this](const Point& point) { return is_open(point); });
}

int Scheduler::stop_test_ahead(const Point& point, int steps) const {
  const std::size_t index = point.stop_tests.size() + static_cast<std::size_t>(steps);
  return schedule_[std::min(is_waiting(point) ? index - 1 : index, schedule_.size() - 1)];
}

int Scheduler::wanted(int point) const {
  const Point& about = point_at(point);
  return decides(about.stop_tests) ? about.stop_tests.back().seeds
                                   : std::min(stop_test_ahead(about, 0), ceiling_);
}

int Scheduler::ended(int point) const {
  const std::vector<Phase>& phases = point_at(point).phases;
  const auto end = phases.begin() + std::min<std::ptrdiff_t>(wanted(point), std::ssize(phases));
  return static_cast<int>(std::count(phases.begin(), end, Phase::ended));
}

bool Scheduler::is_open(const Point& point) const {
  return !point.cancelled && !decides(point.stop_tests) && point.closed < ceiling_;
}

std::optional<SeedId> Scheduler::next(const Allows& allows) const {
  constexpr double unlimited = std::numeric_limits<double>::infinity();
  if (const std::optional<SeedId> needed = most_urgent(0, unlimited, allows)) return needed;
  return most_urgent(1, unlimited, allows);
}

std::optional<SeedId> Scheduler::next_within(double seconds, const Allows& allows) const {
  return seconds > 0 ? most_urgent(0, seconds, allows) : std::nullopt;
}

bool Scheduler::may_be_next(SeedId id, std::optional<double> budget) const {
  const Point& point = point_at(id.point);
  const auto [known, beyond] = still_open(point, budget ? 0 : 1);
  const std::ptrdiff_t place = id.seed - point.closed, size = std::ssize(known);
  if (!is_open(point) || place < 0 || place >= size + beyond) return false;
  if (place < size && known[static_cast<std::size_t>(place)] != Phase::waiting) return false;
  if (!budget) return true;
  const std::optional<double> scale = seconds_per_work();
  return *budget > 0 && (!scale || point.seconds.value_or(point.work * *scale) <= *budget);
}

std::optional<double> Scheduler::seconds_per_work() const {
  double seconds = 0, work = 0;
  for (const Point& point : points_) {
    if (!point.seconds) continue;
    seconds += *point.seconds;
    work += point.work;
  }
  if (seconds == 0) return std::nullopt;
  return seconds / work;
}

double Scheduler::expected_seconds(const std::vector<int>& running) const {
  const double scale = seconds_per_work().value_or(0);  // visits all points, so only once
  double seconds = 0;
  for (int number = 0; number < points(); ++number) {
    const Point& about = point_at(number);
    seconds += running[static_cast<std::size_t>(number)] * about.seconds.value_or(about.work * scale);
  }
  return seconds;
}

double Scheduler::expected_fall(const Point& point) const {
  // Before the first stop test nothing is known, so its seeds are worth most.
  constexpr double of_unknown = 1e6;
  if (point.stop_tests.empty()) return of_unknown;
  const StopTest& last = point.stop_tests.back();
  const double width = largest_share(last, target_);
  if (!std::isfinite(width)) {  // as if the half-width were 100 % of the mean
    return target_.tolerance.is_relative() ? 1 / target_.tolerance.value : of_unknown;
  }
  // Student's factor counts: from 4 to 10 seeds it falls nearly like 1 / sqrt(n).
  const double confidence = adjusted_confidence(target_.confidence, minimum_, maximum_);
  const double share = static_cast<double>(stop_test_ahead(point, 0)) / last.seeds;
  const int count = last.controlled.count, later = static_cast<int>(std::lround(count * share));
  return width * (1 - student_quantile(later - 1, confidence) * std::sqrt(count) /
                          (student_quantile(count - 1, confidence) * std::sqrt(later)));
}

Scheduler::Rank Scheduler::rank(const Point& point, double seconds) const {
  if (allocation_ == Allocation::steepest_first) {
    return {0, point.fall / (std::max(1, waiting(point)) * seconds)};
  }
  if (point.begun < seeds_of_pass) return {seeds_of_pass - point.begun, -seconds};
  // An open point that has begun all seeds that it was expected to need still needs one.
  return {0, std::max(1, std::min(point.expected, ceiling_) - point.begun) * seconds};
}

Scheduler::Stretch Scheduler::still_open(const Point& point, int steps) const {
  const auto end = static_cast<std::ptrdiff_t>(std::min(stop_test_ahead(point, steps), ceiling_));
  const std::ptrdiff_t size = std::ssize(point.phases);
  const std::ptrdiff_t known = std::clamp<std::ptrdiff_t>(end, point.closed, size);
  return {std::span(point.phases.begin() + point.closed, point.phases.begin() + known),
          static_cast<int>(std::max<std::ptrdiff_t>(0, end - size))};
}

int Scheduler::waiting(const Point& point) const {
  const auto [known, beyond] = still_open(point, 0);
  return static_cast<int>(std::count(known.begin(), known.end(), Phase::waiting)) + beyond;
}

std::optional<int> Scheduler::waiting_seed(int number, int steps, const Allows& allows) const {
  const Point& point = point_at(number);
  const auto [known, beyond] = still_open(point, steps);
  const auto size = static_cast<int>(known.size());
  for (int i = 0; i < size + beyond; ++i) {
    if (i < size && known[static_cast<std::size_t>(i)] != Phase::waiting) continue;
    if (!allows || allows({number, point.closed + i})) return point.closed + i;
  }
  return std::nullopt;
}

std::optional<SeedId> Scheduler::most_urgent(int steps, double budget, const Allows& allows) const {
  constexpr double shortest = 1e-9;  // a clock may have measured 0 s
  const std::optional<double> known = seconds_per_work();
  const double scale = known.value_or(1);
  std::optional<SeedId> best;
  std::tuple<int, bool, Rank> best_rank;
  for (int number = 0; number < points(); ++number) {
    const Point& point = point_at(number);
    if (!is_open(point)) continue;
    const double seconds = std::max(shortest, point.seconds.value_or(point.work * scale));
    if (known && seconds > budget) continue;
    const bool is_whole = !known || seconds * waiting(point) <= budget;
    const std::tuple<int, bool, Rank> own{point.priority, is_whole, rank(point, seconds)};
    if (best && own <= best_rank) continue;
    if (const std::optional<int> seed = waiting_seed(number, steps, allows)) {
      best = SeedId{number, *seed};
      best_rank = own;
    }
  }
  return best;
}

void Scheduler::begin(SeedId id) {
  Phase& phase = phase_of(id);
  assert(phase == Phase::waiting);
  phase = Phase::out;
  ++point_at(id.point).begun;
}

void Scheduler::give_back(SeedId id) {
  Phase& phase = phase_of(id);
  assert(phase == Phase::out);
  phase = Phase::waiting;
  --point_at(id.point).begun;
}

std::vector<Change> Scheduler::end(SeedId id, const Outcome& outcome) {
  if (id.seed >= maximum_) return {};
  Phase& phase = phase_of(id);
  Point& point = point_at(id.point);
  if (phase == Phase::waiting) ++point.begun;
  phase = Phase::ended;
  std::optional<Outcome>& known = point.outcomes[static_cast<std::size_t>(id.seed)];
  const bool again = known.has_value();
  // A late result replaces the outcome of a lost seed.
  const bool had_value = again && !known->is_lost();
  if (!had_value) count_in(point, outcome);
  point.all_ended += again ? 0 : 1;
  known = outcome;
  if (again) return stop_test_at(id.point, true);
  if (id.seed != point.closed || decides(point.stop_tests)) return {};
  close(point);
  if (is_waiting(point) || point.closed < stop_test_ahead(point, 0)) return {};
  return stop_test_at(id.point, false);
}

SummedError summed_error(const Scheduler& scheduler) {
  SummedError error;
  if (!scheduler.target().tolerance.is_relative()) return error;
  for (int point = 0; point < scheduler.points(); ++point) {
    if (scheduler.cancelled(point)) continue;
    ++error.points;
    const std::vector<StopTest>& stop_tests = scheduler.stop_tests(point);
    const double width = stop_tests.empty() ? std::nan("") : relative_width(stop_tests.back());
    error.sum += std::isfinite(width) ? width : 1;
    error.unknown += std::isfinite(width) ? 0 : 1;
  }
  return error;
}

std::string budget_text(double spent_seconds, double budget_seconds, const SummedError& before,
                        const SummedError& after) {
  const std::string spent =
      fmt::format("budget: {} of {} h of processor time spent", rough(spent_seconds / seconds_per_hour),
                  rough(budget_seconds / seconds_per_hour));
  if (after.points == 0) return spent + '\n';
  return fmt::format(
      "{}; at the last stop tests the relative half-widths of {} sum to {},\n        before the run to {}\n",
      spent, counted(static_cast<std::size_t>(after.points), "point"), sum_text(after), sum_text(before));
}

}  // namespace peclet::runner
