// Mean squares of sums over windows of a widening grid, compared with plain sums.
#include <gtest/gtest.h>

#include <numeric>
#include <set>

#include "engine/observables/multiple_tau.h"
#include "tests/engine/draws.h"

namespace peclet::engine {
namespace {

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
