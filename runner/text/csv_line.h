// Lines of the tables that `peclet export` prints for spreadsheets.
#pragma once

#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include "contract/json.h"

namespace peclet::runner {

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
