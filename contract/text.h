// Makes foreign texts printable, splits them into lines and words, and finds the known name that is nearest.
#pragma once

#include <charconv>
#include <concepts>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "contract/decimal.h"

namespace peclet {

// Returns `text` on one line, with escapes for control characters (\n, \u001b), marks that turn the direction
// of writing (\u202e), and bytes that are not UTF-8 (\xff). Of a text beyond `longest` characters the middle
// becomes "...", if possible between words.
std::string printable(std::string_view text, std::size_t longest = std::string_view::npos);

// Returns printable() of every line of `text`; line ends stay.
std::string printable_lines(std::string_view text);

// Returns the first of the names that differ from `typed` by the fewest wrong, missing, added or swapped
// letters. Returns "" if these are more than a third of the name's letters (or one letter, for short names).
std::string nearest_name(std::string_view typed, const std::vector<std::string>& names);

// Returns "; did you mean NAME?" with the nearest name, or "" if none is near.
std::string suggestion(std::string_view typed, const std::vector<std::string>& names);

// Returns the text without a byte-order mark of UTF-8 at its beginning.
std::string_view without_byte_order_mark(std::string_view text);

// Removes the first line from `text` and returns it without its end, "\n" or "\r\n".
std::string_view take_line(std::string_view& text);

// Removes the first word, up to a blank or tab, from `line` and returns it; "" if no word is left.
std::string_view take_word(std::string_view& line);

// Returns true if the text has only blanks, tabs and ends of lines.
bool is_blank(std::string_view text);

// Returns the number that the whole word spells, or nothing if it is not a number or not finite.
template <class Number>
requires std::integral<Number> || std::same_as<Number, double> std::optional<Number> number_in(
    std::string_view word) {
  if (word.size() > 1 && word[0] == '+' && word[1] != '-') word.remove_prefix(1);
  Number value{};
  std::from_chars_result read{};
  if constexpr (std::integral<Number>) {
    read = std::from_chars(word.data(), word.data() + word.size(), value);
  } else {
    read = read_double(word.data(), word.data() + word.size(), value);
  }
  if (read.ec != std::errc() || read.ptr != word.data() + word.size()) return std::nullopt;
  return value;
}

}  // namespace peclet
