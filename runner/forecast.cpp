#include "runner/forecast.h"

#include <algorithm>
#include <cmath>

namespace peclet::runner {
namespace {

struct Spread {
  double mean = 0, deviation = 0;
};

Spread spread(const Cost& cost) {
  const double mean = cost.sum / cost.count;
  if (cost.count < 2) return {mean, mean};  // one value says nothing about the spread
  const double variance = std::max(0.0, (cost.sum_of_squares - mean * cost.sum) / (cost.count - 1));
  return {mean, std::sqrt(variance)};
}

// Relative standard error of a variance that was estimated from n values: sqrt(2 / (n - 1)).
double variance_uncertainty(const std::vector<Look>& looks) {
  const int count = looks.empty() ? 0 : looks.back().estimate.count;
  return count < 2 ? 0 : std::min(0.9, std::sqrt(2.0 / (count - 1)));
}

}  // namespace

void Cost::add(double seconds) {
  ++count;
  sum += seconds;
  sum_of_squares += seconds * seconds;
}

int expected_seeds(const std::vector<Look>& looks, const Target& target, int minimum, int maximum,
                   double factor) {
  const std::vector<int> schedule = look_schedule(minimum, maximum);
  if (looks.empty()) return schedule.front();
  const Look& last = looks.back();
  const double ratio = relative_width(last) / target.relative_tolerance;
  const double wanted = std::isfinite(ratio) ? last.seeds * ratio * ratio * factor : maximum;
  const auto later = std::upper_bound(schedule.begin(), schedule.end(), last.seeds);
  const auto enough = std::find_if(later, schedule.end(), [&](int seeds) { return seeds >= wanted; });
  return enough == schedule.end() ? schedule.back() : *enough;
}

std::optional<TimeToGo> time_to_go(const std::vector<PointForecast>& points, const Target& target,
                                   int minimum, int maximum, int workers) {
  // A point without any cost yet is taken to cost what the others do.
  Cost all;
  for (const PointForecast& point : points) {
    all.count += point.cost.count;
    all.sum += point.cost.sum;
    all.sum_of_squares += point.cost.sum_of_squares;
  }
  if (all.count == 0) return std::nullopt;

  TimeToGo total;
  for (const PointForecast& point : points) {
    if (point.decided) continue;
    const Spread cost = spread(point.cost.count > 0 ? point.cost : all);
    const double doubt = variance_uncertainty(point.looks);
    const auto seconds = [&](double factor, double deviations) {
      const double left =
          std::max(1, expected_seeds(point.looks, target, minimum, maximum, factor) - point.begun);
      return std::max(0.0, left * cost.mean + deviations * cost.deviation * std::sqrt(left)) / workers;
    };
    total.likely += seconds(1, 0);
    total.low += seconds(1 - doubt, -1);
    total.high += seconds(1 + doubt, 1);
  }
  return total;
}

}  // namespace peclet::runner
