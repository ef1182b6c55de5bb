// Texts from outside: fit to be shown, split into lines and words, compared with known names.
#pragma once

#include <charconv>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace peclet {

// Returns `text` with what cannot be shown on one line written as an escape: control characters (\n, \u001b),
// marks that turn the direction of writing (\u202e), and bytes that are no UTF-8 (\xff). Beyond `longest`
// characters its middle becomes "...", between words where it can, so that both ends can be recognised.
std::string printable(std::string_view text, std::size_t longest = std::string_view::npos);

// The same of every line of `text`, which stays a line of its own.
std::string printable_lines(std::string_view text);

// Returns the name that `typed` becomes with the fewest wrong, missing, added or swapped letters, the first
// of several; "" when each needs more of them than a third of its letters (at least one), so that nothing
// far-fetched is offered.
std::string nearest_name(std::string_view typed, const std::vector<std::string>& names);

// "; did you mean NAME?", or nothing when there is no such name.
std::string suggestion(std::string_view typed, const std::vector<std::string>& names);

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
