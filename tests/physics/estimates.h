// Means with their statistical errors.
#pragma once

#include <cmath>
#include <vector>

namespace peclet::engine {

struct Estimate {
  double mean, error;  // error: one standard deviation of the mean

  // Distance from an expectation in units of the error.
  double deviation(double expected) const { return std::abs(mean - expected) / error; }
};

// Of values that are independent of each other.
inline Estimate estimate(const std::vector<double>& values) {
  const auto n = static_cast<double>(values.size());
  double sum = 0, squares = 0;
  for (const double value : values) sum += value;
  for (const double value : values) {
    squares += (value - sum / n) * (value - sum / n);
  }
  return {sum / n, std::sqrt(squares / (n * (n - 1)))};
}

// Of a series in which neighbours depend on each other: blocks of equal length must be much longer than that
// dependence lasts. Values beyond the last whole block are left out.
inline Estimate block_estimate(const std::vector<double>& series, std::size_t blocks) {
  const std::size_t length = series.size() / blocks;
  std::vector<double> means(blocks);
  for (std::size_t k = 0; k < blocks * length; ++k) {
    means[k / length] += series[k] / static_cast<double>(length);
  }
  return estimate(means);
}

}  // namespace peclet::engine
