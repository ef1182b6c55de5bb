#include <gtest/gtest.h>

#include <cstdint>

#include "contract/text.h"

namespace peclet {
namespace {

TEST(TextLines, EndAsOnAnySystem) {
  std::string_view text = without_byte_order_mark("\xef\xbb\xbfone\r\ntwo\n\nthree");
  for (const char* line : {"one", "two", "", "three", ""}) EXPECT_EQ(take_line(text), line);
  EXPECT_EQ(without_byte_order_mark("\xef\xbbone"), "\xef\xbbone");
}

TEST(TextLines, HaveWords) {
  std::string_view line = " \ta  bc\t";
  for (const char* word : {"a", "bc", "", ""}) EXPECT_EQ(take_word(line), word);
  EXPECT_TRUE(is_blank(" \t\r\n") && is_blank(""));
  EXPECT_FALSE(is_blank(" x"));
}

TEST(TextLines, HaveNumbersThatAreFinite) {
  EXPECT_EQ(number_in<double>("+1.5"), 1.5);
  EXPECT_EQ(number_in<double>("-2e-3"), -2e-3);
  EXPECT_EQ(number_in<std::int32_t>("+7"), 7);
  EXPECT_EQ(number_in<std::uint64_t>("18446744073709551615"), ~std::uint64_t{0});
  for (const char* word : {"", "+", "+-1", "++1", "1,5", "1.5x", " 1", "nan", "inf", "1e999", "0x10"}) {
    EXPECT_FALSE(number_in<double>(word)) << word;
  }
  EXPECT_FALSE(number_in<std::uint32_t>("-1") || number_in<std::int32_t>("2147483648"));
}

}  // namespace
}  // namespace peclet
