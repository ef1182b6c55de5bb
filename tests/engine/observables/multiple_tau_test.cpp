// Correlations over lags of a widening grid, compared with plain sums.
#include "engine/observables/multiple_tau.h"

#include <gtest/gtest.h>

#include <vector>

#include "tests/engine/draws.h"

namespace peclet::engine {
namespace {

TEST(MultipleTau, OfTheFirstLevelIsThePlainSum) {
  Draws draws(1);
  std::vector<double> series(100);
  for (double& value : series) value = draws.uniform(-1, 1);
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
  Draws draws(2);
  std::vector<double> series(400), means;
  for (double& value : series) value = draws.uniform(-1, 1);
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

}  // namespace
}  // namespace peclet::engine
