#include "runner/text/folded_text.h"

#include <algorithm>

namespace peclet::runner {
namespace {

// The next line's worth of `rest`, which loses it and the blank behind it.
std::string_view taken_line(std::string_view& rest, std::size_t width) {
  std::size_t end = std::min(rest.find(' '), rest.size());
  while (end < rest.size()) {
    const std::size_t next = std::min(rest.find(' ', end + 1), rest.size());
    if (width_of(rest.substr(0, next)) > width) break;
    end = next;
  }
  const std::string_view line = rest.substr(0, end);
  rest.remove_prefix(std::min(end + 1, rest.size()));
  return line;
}

}  // namespace

std::size_t width_of(std::string_view text) {
  return static_cast<std::size_t>(std::count_if(
      text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }));
}

std::string folded(std::string_view text, std::size_t width) {
  std::string lines;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    if (width_of(line) <= width) {
      lines += std::string(line) + '\n';
      continue;
    }
    while (!line.empty()) lines += std::string(taken_line(line, width)) + '\n';
  }
  return lines;
}

}  // namespace peclet::runner
