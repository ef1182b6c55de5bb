#include "contract/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

namespace peclet {
namespace {

struct Character {
  char32_t code = 0;
  std::size_t bytes = 0;  // 0: not UTF-8
};

bool continues(char byte) { return (static_cast<unsigned char>(byte) & 0xC0U) == 0x80U; }

// Returns the first character of `text`, which must not be empty (RFC 3629: shortest form, no surrogates).
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

// Returns false for controls, separators of lines, and marks that turn or hide the text beside them.
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

// Returns the characters of the text, or the escapes that replace them.
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

// Returns the first entries of the range that fit into `room` characters.
template <class Iterator>
std::vector<std::string> fitting(Iterator begin, Iterator end, std::size_t room) {
  std::vector<std::string> taken;
  for (; begin != end && width(*begin) <= room; ++begin) {
    room -= width(*begin);
    taken.push_back(*begin);
  }
  return taken;
}

// Removes the part of a word at the end, so that a list ends with a whole name. Parts beyond 36 characters,
// or half of the text, stay.
void drop_part_of_word(std::vector<std::string>& shown) {
  constexpr std::ptrdiff_t longest_word = 36;
  const auto most = std::min(longest_word, std::ssize(shown) / 2);
  const auto blank = std::find(shown.rbegin(), shown.rbegin() + most, " ");
  if (blank != shown.rbegin() + most) shown.erase(blank.base(), shown.end());
}

// Returns the optimal string alignment distance: Levenshtein's, with a swap of neighbours as one mistake.
std::size_t mistakes_between(std::string_view one, std::string_view other) {
  std::vector<std::size_t> before_last, last(other.size() + 1), now(other.size() + 1);
  for (std::size_t j = 0; j <= other.size(); ++j) last[j] = j;
  for (std::size_t i = 1; i <= one.size(); ++i) {
    now[0] = i;
    for (std::size_t j = 1; j <= other.size(); ++j) {
      const std::size_t replaced = last[j - 1] + (one[i - 1] == other[j - 1] ? 0 : 1);
      now[j] = std::min({replaced, last[j] + 1, now[j - 1] + 1});
      const bool swapped = i > 1 && j > 1 && one[i - 1] == other[j - 2] && one[i - 2] == other[j - 1];
      if (swapped) now[j] = std::min(now[j], before_last[j - 2] + 1);
    }
    before_last = last;
    last = now;
  }
  return last[other.size()];
}

}  // namespace

std::string printable(std::string_view text, std::size_t longest) {
  constexpr std::string_view gap = "...";
  constexpr std::size_t most_bytes = 4;  // of a character: bytes further inside are never shown
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

std::string nearest_name(std::string_view typed, const std::vector<std::string>& names) {
  std::string nearest;
  std::size_t fewest = 0;
  for (const std::string& name : names) {
    const std::size_t most = std::max<std::size_t>(1, name.size() / 3);
    // The difference in length is a lower bound of the mistakes.
    const auto [shorter, longer] = std::minmax({typed.size(), name.size()});
    if (longer - shorter > most) continue;
    const std::size_t mistakes = mistakes_between(typed, name);
    if (mistakes > most || (!nearest.empty() && mistakes >= fewest)) continue;
    nearest = name;
    fewest = mistakes;
  }
  return nearest;
}

std::string suggestion(std::string_view typed, const std::vector<std::string>& names) {
  const std::string nearest = nearest_name(typed, names);
  return nearest.empty() ? "" : "; did you mean " + nearest + "?";
}

std::string_view without_byte_order_mark(std::string_view text) {
  constexpr std::string_view mark = "\xef\xbb\xbf";
  if (text.starts_with(mark)) text.remove_prefix(mark.size());
  return text;
}

std::string_view take_line(std::string_view& text) {
  const std::size_t end = text.find('\n');
  std::string_view line = text.substr(0, end);
  text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  if (line.ends_with('\r')) line.remove_suffix(1);
  return line;
}

std::string_view take_word(std::string_view& line) {
  constexpr std::string_view blanks = " \t";
  line.remove_prefix(std::min(line.find_first_not_of(blanks), line.size()));
  const std::string_view word = line.substr(0, line.find_first_of(blanks));
  line.remove_prefix(word.size());
  return word;
}

bool is_blank(std::string_view text) { return text.find_first_not_of(" \t\r\n") == std::string_view::npos; }

}  // namespace peclet
