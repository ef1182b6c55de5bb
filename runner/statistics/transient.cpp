#include "runner/statistics/transient.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "runner/statistics/statistics.h"

namespace peclet::runner {
namespace {

constexpr double confidence_of_each = 1 - 0.0005;

// `scale` is the size of what was subtracted: a difference that rounding can make is none.
bool differs_from_zero(const std::vector<double>& contrasts, double scale) {
  const Estimate mean = estimate(contrasts);
  if (mean.count < fewest_contrasts) return false;
  return std::abs(mean.mean) > student_half_width(mean, confidence_of_each) + 1e-9 * std::abs(scale);
}

}  // namespace

bool has_transient(std::span<const Observation> observed) {
  std::vector<double> quarters, halves;
  double scale = 0;
  for (const Observation& observation : observed) {
    if (!std::isfinite(observation.first_half)) continue;
    const double whole = observation.value + observation.control;
    scale = std::max(scale, std::abs(whole));
    quarters.push_back(observation.first_quarter - whole);
    halves.push_back(observation.first_half - whole);
  }
  return differs_from_zero(quarters, scale) || differs_from_zero(halves, scale);
}

}  // namespace peclet::runner
