#include "runner/statistics/window_advice.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "runner/statistics/statistics.h"

namespace peclet::runner {
namespace {

constexpr double confidence_of_each = 1 - 0.0005;

// Returns true if the mean contrast is not zero. `scale` is the size of the subtracted values: differences
// within rounding count as zero.
bool differs_from_zero(const std::vector<double>& contrasts, double scale) {
  const Estimate mean = estimate(contrasts);
  if (mean.count < fewest_contrasts) return false;
  return std::abs(mean.mean) > student_half_width(mean, confidence_of_each) + 1e-9 * std::abs(scale);
}

constexpr std::size_t fewest_realisations = 8;
constexpr double normal_quantile = 1.959964;  // 97.5 %

std::optional<double> correlation(std::span<const WindowHalves> halves) {
  const auto count = static_cast<double>(halves.size());
  double first = 0, second = 0;
  for (const WindowHalves& half : halves) {
    first += half.first / count;
    second += half.second / count;
  }
  double ff = 0, fs = 0, ss = 0;
  for (const WindowHalves& half : halves) {
    ff += (half.first - first) * (half.first - first);
    fs += (half.first - first) * (half.second - second);
    ss += (half.second - second) * (half.second - second);
  }
  if (ff == 0 || ss == 0) return std::nullopt;
  return fs / std::sqrt(ff * ss);
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

std::optional<WindowAdvice> advise_window(std::span<const WindowHalves> halves, double equilibration,
                                          double production) {
  if (halves.size() < fewest_realisations) return std::nullopt;
  const std::optional<double> found = correlation(halves);
  if (!found || std::abs(*found) >= 1) return std::nullopt;
  WindowAdvice advice;
  advice.correlation = *found;
  const double width = normal_quantile / std::sqrt(static_cast<double>(halves.size()) - 3);
  advice.low = std::tanh(std::atanh(*found) - width);
  advice.high = std::tanh(std::atanh(*found) + width);
  const double present = equilibration + production;
  advice.half_as_long = (equilibration + production / 2) / present * 2 / (1 + *found);
  const double longer = (equilibration + 2 * production) / present;
  advice.twice_as_long_at_best = longer / 2;
  advice.twice_as_long_at_worst = longer * (1 + std::max(*found, 0.0)) / 2;
  return advice;
}

}  // namespace peclet::runner
