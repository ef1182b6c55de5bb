// Text for terminals: how wide it is, and how it is broken into lines.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace peclet::runner {

// Without a terminal, or on one where nothing has to be left out.
constexpr std::size_t unlimited_width = static_cast<std::size_t>(-1);

// Columns that a UTF-8 text takes: one each character, none a mark on the letter before it, as in γ̇ (U+0300
// to U+036F).
std::size_t width_of(std::string_view text);

// Every line of `text` broken at blanks into lines of no more than `width` characters; a word that is longer
// stands alone. Each ends with a newline.
std::string folded(std::string_view text, std::size_t width);

}  // namespace peclet::runner
