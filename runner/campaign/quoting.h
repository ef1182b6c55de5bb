// Quotes texts for their readers: people, a shell, a batch system, HTML, CSV.
#pragma once

#include <cmath>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "contract/json.h"
#include "contract/shell_word.h"
#include "contract/text.h"

namespace peclet::runner {

// The usual length of foreign text (of an engine, a file) that is shown to people.
constexpr std::size_t longest_plain_text = 240;

// Returns the text on one line of at most `most` characters, without control characters: see printable().
inline std::string plain(std::string_view text, std::size_t most = longest_plain_text) {
  return printable(text, most);
}

// Returns the last part of a path as plain(), with at most 80 characters.
inline std::string plain_name(const std::filesystem::path& path) {
  constexpr std::size_t longest = 80;
  return plain(path.filename().string(), longest);
}

// Returns the value of an option on a line `#SBATCH ...`, or a part of it. A % is doubled, because it begins
// one of Slurm's patterns (%a). Double quotes keep a blank for sbatch; a backslash does not. Requires a text
// without control characters and backslashes: after a backslash Slurm replaces no pattern.
std::string sbatch_word(const std::string& text);

// Returns the text for HTML, inside an element or a quoted attribute. Control characters that HTML does not
// allow become U+FFFD.
std::string escaped(std::string_view text);

// Returns the text as a field of CSV, quoted as in RFC 4180.
inline std::string csv_quoted(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string field = "\"";
  for (const char c : text) field += c == '"' ? std::string("\"\"") : std::string(1, c);
  return field + '"';
}

// Returns the text with an apostrophe before it if a spreadsheet would run it as a formula.
inline std::string csv_text(const std::string& text) {
  const bool is_formula =
      !text.empty() && std::string_view("=+-@\t\r").find(text.front()) != std::string_view::npos;
  return is_formula ? "'" + text : text;
}

inline std::string csv_number(double value) { return std::isfinite(value) ? canonical_json(value) : ""; }

inline std::string csv_line(const std::vector<std::string>& fields) {
  std::string text;
  for (std::size_t i = 0; i < fields.size(); ++i) text += (i == 0 ? "" : ",") + csv_quoted(fields[i]);
  return text + '\n';
}

}  // namespace peclet::runner
