// Tests numbers for people. The expected digits follow by hand from two digits of the error.
#include "runner/campaign/number_text.h"

#include <gtest/gtest.h>

#include <cmath>

namespace peclet::runner {
namespace {

const double none = std::nan("");

TEST(NumberText, AValueHasTheDigitsThatItsErrorJustifies) {
  EXPECT_EQ(with_error(8.93123, 0.1234), "8.93 ± 0.12");
  EXPECT_EQ(with_error(8.9, 0.4), "8.90 ± 0.40");
  EXPECT_EQ(with_error(-0.01234, 0.000567), "-0.01234 ± 0.00057");
  EXPECT_EQ(with_error(57.3, 12), "57 ± 12");
  EXPECT_EQ(with_error(1234.5, 123), "1230 ± 120");
}

TEST(NumberText, OneThingIsNotCalledMany) {
  EXPECT_EQ(counted(0, "point"), "0 points");
  EXPECT_EQ(counted(1, "point"), "1 point");
  EXPECT_EQ(counted(2, "point"), "2 points");
}

TEST(NumberText, AnErrorThatRoundsUpToTheNextPowerOfTenKeepsTwoDigits) {
  EXPECT_EQ(with_error(5, 0.0996), "5.00 ± 0.10");
  EXPECT_EQ(with_error(5, 0.0994), "5.000 ± 0.099");
}

TEST(NumberText, VeryLargeAndVerySmallNumbersShareAPowerOfTen) {
  EXPECT_EQ(with_error(1.2346e-6, 1.2e-8), "(1.235 ± 0.012)e-6");
  EXPECT_EQ(with_error(3.45e9, 1.2e8), "(3.45 ± 0.12)e9");
}

TEST(NumberText, WhatDoesNotExistIsADash) {
  EXPECT_EQ(with_error(none, none), "-");
  EXPECT_EQ(with_error(8.931, none), "8.93 ± -");
  EXPECT_EQ(with_error(8.931, 0), "8.931 ± 0");
  EXPECT_EQ(percent(none), "-");
  EXPECT_EQ(percent(INFINITY), "-");
  EXPECT_EQ(rough(none), "-");
}

TEST(NumberText, SmallPercentagesHaveADecimal) {
  EXPECT_EQ(percent(0.0304), "3.0 %");
  EXPECT_EQ(percent(0.0996), "10 %");
  EXPECT_EQ(percent(1.5), "150 %");
}

}  // namespace
}  // namespace peclet::runner
