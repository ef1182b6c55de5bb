#include "contract/printable.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

namespace peclet {
namespace {

struct Character {
  char32_t code = 0;
  std::size_t bytes = 0;  // 0: no UTF-8 begins here
};

bool continues(char byte) { return (static_cast<unsigned char>(byte) & 0xC0U) == 0x80U; }

// The character at the beginning of `text`, which is not empty (RFC 3629: the shortest form, no surrogates).
Character first_of(std::string_view text) {
  const auto lead = static_cast<unsigned char>(text.front());
  if (lead < 0x80U) return {lead, 1};
  const std::size_t bytes = lead >= 0xF0U ? 4 : lead >= 0xE0U ? 3 : 2;
  if (lead < 0xC2U || lead > 0xF4U || text.size() < bytes) return {};
  char32_t code = lead & (0x7FU >> bytes);
  for (std::size_t i = 1; i < bytes; ++i) {
    if (!continues(text[i])) return {};
    code = (code << 6U) | (static_cast<unsigned char>(text[i]) & 0x3FU);
  }
  constexpr std::array<char32_t, 5> smallest{0, 0, 0x80, 0x800, 0x10000};
  const bool is_surrogate = code >= 0xD800 && code < 0xE000;
  return code < smallest.at(bytes) || is_surrogate || code > 0x10FFFF ? Character{} : Character{code, bytes};
}

// Controls, separators of lines, and marks that turn or hide what stands beside them.
bool can_be_shown(char32_t code) {
  constexpr std::array<std::pair<char32_t, char32_t>, 8> hidden{{{0x00, 0x1F},
                                                                 {0x7F, 0x9F},
                                                                 {0x200B, 0x200F},
                                                                 {0x2028, 0x202E},
                                                                 {0x061C, 0x061C},
                                                                 {0x2060, 0x206F},
                                                                 {0xFEFF, 0xFEFF},
                                                                 {0xE0000, 0xE007F}}};
  return std::none_of(hidden.begin(), hidden.end(),
                      [&](const auto& range) { return code >= range.first && code <= range.second; });
}

std::string escape(char32_t code) {
  if (code == '\n') return "\\n";
  if (code == '\r') return "\\r";
  if (code == '\t') return "\\t";
  return fmt::format("\\u{:04x}", static_cast<unsigned>(code));
}

// One entry for each character or escape.
std::vector<std::string> shown_characters(std::string_view text) {
  std::vector<std::string> shown;
  while (!text.empty()) {
    const Character next = first_of(text);
    const std::size_t bytes = std::max<std::size_t>(1, next.bytes);
    if (next.bytes == 0) {
      shown.push_back(fmt::format("\\x{:02x}", static_cast<unsigned char>(text.front())));
    } else {
      shown.push_back(can_be_shown(next.code) ? std::string(text.substr(0, bytes)) : escape(next.code));
    }
    text.remove_prefix(bytes);
  }
  return shown;
}

std::size_t width(const std::string& shown) {
  return static_cast<std::size_t>(
      std::count_if(shown.begin(), shown.end(), [](char c) { return !continues(c); }));
}

// As many of the range's first entries as fit into `room`.
template <class Iterator>
std::vector<std::string> fitting(Iterator begin, Iterator end, std::size_t room) {
  std::vector<std::string> taken;
  for (; begin != end && width(*begin) <= room; ++begin) {
    room -= width(*begin);
    taken.push_back(*begin);
  }
  return taken;
}

// Drops the part of a word at the cut, so that a list ends with a whole name. Longer words are cut.
void drop_part_of_word(std::vector<std::string>& shown) {
  constexpr std::ptrdiff_t longest_word = 36;
  const auto most = std::min(longest_word, std::ssize(shown) / 2);
  const auto blank = std::find(shown.rbegin(), shown.rbegin() + most, " ");
  if (blank != shown.rbegin() + most) shown.erase(blank.base(), shown.end());
}

}  // namespace

std::string printable(std::string_view text, std::size_t longest) {
  constexpr std::string_view gap = "...";
  constexpr std::size_t most_bytes = 4;  // of a character: what lies further inside than this is never shown
  const bool is_vast = longest < text.size() / (2 * most_bytes);
  std::vector<std::string> head = shown_characters(is_vast ? text.substr(0, most_bytes * longest) : text);
  std::size_t all = 0;
  for (const std::string& shown : head) all += width(shown);
  std::string line;
  if (!is_vast && all <= longest) {
    for (const std::string& shown : head) line += shown;
    return line;
  }
  const std::vector<std::string> tail =
      is_vast ? shown_characters(text.substr(text.size() - most_bytes * longest)) : head;
  const std::size_t room = longest - std::min(longest, gap.size());
  std::vector<std::string> last = fitting(tail.rbegin(), tail.rend(), room / 3);
  std::vector<std::string> first = fitting(head.begin(), head.end(), room - room / 3);
  drop_part_of_word(first);
  drop_part_of_word(last);
  for (const std::string& shown : first) line += shown;
  line += gap;
  std::for_each(last.rbegin(), last.rend(), [&](const std::string& shown) { line += shown; });
  return line;
}

std::string printable_lines(std::string_view text) {
  std::string lines;
  for (;;) {
    const std::size_t end = text.find('\n');
    lines += printable(text.substr(0, end));
    if (end == std::string_view::npos) return lines;
    lines += '\n';
    text.remove_prefix(end + 1);
  }
}

}  // namespace peclet
