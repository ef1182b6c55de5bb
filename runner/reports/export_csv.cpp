// `peclet export --csv`: one row per point.
#include <fmt/format.h>

#include <cmath>
#include <set>
#include <string_view>

#include "runner/database/checked_look.h"
#include "runner/database/database_summary.h"
#include "runner/reports/export.h"

namespace peclet::runner {
namespace {

// As RFC 4180 quotes.
std::string quoted(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string field = "\"";
  for (const char c : text) field += c == '"' ? std::string("\"\"") : std::string(1, c);
  return field + '"';
}

// A spreadsheet takes a cell that begins so for a formula and would run it; behind an apostrophe it is text.
std::string text_field(const std::string& text) {
  const bool is_formula =
      !text.empty() && std::string_view("=+-@\t\r").find(text.front()) != std::string_view::npos;
  return is_formula ? "'" + text : text;
}

std::string number(double value) { return std::isfinite(value) ? canonical_json(value) : ""; }

std::string line(const std::vector<std::string>& fields) {
  std::string text;
  for (std::size_t i = 0; i < fields.size(); ++i) text += (i == 0 ? "" : ",") + quoted(fields[i]);
  return text + '\n';
}

std::vector<std::string> look_fields(const std::optional<Look>& look) {
  if (!look) return std::vector<std::string>(10);
  return {look->verdict == Verdict::more ? "" : to_string(look->verdict),
          fmt::format("{}", look->seeds),
          fmt::format("{}", look->lost),
          fmt::format("{}", look->estimate.count),
          number(look->controlled.mean),
          number(look->controlled.standard_error),
          number(look->controlled_half_width),
          number(look->estimate.mean),
          number(look->estimate.standard_error),
          number(look->half_width)};
}

std::vector<std::string> full_fields(const PointSummary& point) {
  return {fmt::format("{}", point.so_far.count), number(point.so_far.mean),
          number(point.so_far.standard_error),   fmt::format("{}", point.surplus()),
          number(point.counts.cpu_seconds),      point.point.suspect ? "1" : "0"};
}

void append(std::vector<std::string>& fields, const std::vector<std::string>& more) {
  fields.insert(fields.end(), more.begin(), more.end());
}

}  // namespace

std::string export_csv(Database& database, bool canonical) {
  const TargetRecord target = database.campaign().target;
  const std::vector<PointSummary> points = summarise_points(database, target);
  std::set<std::string> settings;
  for (const PointSummary& point : points) {
    for (const auto& [pointer, value] : point.point.settings.items()) settings.insert(pointer);
  }
  std::vector<std::string> titles{"label", "hash"};
  titles.insert(titles.end(), settings.begin(), settings.end());
  append(titles, {"verdict", "seeds", "lost", "count", "mean", "standard_error", "half_width",
                  "uncontrolled_mean", "uncontrolled_standard_error", "uncontrolled_half_width"});
  if (!canonical) {
    append(titles,
           {"so_far_count", "so_far_mean", "so_far_standard_error", "surplus", "cpu_seconds", "suspect"});
  }
  std::string text = line(titles);
  for (const PointSummary& point : points) {
    std::vector<std::string> fields{text_field(point.point.label), point.point.hash};
    for (const std::string& pointer : settings) {
      const Json value = point.point.settings.value(pointer, Json());
      fields.push_back(value.is_null()     ? ""
                       : value.is_string() ? text_field(value.get<std::string>())
                                           : canonical_json(value));
    }
    append(fields, look_fields(checked_look(database, point.point, target)));
    if (!canonical) append(fields, full_fields(point));
    text += line(fields);
  }
  return text;
}

}  // namespace peclet::runner
