// Estimates of every quantity of a point, and the columns that say which point it is.
#pragma once

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "runner/statistics/quantity_estimates.h"
#include "runner/store/database_summary.h"
#include "runner/store/number_store.h"

namespace peclet::runner {

// Of the seeds of the look; nothing before the first one.
std::vector<QuantityEstimate> point_estimates(Database& database, const PointRecord& point,
                                              const std::optional<Look>& look);
// The same of scalars alone, for which no result is read.
std::vector<QuantityEstimate> scalar_estimates(NumberStore& numbers, const PointRecord& point,
                                               const std::optional<Look>& look);

// One column for each pointer that the sweep has set at any point.
class SettingColumns {
 public:
  explicit SettingColumns(const std::vector<PointRecord>& points);

  std::vector<std::string> titles() const { return {pointers_.begin(), pointers_.end()}; }
  std::vector<std::string> fields(const PointRecord& point) const;

 private:
  std::set<std::string> pointers_;
};

}  // namespace peclet::runner
