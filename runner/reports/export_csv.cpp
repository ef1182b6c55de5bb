// `peclet export --csv`: one row per point.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>

#include "runner/reports/export.h"
#include "runner/reports/point_estimates.h"
#include "runner/store/database_summary.h"
#include "runner/text/csv_line.h"

namespace peclet::runner {
namespace {

std::vector<std::string> look_fields(const std::optional<Look>& look) {
  if (!look) return std::vector<std::string>(10);
  return {look->verdict == Verdict::more ? "" : to_string(look->verdict),
          fmt::format("{}", look->seeds),
          fmt::format("{}", look->lost),
          fmt::format("{}", look->estimate.count),
          csv_number(look->controlled.mean),
          csv_number(look->controlled.standard_error),
          csv_number(look->controlled_half_width),
          csv_number(look->estimate.mean),
          csv_number(look->estimate.standard_error),
          csv_number(look->half_width)};
}

std::vector<std::string> full_fields(const PointSummary& point) {
  return {fmt::format("{}", point.so_far.count),   csv_number(point.so_far.mean),
          csv_number(point.so_far.standard_error), fmt::format("{}", point.surplus()),
          csv_number(point.counts.cpu_seconds),    point.point.suspect ? "1" : "0",
          point.endings.has_jammed() ? "1" : "0"};
}

void append(std::vector<std::string>& fields, const std::vector<std::string>& more) {
  fields.insert(fields.end(), more.begin(), more.end());
}

// Three columns for each scalar quantity of any point; one that has another unit elsewhere has others there.
class ScalarColumns {
 public:
  void add(std::size_t row, const std::vector<QuantityEstimate>& estimates) {
    for (const QuantityEstimate& found : estimates) {
      // What is not described has no unit, and shares its column with what is described as a number.
      const std::string unit = found.quantity.unit.empty() ? "1" : found.quantity.unit;
      columns_[{found.quantity.name, unit}][row] = found.estimates.front();
    }
  }
  // `others` are the titles of the columns before these.
  std::vector<std::string> titles(const std::vector<std::string>& others) const {
    std::vector<std::string> titles;
    for (const auto& [quantity, rows] : columns_) {
      const std::string title = title_of(quantity.first, quantity.second, others);
      append(titles, {title, title + " standard_error", title + " count"});
    }
    return titles;
  }
  std::vector<std::string> fields(std::size_t row) const {
    std::vector<std::string> fields;
    for (const auto& [quantity, rows] : columns_) {
      const auto found = rows.find(row);
      if (found == rows.end()) {
        append(fields, {"", "", ""});
      } else {
        const Estimate& estimate = found->second;
        append(fields, {csv_number(estimate.mean), csv_number(estimate.standard_error),
                        fmt::format("{}", estimate.count)});
      }
    }
    return fields;
  }

 private:
  static std::string title_of(const std::string& name, const std::string& unit,
                              const std::vector<std::string>& others) {
    const bool is_taken = std::find(others.begin(), others.end(), name) != others.end();
    const std::string unambiguous = is_taken ? "quantity " + name : name;
    return csv_text(unit == "1" ? unambiguous : fmt::format("{} [{}]", unambiguous, unit));
  }

  std::map<std::pair<std::string, std::string>, std::map<std::size_t, Estimate>>
      columns_;  // by name and unit
};

}  // namespace

std::string export_csv(Database& database, bool canonical) {
  const TargetRecord target = database.campaign().target;
  const std::vector<PointRecord> points = database.points();
  std::vector<PointSummary> summaries;
  if (!canonical) summaries = summarise_points(database, target);
  const SettingColumns settings(points);
  std::vector<std::string> titles{"label", "hash"};
  append(titles, settings.titles());
  append(titles, {"verdict", "seeds", "lost", "count", "mean", "standard_error", "half_width",
                  "uncontrolled_mean", "uncontrolled_standard_error", "uncontrolled_half_width"});
  if (!canonical) {
    append(titles, {"so_far_count", "so_far_mean", "so_far_standard_error", "surplus", "cpu_seconds",
                    "suspect", "jammed"});
  }
  std::vector<std::vector<std::string>> rows;
  ScalarColumns scalars;
  NumberStore numbers(database.connection());
  for (const PointRecord& point : points) {
    std::vector<std::string> fields{csv_text(point.label), point.hash};
    append(fields, settings.fields(point));
    const std::optional<Look> look = checked_look(database, point, target);
    append(fields, look_fields(look));
    if (!canonical) append(fields, full_fields(summaries[rows.size()]));
    scalars.add(rows.size(), scalar_estimates(numbers, point, look));
    rows.push_back(std::move(fields));
  }
  append(titles, scalars.titles(titles));
  std::string text = csv_line(titles);
  for (std::size_t row = 0; row < rows.size(); ++row) {
    append(rows[row], scalars.fields(row));
    text += csv_line(rows[row]);
  }
  return text;
}

}  // namespace peclet::runner
