#include "runner/statistics/bootstrap.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "runner/statistics/statistics.h"

namespace peclet::runner {
namespace {

constexpr int resamples = 4000;
// Of five values of which four are equal two resamples in three have spread: so many draws always suffice
// where numbers are finite.
constexpr int most_draws = 4 * resamples;
constexpr std::size_t fewest_values = 5;

// Linear between the order statistics.
double quantile(const std::vector<double>& sorted, double probability) {
  const double place = probability * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (place - std::floor(place)) * (sorted[above] - sorted[below]);
}

}  // namespace

std::optional<Interval> bootstrap_t(std::span<const double> values, double confidence) {
  const Estimate whole = estimate(values);
  if (values.size() < fewest_values || !(whole.standard_error > 0)) return std::nullopt;
  std::mt19937_64 random(0);
  std::vector<double> sample(values.size()), scores;
  for (int draw = 0; draw < most_draws && scores.size() < resamples; ++draw) {
    // Taken modulo: the bias is below 1e-13, and a std distribution differs between libraries.
    for (double& value : sample) value = values[random() % values.size()];
    const Estimate again = estimate(sample);
    const double score = (again.mean - whole.mean) / again.standard_error;
    if (again.standard_error > 0 && std::isfinite(score)) scores.push_back(score);
  }
  if (scores.size() < resamples) return std::nullopt;
  std::sort(scores.begin(), scores.end());
  const double tail = (1 - confidence) / 2;
  return Interval{whole.mean - quantile(scores, 1 - tail) * whole.standard_error,
                  whole.mean - quantile(scores, tail) * whole.standard_error};
}

}  // namespace peclet::runner
