#include "runner/watch.h"

#include <gtest/gtest.h>

namespace peclet::runner {
namespace {

TEST(Watch, WhatFitsIsShownAsItIs) {
  EXPECT_EQ(fitted("one\ntwo\n", 2, 3), "one\ntwo\n");
  EXPECT_EQ(fitted("one\n\ntwo", 3, 80), "one\n\ntwo\n");
  EXPECT_EQ(fitted("", 24, 80), "");
}

TEST(Watch, LongLinesAreCutAtACharacterAndSaySo) {
  EXPECT_EQ(fitted("5.66 ± 0.11\n", 24, 8), "5.66 ± …\n");
  EXPECT_EQ(fitted("± ± ±\n", 24, 5), "± ± ±\n");
  EXPECT_EQ(fitted("abc", 24, 1), "…\n");
}

TEST(Watch, LinesBelowTheScreenAreCounted) {
  EXPECT_EQ(fitted("a\nb\nc\nd\n", 3, 80), "a\nb\nand 2 more lines: `peclet status` has them\n");
  EXPECT_EQ(fitted("a\nb\nc\nd\n", 1, 10), "and 4 mor…\n");
}

}  // namespace
}  // namespace peclet::runner
