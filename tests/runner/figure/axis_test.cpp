// Axes of figures, against tables written by hand. That the page has the same ticks:
// tests/pages/plot_test.py.
#include "runner/figure/axis.h"

#include <gtest/gtest.h>

#include <cmath>

namespace peclet::runner {
namespace {

using Numbers = std::vector<double>;

TEST(FigureAxis, IsLogarithmicWhereNumbersLieMoreEvenlyThen) {
  EXPECT_TRUE(is_logarithmic({1000, 1, 10, 100}));
  EXPECT_TRUE(is_logarithmic({2.2, 2.9, 4.1, 7.0, 21}));  // a viscosity towards jamming
  for (const Numbers& numbers : {Numbers{0.1, 0.2, 0.3, 0.4, 0.5, 0.6},
                                 {0.01, 1, 2, 3, 4},
                                 {5.7, 7.2, 7.8},  // less than a factor of five
                                 {0, 1, 10, 100, 1000},
                                 {-1, 1, 10, 100, 1000},
                                 {3},
                                 {}}) {
    EXPECT_FALSE(is_logarithmic(numbers));
  }
}

TEST(FigureAxis, HasAFewRoundNumbersWithinIt) {
  const auto ticks = [](bool log, double low, double high) {
    return Axis({low, high, log}, 0, 100, 9).ticks();
  };
  EXPECT_EQ(ticks(false, 0, 1), (Numbers{0, 0.2, 0.4, 0.6, 0.8, 1}));
  EXPECT_EQ(ticks(false, -1, 1), (Numbers{-1, -0.5, 0, 0.5, 1}));
  EXPECT_EQ(ticks(true, 0.1, 10000), (Numbers{0.1, 1, 10, 100, 1000, 10000}));
  EXPECT_EQ(ticks(true, 2.2, 21), (Numbers{2, 5, 10, 20}));
  EXPECT_EQ(ticks(true, 12, 60), (Numbers{20, 30, 40, 50, 60}));
  EXPECT_FALSE(std::signbit(ticks(false, 0, 1000).front()));
  for (const double low : {1e-9, 0.3, 9.99, 1e6}) {
    for (const double ratio : {1.0, 1.0001, 3.0, 9.5, 21.0, 1e5, 1e15}) {
      for (const bool log : {false, true}) {
        const Axis axis({low, low * ratio, log}, 0, 100, 8);
        EXPECT_GE(axis.ticks().size(), 2U) << low << ' ' << ratio;
        EXPECT_LE(axis.ticks().size(), 8U) << low << ' ' << ratio;
        for (const double tick : axis.ticks()) {
          EXPECT_GE(axis.place(tick), 0);
          EXPECT_LE(axis.place(tick), 100);
        }
      }
    }
  }
}

TEST(FigureAxis, PlacesEqualRatiosAtEqualDistances) {
  const Axis axis({1, 1000, true}, 0, 110, 9);  // a margin of a twentieth at both ends
  EXPECT_NEAR(axis.place(1), 5, 1e-12);
  EXPECT_NEAR(axis.place(10) - axis.place(1), 100 / 3.0, 1e-12);
  EXPECT_NEAR(axis.place(1000), 105, 1e-12);
  EXPECT_EQ(axis.clamped(-1), 0);
  EXPECT_EQ(axis.clamped(1e9), 110);
  EXPECT_EQ(axis.minor_ticks().size(), 2 + 3 * 8U);  // 0.8 and 0.9; from 2 to 9, 20 to 90 and 200 to 900
}

TEST(FigureAxis, HasWordsInTheMiddleOfEqualParts) {
  const Axis axis(4, 0, 100);
  EXPECT_EQ(axis.ticks(), (Numbers{0, 1, 2, 3}));
  EXPECT_EQ(axis.place(0), 12.5);
  EXPECT_EQ(axis.place(3), 87.5);
}

}  // namespace
}  // namespace peclet::runner
