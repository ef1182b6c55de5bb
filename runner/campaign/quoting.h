// Texts put where somebody else reads them: people, a shell, a batch system, HTML, CSV.
#pragma once

#include <cmath>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "contract/json.h"
#include "contract/text.h"

namespace peclet::runner {

// Words of strangers (an engine, a file) as they may be shown to people.
constexpr std::size_t longest_plain_text = 240;

// One line that no terminal obeys, of no more than `most` characters: see printable().
inline std::string plain(std::string_view text, std::size_t most = longest_plain_text) {
  return printable(text, most);
}

// The last part of a file's name, as plain(), shorter.
inline std::string plain_name(const std::filesystem::path& path) {
  constexpr std::size_t longest = 80;
  return plain(path.filename().string(), longest);
}

// Values put where somebody else parses them: one function for each reader.
//
// Consists of characters that shells and batch systems take as they are.
bool is_plain(const std::string& text);

// Some character below space, or DEL: nothing that a path in a line of text may have.
bool has_control_characters(const std::string& text);

// One word of a shell; plain text stays as it is. Control characters become $'...', which bash, zsh and ksh
// know.
std::string shell_word(const std::string& text);

// The value of an option in a line `#SBATCH ...`, or a part of it, in which % begins a pattern (%a) of
// Slurm's. (sbatch keeps a blank between double quotes, and not behind a backslash.) Requires neither control
// characters nor a backslash, after which Slurm replaces no pattern at all.
std::string sbatch_word(const std::string& text);

// Text in HTML.
//
// `text` as it is to be read, inside an element or an attribute in quotes. Control characters that HTML does
// not allow become U+FFFD.
std::string escaped(std::string_view text);

// Lines of the tables that `peclet export` prints for spreadsheets.
//
// As RFC 4180 quotes.
inline std::string csv_quoted(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string field = "\"";
  for (const char c : text) field += c == '"' ? std::string("\"\"") : std::string(1, c);
  return field + '"';
}

// A spreadsheet takes a cell that begins so for a formula and would run it; behind an apostrophe it is text.
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
