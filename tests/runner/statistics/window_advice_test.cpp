#include "runner/statistics/window_advice.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace peclet::runner {
namespace {

// Returns halves with the exact correlation r: (a, r a + sqrt(1 - r^2) b), a and b orthogonal, of variance 1.
std::vector<WindowHalves> halves(double r) {
  std::vector<WindowHalves> all;
  for (const double a : {-1.0, 1.0, -1.0, 1.0}) {
    for (const double b : {-1.0, 1.0}) {
      for (int twice = 0; twice < 2; ++twice) all.push_back({10 + a, 10 + r * a + std::sqrt(1 - r * r) * b});
    }
  }
  return all;
}

TEST(WindowAdvice, WithoutCorrelationOnlyTheEquilibrationIsWasted) {
  // Equilibration and window cost the same. Half the window has 3/4 of the cost and twice the variance; twice
  // the window has 3/2 of the cost and half the variance.
  const WindowAdvice advice = advise_window(halves(0), 10, 10).value();
  EXPECT_NEAR(advice.correlation, 0, 1e-12);
  EXPECT_DOUBLE_EQ(advice.half_as_long, 1.5);
  EXPECT_DOUBLE_EQ(advice.twice_as_long_at_best, 0.75);
  EXPECT_DOUBLE_EQ(advice.twice_as_long_at_worst, 0.75);
}

TEST(WindowAdvice, CorrelatedHalvesAskForShorterWindows) {
  // Without equilibration, half the window has 1/2 of the cost and 2 / 1.8 times the variance (r = 0.8).
  const WindowAdvice advice = advise_window(halves(0.8), 0, 10).value();
  EXPECT_NEAR(advice.correlation, 0.8, 1e-12);
  EXPECT_NEAR(advice.half_as_long, 1 / 1.8, 1e-12);
  EXPECT_NEAR(advice.twice_as_long_at_worst, 1.8, 1e-12);
  EXPECT_NEAR(advice.twice_as_long_at_best, 1, 1e-12);
  // Fisher's z of 16 pairs: tanh(1.0986 -+ 1.96 / sqrt(13)) = 0.504 .. 0.928
  EXPECT_NEAR(advice.low, 0.504, 1e-3);
  EXPECT_NEAR(advice.high, 0.928, 1e-3);
}

TEST(WindowAdvice, NeedsEightRealisationsThatDiffer) {
  EXPECT_FALSE(advise_window(std::vector<WindowHalves>(20, {1, 2}), 1, 1));
  std::vector<WindowHalves> few = halves(0.5);
  few.resize(7);
  EXPECT_FALSE(advise_window(few, 1, 1));
}

}  // namespace
}  // namespace peclet::runner
