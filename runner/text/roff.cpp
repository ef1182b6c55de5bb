#include "runner/text/roff.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>

namespace peclet::runner {
namespace {

// Reads one character of UTF-8 and moves `text` behind it.
std::uint32_t take_character(std::string_view& text) {
  const auto first = static_cast<unsigned char>(text.front());
  const std::size_t length = first < 0x80 ? 1 : first < 0xE0 ? 2 : first < 0xF0 ? 3 : 4;
  std::uint32_t code = length == 1 ? first : first & (0x7FU >> length);
  for (std::size_t i = 1; i < length && i < text.size(); ++i) {
    code = code << 6U | (static_cast<unsigned char>(text[i]) & 0x3FU);
  }
  text.remove_prefix(std::min(length, text.size()));
  return code;
}

std::string character(std::uint32_t code, bool is_code) {
  switch (code) {
    case '\\':
      return "\\e";
    case '-':
      return is_code ? "\\-" : "-";
    case '\'':
      return is_code ? "\\(aq" : "'";
    case '`':
      return "\\(ga";
    case '^':
      return "\\(ha";
    case '~':
      return "\\(ti";
    default:
      return code < 0x80 ? std::string(1, static_cast<char>(code)) : fmt::format("\\[u{:04X}]", code);
  }
}

// A line that begins with a dot or an apostrophe would be a request.
std::string guarded(const std::string& line) {
  return line.starts_with('.') || line.starts_with('\'') ? "\\&" + line : line;
}

}  // namespace

std::string roff_text(std::string_view text) {
  std::string line;
  bool bold = false;
  while (!text.empty()) {
    const std::uint32_t code = take_character(text);
    if (code == '`') {
      bold = !bold;
      line += bold ? "\\fB" : "\\fR";
    } else {
      // An option's hyphens are part of a command wherever they stand.
      const bool is_option = code == '-' && (text.starts_with("-") || line.ends_with("\\-"));
      line += character(code, bold || is_option);
    }
  }
  return guarded(line);
}

std::string roff_code(std::string_view text) {
  std::string line;
  while (!text.empty()) line += character(take_character(text), true);
  return guarded(line);
}

}  // namespace peclet::runner
