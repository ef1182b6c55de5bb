// Compares means, standard errors and intervals with closed forms and printed tables.
#include "runner/statistics/statistics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>

namespace peclet::runner {
namespace {

TEST(Statistics, WholeNumbersUpToNHaveTheirTextbookMeanAndVariance) {
  for (const int n : {2, 3, 10, 1000, 100'000}) {
    std::vector<double> values(static_cast<std::size_t>(n));
    std::iota(values.begin(), values.end(), 1.0);
    const Estimate result = estimate(values);
    EXPECT_EQ(result.count, n);
    EXPECT_DOUBLE_EQ(result.mean, (n + 1) / 2.0);
    // The sample variance is n (n + 1) / 12, so the standard error is sqrt((n + 1) / 12).
    EXPECT_NEAR(result.standard_error, std::sqrt((n + 1) / 12.0), 1e-12 * n);
  }
}

TEST(Statistics, ALargeOffsetDoesNotSpoilTheSpread) {
  const Estimate result = estimate(std::vector<double>{1e9 + 4, 1e9 + 7, 1e9 + 13, 1e9 + 16});
  EXPECT_EQ(result.mean, 1e9 + 10);
  EXPECT_DOUBLE_EQ(result.standard_error, std::sqrt(30.0 / 4));
}

TEST(Statistics, EqualValuesHaveExactlyTheirMeanAndNoSpread) {
  for (const double value : {0.1, 8.93, -1e-7}) {
    const Estimate result = estimate(std::vector<double>(10, value));
    EXPECT_EQ(result.mean, value);
    EXPECT_EQ(result.standard_error, 0);
  }
}

// The sums or squares of these numbers overflow or vanish.
TEST(Statistics, NumbersNearTheEndsOfWhatThereIsHaveTheirMeanAndSpread) {
  for (const double size : {1e308, 1e-300, 4e-308, 1e200}) {
    const Estimate result = estimate(std::vector<double>{1.1 * size, 1.2 * size, 1.3 * size, 1.4 * size});
    EXPECT_NEAR(result.mean / size, 1.25, 1e-12);
    // The variance of the values is 0.05 / 3, and that of their mean a quarter of it.
    EXPECT_NEAR(result.standard_error / size, std::sqrt(0.05 / 12), 1e-12);
    EXPECT_NEAR(skewness(std::vector<double>{size, size, 1.7 * size}), std::sqrt(0.5), 1e-9);
  }
  const double most = std::numeric_limits<double>::max();
  EXPECT_EQ(estimate(std::vector<double>(7, most)).mean, most);
  EXPECT_EQ(estimate(std::vector<double>{most, -most}).mean, 0);
}

TEST(Statistics, FewerThanTwoValuesHaveNoStandardErrorAndNoInterval) {
  const Estimate none = estimate({});
  EXPECT_EQ(none.count, 0);
  EXPECT_TRUE(std::isnan(none.mean));
  const Estimate one = estimate(std::vector<double>{3});
  EXPECT_EQ(one.mean, 3);
  EXPECT_TRUE(std::isnan(one.standard_error));
  EXPECT_TRUE(std::isnan(student_half_width(one, 0.95)));
}

// 95 % limits of 0, 1, 5 in 10 and 1 in 20 are printed in tables of the binomial distribution (Clopper and
// Pearson, Biometrika 26, 404); 8 in 8 give 0.025^(1/8).
TEST(Statistics, SharesHaveClopperAndPearsonsInterval) {
  struct Row {
    int ones, count;
    double low, high;
  };
  for (const auto& [ones, count, low, high] : {Row{0, 10, 0, 0.3085},
                                               {1, 10, 0.0025, 0.4450},
                                               {5, 10, 0.1871, 0.8129},
                                               {1, 20, 0.0013, 0.2487},
                                               {8, 8, 0.6306, 1}}) {
    const Interval found = share_interval(count, static_cast<double>(ones) / count, 0.95);
    EXPECT_NEAR(found.low, low, 5.1e-5);
    EXPECT_NEAR(found.high, high, 5.1e-5);
  }
}

// The probability that the interval holds the share is summed over all numbers of ones, for 2 to 40 values.
TEST(Statistics, IntervalsOfSharesAreNeverTooNarrow) {
  for (const int count : {2, 8, 17, 40}) {
    for (const double share : {0.01, 0.1, 0.5, 0.62, 0.95, 0.999}) {
      double held = 0;
      for (int ones = 0; ones <= count; ++ones) {
        const auto [low, high] = share_interval(count, static_cast<double>(ones) / count, 0.95);
        if (low > share || share > high) continue;
        held += std::exp(std::lgamma(count + 1) - std::lgamma(ones + 1) - std::lgamma(count - ones + 1) +
                         ones * std::log(share) + (count - ones) * std::log1p(-share));
      }
      EXPECT_GE(held, 0.95) << count << ' ' << share;
    }
  }
}

TEST(Statistics, ValuesThatComeOneByOneAreOfTheSameKind) {
  const std::vector<std::vector<double>> all{{1, 1, 1}, {0, 1, 0}, {2, 2, 2}, {1, 2, 3}, {0, 0}, {1}};
  for (const bool is_share : {false, true}) {
    for (const std::vector<double>& values : all) {
      RunningEstimate running;
      for (const double value : values) running.add(value, is_share);
      EXPECT_EQ(running.estimate().values, estimate(values, is_share).values);
    }
  }
}

// NIST/SEMATECH e-Handbook of Statistical Methods, 1.3.6.7.2 (three decimals).
TEST(Statistics, HalfWidthsAreThoseOfThePrintedTable) {
  struct Row {
    int degrees_of_freedom;
    double at_90, at_95, at_98, at_99;  // two-sided confidence
  };
  const Row table[] = {{1, 6.314, 12.706, 31.821, 63.657}, {2, 2.920, 4.303, 6.965, 9.925},
                       {4, 2.132, 2.776, 3.747, 4.604},    {9, 1.833, 2.262, 2.821, 3.250},
                       {29, 1.699, 2.045, 2.462, 2.756},   {100, 1.660, 1.984, 2.364, 2.626}};
  for (const Row& row : table) {
    const Estimate unit{row.degrees_of_freedom + 1, 0, 1};
    EXPECT_NEAR(student_half_width(unit, 0.90), row.at_90, 5.1e-4);
    EXPECT_NEAR(student_half_width(unit, 0.95), row.at_95, 5.1e-4);
    EXPECT_NEAR(student_half_width(unit, 0.98), row.at_98, 5.1e-4);
    EXPECT_NEAR(student_half_width(unit, 0.99), row.at_99, 5.1e-4);
  }
}

// One degree of freedom is the Cauchy distribution: t = tan(pi confidence / 2).
TEST(Statistics, TwoValuesHaveCauchysInterval) {
  for (const double confidence : {0.6, 0.9, 0.999}) {
    const double exact = std::tan(std::acos(-1.0) * confidence / 2);
    EXPECT_NEAR(student_half_width({2, 0, 3}, confidence), 3 * exact, 1e-9 * exact);
  }
}

}  // namespace
}  // namespace peclet::runner
