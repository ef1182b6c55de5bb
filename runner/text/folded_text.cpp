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
  std::size_t width = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto byte = static_cast<unsigned char>(text[i]);
    const bool is_continued = (byte & 0xC0U) == 0x80U;
    const bool is_mark = byte == 0xCCU || (byte == 0xCDU && i + 1 < text.size() &&
                                           static_cast<unsigned char>(text[i + 1]) < 0xB0U);
    width += is_continued || is_mark ? 0 : 1;
  }
  return width;
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
