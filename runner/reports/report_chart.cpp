#include "runner/reports/report_chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <set>

#include "runner/text/number_text.h"
#include "runner/text/point_columns.h"

namespace peclet::runner {
namespace {

std::optional<double> number(const std::string& text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

// The columns of the points, as the table has them.
class Sweep {
 public:
  explicit Sweep(const std::vector<PointSummary>& points) : columns_(labels(points)), rows_(points.size()) {}

  std::size_t count() const { return columns_.count(); }
  const std::string& title(std::size_t column) const { return columns_.titles()[column]; }
  const std::string& cell(std::size_t row, std::size_t column) const { return columns_.cells(row)[column]; }

  // How many values a column has; nothing when some are no numbers.
  std::size_t numbers(std::size_t column) const {
    std::set<double> values;
    for (std::size_t row = 0; row < rows_; ++row) {
      const std::optional<double> value = number(cell(row, column));
      if (!value) return 0;
      values.insert(*value);
    }
    return values.size();
  }

  std::optional<std::size_t> variable() const {
    std::optional<std::size_t> best;
    std::size_t most = 1;
    for (std::size_t column = 0; column < count(); ++column) {
      if (const std::size_t values = numbers(column); values > most) {
        best = column;
        most = values;
      }
    }
    return best;
  }

  // Whether `variable` says what `column` is.
  bool is_in_step(std::size_t column, std::size_t variable) const {
    std::map<std::string, std::string> partner;
    for (std::size_t row = 0; row < rows_; ++row) {
      const auto [known, is_new] = partner.emplace(cell(row, variable), cell(row, column));
      if (!is_new && known->second != cell(row, column)) return false;
    }
    return true;
  }

 private:
  static std::vector<std::string> labels(const std::vector<PointSummary>& points) {
    std::vector<std::string> found;
    found.reserve(points.size());
    for (const PointSummary& point : points) found.push_back(point.point.label);
    return found;
  }

  PointColumns columns_;
  std::size_t rows_;
};

// The interval of the last look; before the first one, the mean of the seeds that have ended, and its error.
std::optional<ChartPoint> chart_point(const PointSummary& point, double x) {
  using Kind = ChartPoint::Kind;
  const auto made = [&](double mean, double error, Kind kind) {
    return ChartPoint{x, mean, error, kind,
                      fmt::format("{}: {}", point.point.label, with_error(mean, error))};
  };
  if (point.looks.empty()) {
    if (point.so_far.count < 2) return std::nullopt;
    return made(point.so_far.mean, point.so_far.standard_error, Kind::provisional);
  }
  const Look& look = point.looks.back();
  if (!std::isfinite(look.controlled.mean) || !std::isfinite(look.controlled_half_width)) return std::nullopt;
  return made(look.controlled.mean, look.controlled_half_width,
              is_converged(look.verdict) ? Kind::decided : Kind::undecided);
}

std::string series_name(const Sweep& sweep, std::size_t row, const std::vector<std::size_t>& columns) {
  std::string name;
  for (const std::size_t column : columns) {
    name += (name.empty() ? "" : ", ") + sweep.title(column) + " = " + sweep.cell(row, column);
  }
  return name;
}

}  // namespace

ReportChart report_chart(const std::vector<PointSummary>& points, const std::string& observable) {
  const Sweep sweep(points);
  const std::optional<std::size_t> variable = sweep.variable();
  if (points.size() < 2) return {std::nullopt, ""};
  if (!variable) {
    return {std::nullopt, "There is no chart, because no swept variable is a number at every point."};
  }
  std::vector<std::size_t> others;
  for (std::size_t column = 0; column < sweep.count(); ++column) {
    if (column != *variable && !sweep.is_in_step(column, *variable)) others.push_back(column);
  }
  Chart chart{sweep.title(*variable), observable, {}};
  std::size_t absent = 0;
  for (std::size_t row = 0; row < points.size(); ++row) {
    std::optional<ChartPoint> drawn = chart_point(points[row], *number(sweep.cell(row, *variable)));
    if (!drawn) {
      ++absent;
      continue;
    }
    const std::string name = series_name(sweep, row, others);
    auto series = std::find_if(chart.series.begin(), chart.series.end(),
                               [&](const ChartSeries& known) { return known.name == name; });
    if (series == chart.series.end()) series = chart.series.insert(series, {name, {}});
    series->points.push_back(std::move(*drawn));
  }
  if (chart.series.empty())
    return {std::nullopt, "There is no chart yet, because no point has two seeds that have ended."};
  if (chart.series.size() > most_series) {
    return {std::nullopt,
            fmt::format("There is no chart, because it would need {} curves.", chart.series.size())};
  }
  for (ChartSeries& series : chart.series) {
    std::stable_sort(series.points.begin(), series.points.end(),
                     [](const ChartPoint& a, const ChartPoint& b) { return a.x < b.x; });
  }
  ReportChart made{std::move(chart), ""};
  if (absent > 0) {
    made.note = fmt::format("{} point{} without an error {} not drawn.", absent, absent == 1 ? "" : "s",
                            absent == 1 ? "is" : "are");
  }
  return made;
}

}  // namespace peclet::runner
