// Lines, words and numbers of texts as people and their programs save them.
//
// A text may begin with a byte-order mark, its lines may end as on Windows, and a number may have a plus
// sign.
#pragma once

#include <charconv>
#include <cmath>
#include <concepts>
#include <optional>
#include <string_view>

namespace peclet {

// Returns the text without the byte-order mark of UTF-8 that it may begin with.
std::string_view without_byte_order_mark(std::string_view text);

// Takes the first line off `text` and returns it without its end, "\n" or "\r\n".
std::string_view take_line(std::string_view& text);

// Takes the first word off `line`; words are parted by blanks and tabs. Returns an empty word if none is
// left.
std::string_view take_word(std::string_view& line);

// Whether nothing but blanks and ends of lines is left.
bool is_blank(std::string_view text);

// Returns the number that `word` is, as a whole, or nothing if it is none or is not finite.
template <class Number>
requires std::integral<Number> || std::floating_point<Number> std::optional<Number> number_in(
    std::string_view word) {
  if (word.size() > 1 && word[0] == '+' && word[1] != '-') word.remove_prefix(1);
  Number value{};
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || end != word.data() + word.size()) return std::nullopt;
  if constexpr (std::floating_point<Number>) {
    if (!std::isfinite(value)) return std::nullopt;
  }
  return value;
}

}  // namespace peclet
