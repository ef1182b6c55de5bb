#include "runner/reports/point_estimates.h"

#include "runner/campaign/quoting.h"

namespace peclet::runner {

std::vector<QuantityEstimate> point_estimates(Database& database, const PointRecord& point,
                                              const std::optional<Look>& look) {
  QuantityEstimates estimates;
  if (look) {
    database.for_each_result(point.id, look->seeds, [&](int, const Json& result) { estimates.add(result); });
  }
  return estimates.estimates();
}

std::vector<QuantityEstimate> scalar_estimates(NumberStore& numbers, const PointRecord& point,
                                               const std::optional<Look>& look) {
  QuantityEstimates estimates(QuantityEstimates::Wanted::scalars);
  if (look) {
    numbers.for_each(point.id, look->seeds, [&](const NumberStore::Entry& seed) {
      estimates.add(seed.layout, seed.numbers, seed.has_jammed);
    });
  }
  return estimates.estimates();
}

SettingColumns::SettingColumns(const std::vector<PointRecord>& points) {
  for (const PointRecord& point : points) {
    for (const auto& [pointer, value] : point.settings.items()) pointers_.insert(pointer);
  }
}

std::vector<std::string> SettingColumns::fields(const PointRecord& point) const {
  std::vector<std::string> fields;
  for (const std::string& pointer : pointers_) {
    const Json value = point.settings.value(pointer, Json());
    fields.push_back(value.is_null()     ? ""
                     : value.is_string() ? csv_text(value.get<std::string>())
                                         : canonical_json(value));
  }
  return fields;
}

}  // namespace peclet::runner
