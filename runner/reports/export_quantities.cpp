// `peclet export --long`: one row per point, quantity and element.
#include <fmt/format.h>

#include <algorithm>

#include "runner/reports/export.h"
#include "runner/reports/point_estimates.h"
#include "runner/store/database_summary.h"
#include "runner/text/csv_line.h"

namespace peclet::runner {
namespace {

using Fields = std::vector<std::string>;

struct Point {
  Fields which;  // label, hash, settings
  std::vector<QuantityEstimate> estimates;
};

std::string value_field(const Json& value) {
  return value.is_string() ? csv_text(value.get<std::string>()) : canonical_json(value);
}

// Name, unit and value of each axis at an element, the last axis running fastest; empty beyond the last axis.
Fields place_fields(const Quantity& quantity, std::size_t element, std::size_t most_axes) {
  Fields fields(3 * most_axes);
  for (std::size_t axis = quantity.axes.size(); axis-- > 0;) {
    const QuantityAxis& along = quantity.axes[axis];
    fields[3 * axis] = csv_text(along.name);
    fields[3 * axis + 1] = csv_text(along.unit);
    fields[3 * axis + 2] = value_field(along.values[element % along.values.size()]);
    element /= along.values.size();
  }
  return fields;
}

Fields number_fields(const QuantityEstimate& found, std::size_t element, double confidence) {
  const Estimate& estimate = found.estimates[element];
  Fields fields{fmt::format("{}", estimate.count), csv_number(estimate.mean),
                csv_number(estimate.standard_error), csv_number(half_width(estimate, confidence))};
  if (found.uncontrolled.empty()) {
    fields.insert(fields.end(), {"", ""});
  } else {
    fields.push_back(csv_number(found.uncontrolled[element].mean));
    fields.push_back(csv_number(found.uncontrolled[element].standard_error));
  }
  return fields;
}

std::string row(const Fields& which, const Fields& quantity, const Fields& place, const Fields& numbers) {
  Fields fields = which;
  for (const Fields* more : {&quantity, &place, &numbers}) {
    fields.insert(fields.end(), more->begin(), more->end());
  }
  return csv_line(fields);
}

}  // namespace

std::string export_long_csv(Database& database) {
  const TargetRecord target = database.campaign().target;
  const std::vector<PointRecord> records = database.points();
  const SettingColumns settings(records);
  std::vector<Point> points;
  std::size_t most_axes = 1;
  for (const PointRecord& record : records) {
    Point point{{csv_text(record.label), record.hash}, {}};
    const Fields set = settings.fields(record);
    point.which.insert(point.which.end(), set.begin(), set.end());
    point.estimates = point_estimates(database, record, checked_look(database, record, target));
    for (const QuantityEstimate& found : point.estimates) {
      most_axes = std::max(most_axes, found.quantity.axes.size());
    }
    points.push_back(std::move(point));
  }
  Fields titles{"label", "hash"}, axes;
  const Fields set = settings.titles();
  titles.insert(titles.end(), set.begin(), set.end());
  for (std::size_t axis = 1; axis <= most_axes; ++axis) {
    for (const char* const what : {"axis_{}", "axis_{}_unit", "axis_{}_value"}) {
      axes.push_back(fmt::format(fmt::runtime(what), axis));
    }
  }
  std::string text = row(
      titles, {"quantity", "symbol", "unit", "estimator"}, axes,
      {"count", "mean", "standard_error", "half_width", "uncontrolled_mean", "uncontrolled_standard_error"});
  for (const Point& point : points) {
    for (const QuantityEstimate& found : point.estimates) {
      const Quantity& quantity = found.quantity;
      const Fields what{csv_text(quantity.name), csv_text(quantity.symbol), csv_text(quantity.unit),
                        estimator_of(quantity)};
      for (std::size_t k = 0; k < found.estimates.size(); ++k) {
        text += row(point.which, what, place_fields(quantity, k, most_axes),
                    number_fields(found, k, target.level()));
      }
    }
  }
  return text;
}

}  // namespace peclet::runner
