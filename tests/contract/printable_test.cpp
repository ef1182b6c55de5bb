#include <gtest/gtest.h>

#include "contract/errors.h"
#include "contract/json.h"
#include "contract/text.h"

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

}  // namespace
}  // namespace peclet
