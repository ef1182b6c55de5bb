#include "contract/decimal.h"

#include <gtest/gtest.h>

#include <string>
#include <string_view>

namespace peclet {
namespace {

struct Read {
  std::string_view word;
  double value;
  std::string_view rest;
};

using Reader = std::from_chars_result (*)(const char*, const char*, double&);

class Decimals : public testing::TestWithParam<Reader> {};

TEST_P(Decimals, AreReadUpToTheFirstOtherCharacter) {
  for (const Read& expected : {Read{"1", 1, ""},
                               {"-2.5", -2.5, ""},
                               {".5x", .5, "x"},
                               {"5.", 5, ""},
                               {"1.5.2", 1.5, ".2"},
                               {"2e3", 2000, ""},
                               {"2E+3,", 2000, ","},
                               {"-1e-2]", -.01, "]"},
                               {"1e", 1, "e"},
                               {"1e+x", 1, "e+x"},
                               {"0x10", 0, "x10"},
                               {"007", 7, ""},
                               {"0e999", 0, ""},
                               {"9007199254740993", 9007199254740992.0, ""},
                               {"4.9406564584124654e-324", 0x1p-1074, ""},
                               {"2.2250738585072014e-308", 0x1p-1022, ""},
                               {"1.7976931348623157e308", 0x1.fffffffffffffp1023, ""},
                               {"0.1 ", 0x1.999999999999ap-4, " "}}) {
    double value = 7.25;
    const char* const end = expected.word.data() + expected.word.size();
    const std::from_chars_result read = GetParam()(expected.word.data(), end, value);
    EXPECT_EQ(read.ec, std::errc()) << expected.word;
    EXPECT_EQ(value, expected.value) << expected.word;
    EXPECT_EQ(std::string(read.ptr, end), expected.rest) << expected.word;
  }
}

TEST_P(Decimals, AreNeitherWordsNorOutOfRange) {
  for (const std::string_view word :
       {"", "-", "+1", " 1", ".", "-.", "e5", ".e5", "x", "--1", "inf", "-inf", "nan", "infinity"}) {
    double value = 7.25;
    const std::from_chars_result read = GetParam()(word.data(), word.data() + word.size(), value);
    EXPECT_EQ(read.ec, std::errc::invalid_argument) << word;
    EXPECT_EQ(read.ptr, word.data()) << word;
    EXPECT_EQ(value, 7.25) << word;
  }
  for (const std::string_view word : {"1e999", "-1e309", "1e-999"}) {
    double value = 7.25;
    const std::from_chars_result read = GetParam()(word.data(), word.data() + word.size(), value);
    EXPECT_EQ(read.ec, std::errc::result_out_of_range) << word;
    EXPECT_EQ(value, 7.25) << word;
  }
}

INSTANTIATE_TEST_SUITE_P(BothWays, Decimals, testing::Values(&read_double, &read_double_by_strtod));

}  // namespace
}  // namespace peclet
