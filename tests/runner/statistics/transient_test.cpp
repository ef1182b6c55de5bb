#include <gtest/gtest.h>

#include <random>

#include "runner/statistics/window_advice.h"

namespace peclet::runner {
namespace {

using Observations = std::vector<Observation>;

// Realisations of mean 10 with 32 blocks of white noise of unit variance, to which `drift(block)` is added.
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

// 2000 cohorts at 0.1 % give 2 false alarms on the average, and more than 10 by chance in fewer than 1 of
// 10^4 trials (Poisson); the seeds are fixed.
TEST(Transient, IsSeenByChanceOnceInAThousandCohortsWithoutOne) {
  int seen = 0;
  for (unsigned cohort = 0; cohort < 2000; ++cohort) {
    if (has_transient(realisations(10, 1000 + cohort, [](int) { return 0; }))) ++seen;
  }
  EXPECT_LE(seen, 10);
}

// Standard error of the mean of 40 such realisations: 1 / sqrt(40 * 32) = 0.028. A transient of amplitude 1
// and of two blocks' length makes the whole mean too large by (1 / 32) / (1 - exp(-1/2)) = 0.079, nearly
// three of them.
TEST(Transient, ThatIsShortBesideTheWindowIsSeen) {
  EXPECT_TRUE(has_transient(realisations(40, 1, [](int block) { return std::exp(-block / 2.0); })));
}

// As long as the window: exp(-t) has the mean 0.787 over the first half and 0.632 over the whole. The
// standard error of the difference is 1 / sqrt(32 * 40) = 0.028, so it is 5.5 of them; chance needs 3.8.
TEST(Transient, ThatIsAsLongAsTheWindowIsSeen) {
  EXPECT_TRUE(has_transient(realisations(40, 2, [](int block) { return std::exp(-block / 32.0); })));
}

// More seeds do not hide what they cannot remove.
TEST(Transient, IsSeenTheBetterTheMoreSeedsThereAre) {
  const auto drift = [](int block) { return 0.15 * std::exp(-block / 16.0); };
  EXPECT_FALSE(has_transient(realisations(10, 3, drift)));
  EXPECT_TRUE(has_transient(realisations(1000, 3, drift)));
}

TEST(Transient, OfLostOrUnknownSeedsIsNone) {
  EXPECT_FALSE(has_transient(Observations(20)));
  EXPECT_FALSE(has_transient(Observations(20, Observation{10})));
  // Blocks that do not differ, summed with their rounding.
  EXPECT_FALSE(has_transient(Observations(20, Observation{0.3, 0, 0.1 + 0.2, 0.3})));
}

TEST(Transient, CannotBeTestedWhereFewResultsHaveBlocks) {
  EXPECT_TRUE(lacks_blocks(20, 0));
  EXPECT_TRUE(lacks_blocks(20, 4));
  EXPECT_TRUE(lacks_blocks(3, 0));
  EXPECT_FALSE(lacks_blocks(20, 5));
  EXPECT_FALSE(lacks_blocks(3, 3));  // more seeds will do
  EXPECT_FALSE(lacks_blocks(0, 0));
}

}  // namespace
}  // namespace peclet::runner
