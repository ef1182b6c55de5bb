#include "contract/shell_word.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

namespace peclet {
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

}  // namespace peclet
