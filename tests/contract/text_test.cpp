#include "contract/text.h"

#include <gtest/gtest.h>

#include <cstdint>

#include "contract/errors.h"
#include "contract/json.h"

namespace peclet {
namespace {

TEST(Printable, WhatATerminalCanShowStaysAsItIs) {
  for (const char* text : {"", "a b", "äöü", "größer als 5 µm, η → ∞", "\U0001D702", "\u201cquoted\u201d",
                           "日本", "x\\n", "\U0001F600"})
    EXPECT_EQ(printable(text), text);
}

TEST(Printable, WhatATerminalObeysIsEscaped) {
  EXPECT_EQ(printable("a\nb\tc\rd"), "a\\nb\\tc\\rd");
  EXPECT_EQ(printable("\x1b[31mred\x07"), "\\u001b[31mred\\u0007");
  EXPECT_EQ(printable(std::string("a\0b", 3)), "a\\u0000b");
  EXPECT_EQ(printable("\x7f"), "\\u007f");
  EXPECT_EQ(printable("\xc2\x9b"
                      "2J"),
            "\\u009b2J");  // CSI as one character, U+009B
  EXPECT_EQ(printable("\u202e"
                      "evil\u2066"),
            "\\u202eevil\\u2066");  // change of writing direction
  EXPECT_EQ(printable("a\u2028b"), "a\\u2028b");
}

TEST(Printable, WhatIsNoUtf8IsShownByteByByte) {
  EXPECT_EQ(printable("\xff"), "\\xff");
  EXPECT_EQ(printable("\xc3"), "\\xc3");                             // truncated
  EXPECT_EQ(printable("\xc0\x8a"), "\\xc0\\x8a");                    // an overlong newline
  EXPECT_EQ(printable("\xed\xa0\x80"), "\\xed\\xa0\\x80");           // a surrogate
  EXPECT_EQ(printable("\xf4\x90\x80\x80"), "\\xf4\\x90\\x80\\x80");  // beyond U+10FFFF
  EXPECT_EQ(printable("\xe2(\xa1"), "\\xe2(\\xa1");
}

TEST(Printable, ALongTextLosesItsMiddleNotItsEnds) {
  EXPECT_EQ(printable("0123456789", 10), "0123456789");
  EXPECT_EQ(printable("0123456789A", 10), "01234...9A");
  const std::string vast = "begin" + std::string(8'000'000, 'x') + "end";
  const std::string shown = printable(vast, 60);
  EXPECT_EQ(shown.size(), 60U);
  EXPECT_TRUE(shown.starts_with("begin") && shown.ends_with("end")) << shown;
  // The limit counts characters, not bytes, and cuts between them.
  std::string umlauts;
  for (int i = 0; i < 1000; ++i) umlauts += "ä";
  EXPECT_EQ(printable(umlauts, 11), "ääääää...ää");
  // An escape is kept or left out as a whole.
  EXPECT_EQ(printable(std::string(100, '\x01'), 12), "\\u0001...");
}

TEST(Printable, AListIsCutBetweenItsNames) {
  std::string list = "must be one of: ";
  for (int i = 0; i < 100; ++i) list += "quantity_" + std::to_string(1000 + i) + ", ";
  const std::string shown = printable(list + "last_quantity", 120);
  EXPECT_LE(shown.size(), 120U);
  const std::size_t gap = shown.find("...");
  EXPECT_EQ(shown.substr(gap - 2, 2), ", ") << shown;
  EXPECT_EQ(shown.substr(gap + 3, 10), " quantity_") << shown;
}

TEST(Printable, LinesStayLines) { EXPECT_EQ(printable_lines("a\x1b\nb\tc\n"), "a\\u001b\nb\\tc\n"); }

std::size_t characters(const std::string& text) {
  std::size_t count = 0;
  for (const char c : text) count += (static_cast<unsigned char>(c) & 0xC0U) != 0x80U ? 1 : 0;
  return count;
}

TEST(InputError, IsOneShortLineWhateverItQuotes) {
  for (const std::string& given : {std::string(1'000'000, 'x'), std::string(1'000'000, '\x1b'),
                                   std::string(999'999, '\xe4'), std::string("\n\r\n")}) {
    const InputError error(given, "/" + given, given, "must not be " + given);
    const std::string message = error.what();
    EXPECT_LE(characters(message), longest_message);
    EXPECT_EQ(message.find_first_of("\n\r\x1b"), std::string::npos);
    EXPECT_NO_THROW(Json(message).dump()) << "not UTF-8";
    EXPECT_LE(characters(error.within(given, "/scene").what()), longest_message);
    EXPECT_TRUE(error.within("f", "/scene").pointer().starts_with("/scene/"));
  }
}

const std::vector<std::string> keys{"particles", "volume_fraction", "fluid", "flow", "contact"};

TEST(NearestName, IsTheOneWithFewestMistakes) {
  EXPECT_EQ(nearest_name("volume_fracton", keys), "volume_fraction");    // a letter is missing
  EXPECT_EQ(nearest_name("volume_fractionn", keys), "volume_fraction");  // one too many
  EXPECT_EQ(nearest_name("partikles", keys), "particles");               // a wrong one
  EXPECT_EQ(nearest_name("contcat", keys), "contact");                   // two swapped
  EXPECT_EQ(nearest_name("flwo", keys), "flow");                         // one mistake, a third of 4 letters
  EXPECT_EQ(nearest_name("run", {"ran", "rum"}), "ran");                 // first of equals
}

TEST(NearestName, NothingFarFetchedIsOffered) {
  EXPECT_EQ(nearest_name("seeds", keys), "");
  EXPECT_EQ(nearest_name("fl", keys), "");
  EXPECT_EQ(nearest_name("", keys), "");
  EXPECT_EQ(nearest_name("flow", {}), "");
  EXPECT_EQ(suggestion("seeds", keys), "");
  EXPECT_EQ(suggestion("fliud", keys), "; did you mean fluid?");
}

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
