#include "runner/jamming/steepest.h"

#include <fmt/format.h>

#include <cmath>
#include <random>

namespace peclet::runner {
namespace {

constexpr int resamples = 2000;

std::size_t steepest_interval(const std::vector<LawPoint>& points, const std::vector<double>& values) {
  std::size_t best = 0;
  double largest = -HUGE_VAL;
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const double slope = (values[i + 1] - values[i]) / (points[i + 1].fraction - points[i].fraction);
    if (slope > largest) {
      largest = slope;
      best = i;
    }
  }
  return best;
}

double middle(const std::vector<LawPoint>& points, std::size_t interval) {
  return 0.5 * (points[interval].fraction + points[interval + 1].fraction);
}

// Mean square of how far the interval's middle moves when values are drawn anew.
double spread(const std::vector<LawPoint>& points, double found, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  std::vector<double> values(points.size());
  double squares = 0;
  for (int k = 0; k < resamples; ++k) {
    for (std::size_t i = 0; i < points.size(); ++i) {
      values[i] = points[i].value + points[i].standard_error * normal(random);
    }
    squares += std::pow(middle(points, steepest_interval(points, values)) - found, 2);
  }
  return squares / resamples;
}

Steepest made(double fraction, double width, double variance) {
  return {{fraction, std::sqrt(width * width / 12 + variance)}, width};
}

}  // namespace

SteepestAnswer find_steepest(const std::vector<LawPoint>& points, const std::optional<double>& jammed,
                             std::uint64_t seed) {
  if (points.size() < 3)
    return {std::nullopt, fmt::format("{} of the 3 points that it needs", points.size())};
  std::vector<double> values;
  values.reserve(points.size());
  for (const LawPoint& point : points) values.push_back(point.value);
  const std::size_t best = steepest_interval(points, values);
  const double last = points.back().fraction;
  if (best + 2 < points.size()) {
    const double found = middle(points, best);
    return {made(found, points[best + 1].fraction - points[best].fraction, spread(points, found, seed)), ""};
  }
  if (!jammed || *jammed <= last)
    return {std::nullopt, "the viscosity rises most steeply up to the last point"};
  Steepest bracket = made(0.5 * (last + *jammed), *jammed - last, 0);
  bracket.to_jammed = true;
  return {bracket, ""};
}

}  // namespace peclet::runner
