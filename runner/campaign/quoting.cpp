#include "runner/campaign/quoting.h"

#include <fmt/format.h>

#include <string_view>

namespace peclet::runner {
std::string sbatch_word(const std::string& text) {
  if (is_plain(text)) return text;
  std::string word = "\"";
  for (const char c : text) {
    if (c == '%') word += '%';
    if (c == '"') word += '\\';
    word += c;
  }
  return word + '"';
}

std::string escaped(std::string_view text) {
  std::string safe;
  for (const char c : text) {
    switch (c) {
      case '&':
        safe += "&amp;";
        break;
      case '<':
        safe += "&lt;";
        break;
      case '>':
        safe += "&gt;";
        break;
      case '"':
        safe += "&quot;";
        break;
      case '\'':
        safe += "&#39;";
        break;
      default: {
        const bool is_control = static_cast<unsigned char>(c) < 0x20U && c != '\n' && c != '\t';
        safe += is_control || c == '\x7f' ? std::string("\xEF\xBF\xBD") : std::string(1, c);
      }
    }
  }
  return safe;
}

}  // namespace peclet::runner
