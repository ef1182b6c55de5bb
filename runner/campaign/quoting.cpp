#include "runner/campaign/quoting.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

namespace peclet::runner {
namespace {

bool is_control(char c) {
  const auto byte = static_cast<unsigned char>(c);
  return byte < 0x20 || byte == 0x7f;
}

// Returns true for bytes of letters beyond ASCII, too: no shell gives them a meaning.
bool is_plain_character(char c) {
  constexpr std::string_view signs = "_@+=:,./-";
  const auto byte = static_cast<unsigned char>(c);
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || byte >= 0x80 ||
         signs.find(c) != std::string_view::npos;
}

}  // namespace

bool is_plain(const std::string& text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), is_plain_character);
}

bool has_control_characters(const std::string& text) {
  return std::any_of(text.begin(), text.end(), is_control);
}

std::string shell_word(const std::string& text) {
  if (is_plain(text)) return text;
  const bool escapes = has_control_characters(text);
  std::string word = escapes ? "$'" : "'";
  for (const char c : text) {
    if (is_control(c)) {
      word += fmt::format("\\{:03o}", static_cast<unsigned char>(c));
    } else if (c == '\'') {
      word += escapes ? "\\'" : "'\\''";
    } else if (c == '\\' && escapes) {
      word += "\\\\";
    } else {
      word += c;
    }
  }
  return word + "'";
}

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
