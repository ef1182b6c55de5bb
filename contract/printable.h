// Text from outside, made fit to be shown: a terminal obeys some characters, and nobody reads a megabyte.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace peclet {

// `text` with what cannot be shown on one line written as an escape: control characters (\n, \u001b), marks
// that turn the direction of writing (\u202e), and bytes that are no UTF-8 (\xff). Beyond `longest`
// characters its middle becomes "...", between words where it can, so that both ends can be recognised.
std::string printable(std::string_view text, std::size_t longest = std::string_view::npos);

// The same of every line of `text`, which stays a line of its own.
std::string printable_lines(std::string_view text);

}  // namespace peclet
