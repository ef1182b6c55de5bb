#include <gtest/gtest.h>

#include <random>

#include "runner/statistics/window_advice.h"

namespace peclet::runner {
namespace {

using Observations = std::vector<Observation>;

// Returns realisations of mean 10 with 32 blocks of white noise of unit variance, plus `drift(block)`.
template <typename Drift>
Observations realisations(int seeds, unsigned start, Drift drift) {
  std::mt19937_64 random(start);
  std::normal_distribution<double> noise;
  Observations observations;
  for (int seed = 0; seed < seeds; ++seed) {
    double quarter = 0, half = 0, whole = 0;
    for (int block = 0; block < 32; ++block) {
      const double value = 10 + noise(random) + drift(block);
      if (block < 8) quarter += value / 8;
      if (block < 16) half += value / 16;
      whole += value / 32;
    }
    observations.push_back({whole + 0.25, -0.25, quarter, half});
  }
  return observations;
}

// 2000 cohorts at 0.1 % give 2 false alarms on average, and more than 10 by chance less than once in 10^4
// (Poisson). The seeds are fixed.
TEST(Transient, IsSeenByChanceOnceInAThousandCohortsWithoutOne) {
  int seen = 0;
  for (unsigned cohort = 0; cohort < 2000; ++cohort) {
    if (has_transient(realisations(10, 1000 + cohort, [](int) { return 0; }))) ++seen;
  }
  EXPECT_LE(seen, 10);
}

// The mean of 40 realisations has a standard error of 1 / sqrt(40 * 32) = 0.028. A transient of amplitude 1
// and a length of two blocks shifts the mean by (1 / 32) / (1 - exp(-1/2)) = 0.079, nearly three of them.
TEST(Transient, ThatIsShortBesideTheWindowIsSeen) {
  EXPECT_TRUE(has_transient(realisations(40, 1, [](int block) { return std::exp(-block / 2.0); })));
}

// The transient exp(-t) is as long as the window. Its mean is 0.787 over the first half, 0.632 over the
// whole. The difference has a standard error of 1 / sqrt(32 * 40) = 0.028 and is 5.5 of them; the test needs
// 3.8.
TEST(Transient, ThatIsAsLongAsTheWindowIsSeen) {
  EXPECT_TRUE(has_transient(realisations(40, 2, [](int block) { return std::exp(-block / 32.0); })));
}

// More seeds cannot remove a transient, but they reveal it.
TEST(Transient, IsSeenTheBetterTheMoreSeedsThereAre) {
  const auto drift = [](int block) { return 0.15 * std::exp(-block / 16.0); };
  EXPECT_FALSE(has_transient(realisations(10, 3, drift)));
  EXPECT_TRUE(has_transient(realisations(1000, 3, drift)));
}

TEST(Transient, OfLostOrUnknownSeedsIsNone) {
  EXPECT_FALSE(has_transient(Observations(20)));
  EXPECT_FALSE(has_transient(Observations(20, Observation{10})));
  // Equal blocks whose sums differ by rounding.
  EXPECT_FALSE(has_transient(Observations(20, Observation{0.3, 0, 0.1 + 0.2, 0.3})));
}

TEST(Transient, CannotBeTestedWhereFewResultsHaveBlocks) {
  EXPECT_TRUE(lacks_blocks(20, 0));
  EXPECT_TRUE(lacks_blocks(20, 4));
  EXPECT_TRUE(lacks_blocks(3, 0));
  EXPECT_FALSE(lacks_blocks(20, 5));
  EXPECT_FALSE(lacks_blocks(3, 3));  // more seeds will help
  EXPECT_FALSE(lacks_blocks(0, 0));
}

}  // namespace
}  // namespace peclet::runner
