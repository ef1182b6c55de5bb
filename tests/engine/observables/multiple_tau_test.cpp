// Correlations and squared sums over a widening grid, compared with plain sums.
#include "engine/observables/multiple_tau.h"

#include <gtest/gtest.h>

#include <numeric>
#include <set>

#include "tests/engine/draws.h"

namespace peclet::engine {
namespace {

std::vector<double> random_series(std::size_t count, std::uint64_t of_seed) {
  Draws draws(of_seed);
  std::vector<double> series(count);
  for (double& value : series) value = draws.uniform(-1, 1);
  return series;
}

TEST(MultipleTau, OfTheFirstLevelIsThePlainSum) {
  const std::vector<double> series = random_series(100, 1);
  MultipleTau correlator(1);
  for (const double value : series) correlator.add(value);
  const auto values = correlator.values();
  ASSERT_EQ(values.size(), 16u);
  for (const auto& [lag, correlation] : values) {
    double sum = 0;
    for (std::size_t k = lag; k < series.size(); ++k) sum += series[k] * series[k - lag];
    EXPECT_NEAR(correlation, sum / static_cast<double>(series.size() - lag), 1e-12);
  }
}

// Means of 4 consecutive values, correlated over whole lags.
TEST(MultipleTau, OfAHigherLevelCorrelatesMeans) {
  const std::vector<double> series = random_series(400, 2);
  std::vector<double> means;
  for (std::size_t k = 0; k < series.size(); k += 4) {
    means.push_back((series[k] + series[k + 1] + series[k + 2] + series[k + 3]) / 4);
  }
  MultipleTau correlator(3);
  for (const double value : series) correlator.add(value);
  for (const auto& [lag, correlation] : correlator.values()) {
    if (lag < 32) continue;  // lower levels
    ASSERT_EQ(lag % 4, 0u);
    const std::size_t between = lag / 4;
    double sum = 0;
    for (std::size_t k = between; k < means.size(); ++k) sum += means[k] * means[k - between];
    EXPECT_NEAR(correlation, sum / static_cast<double>(means.size() - between), 1e-12) << lag;
  }
}

// Windows of m 2^l entries start at every multiple of 2^l.
TEST(SquaredSums, AreThoseOfAllWindowsOfTheGrid) {
  Draws draws(1);
  std::vector<double> series(301);
  for (double& value : series) value = draws.uniform(-1, 1.5);
  SquaredSums sums(4);
  for (const double value : series) sums.add(value);
  std::set<std::uint64_t> lengths;
  for (const auto& [length, mean_square] : sums.values()) {
    EXPECT_TRUE(lengths.insert(length).second) << length;
    std::size_t spacing = 1;
    while (length / spacing > 15) spacing *= 2;
    double squares = 0;
    int windows = 0;
    for (std::size_t begin = 0; begin + length <= series.size(); begin += spacing, ++windows) {
      const auto from = series.begin() + static_cast<std::ptrdiff_t>(begin);
      const double sum = std::accumulate(from, from + static_cast<std::ptrdiff_t>(length), 0.0);
      squares += sum * sum;
    }
    EXPECT_NEAR(mean_square, squares / windows, 1e-11 * squares) << length;
  }
  EXPECT_TRUE(lengths.contains(1));
  EXPECT_TRUE(lengths.contains(120));
}

TEST(SquaredSums, NameTheirLengthsBeforehand) {
  for (const std::uint64_t entries : {1U, 9U, 64U, 301U}) {
    SquaredSums sums(4);
    for (std::uint64_t k = 0; k < entries; ++k) sums.add(1);
    std::vector<std::uint64_t> found;
    for (const auto& value : sums.values()) found.push_back(value.lag);
    EXPECT_EQ(SquaredSums::lengths(4, entries), found) << entries;
  }
}

}  // namespace
}  // namespace peclet::engine
