// Means with their standard errors.
#pragma once

#include <cmath>
#include <vector>

namespace peclet::engine {

struct Estimate {
  double mean, error;  // error: standard error of the mean

  // Returns the distance from `expected` in standard errors.
  double deviation(double expected) const { return std::abs(mean - expected) / error; }
};

// Returns the mean of independent values.
inline Estimate estimate(const std::vector<double>& values) {
  const auto n = static_cast<double>(values.size());
  double sum = 0, squares = 0;
  for (const double value : values) sum += value;
  for (const double value : values) squares += (value - sum / n) * (value - sum / n);
  return {sum / n, std::sqrt(squares / (n * (n - 1)))};
}

// Returns the mean of a correlated series. Blocks of equal length must be much longer than the correlation
// time; values beyond the last whole block are left out.
inline Estimate block_estimate(const std::vector<double>& series, std::size_t blocks) {
  const std::size_t length = series.size() / blocks;
  std::vector<double> means(blocks);
  for (std::size_t k = 0; k < blocks * length; ++k)
    means[k / length] += series[k] / static_cast<double>(length);
  return estimate(means);
}
}  // namespace peclet::engine
