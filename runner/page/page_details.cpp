#include "runner/page/page_details.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "runner/statistics/look_json.h"
#include "runner/statistics/observation.h"
#include "runner/statistics/quantity_estimates.h"
#include "runner/statistics/stop_rule.h"

namespace peclet::runner {
namespace {

bool is_profile(const Quantity& quantity) {
  if (quantity.axes.size() != 1 || quantity.elements() < 2) return false;
  const Json& values = quantity.axes.front().values;
  return std::all_of(values.begin(), values.end(), [](const Json& value) { return value.is_number(); });
}

Json profile_json(const QuantityEstimate& found, double level) {
  constexpr std::size_t most_values = 400;
  const Quantity& quantity = found.quantity;
  const QuantityAxis& axis = quantity.axes.front();
  const std::size_t stride = 1 + (quantity.elements() - 1) / most_values;
  Json values = Json::array(), means = Json::array(), errors = Json::array(), widths = Json::array();
  for (std::size_t k = 0; k < quantity.elements(); k += stride) {
    const Estimate& estimate = found.estimates[k];
    values.push_back(axis.values[k]);
    means.push_back(number_json(estimate.mean));
    errors.push_back(number_json(estimate.standard_error));
    widths.push_back(number_json(half_width(estimate, level)));
  }
  return {{"name", quantity.name}, {"symbol", quantity.symbol},
          {"unit", quantity.unit}, {"axis", {{"name", axis.name}, {"unit", axis.unit}, {"values", values}}},
          {"mean", means},         {"standard_error", errors},
          {"half_width", widths}};
}

// Block by block over the seeds.
class Blocks {
 public:
  void add(const std::vector<double>& values) {
    if (values.empty() || (!sums_.empty() && sums_.size() != values.size())) return;
    sums_.resize(values.size());
    for (std::size_t block = 0; block < values.size(); ++block) {
      if (!std::isnan(values[block])) sums_[block].add(values[block]);
    }
  }
  Json json(double level) const {
    if (sums_.empty()) return nullptr;
    Json means = Json::array(), widths = Json::array();
    for (const RunningEstimate& sum : sums_) {
      means.push_back(number_json(sum.estimate().mean));
      widths.push_back(number_json(half_width(sum.estimate(), level)));
    }
    return {{"mean", means}, {"half_width", widths}};
  }

 private:
  std::vector<RunningEstimate> sums_;
};

}  // namespace

Json point_details(Database& database, std::int64_t point, int end, const TargetRecord& target, int seeds) {
  const std::vector<int> completed = database.completed(point, end);
  // The seed after the first `seeds` that have completed.
  const int beyond =
      static_cast<int>(completed.size()) < seeds ? end : completed[static_cast<std::size_t>(seeds) - 1] + 1;
  QuantityEstimates sums;
  Blocks blocks;
  int read = 0;
  database.for_each_result(point, beyond, [&](int, const Json& result) {
    if (!result.at("mean").is_object()) return;
    ++read;
    sums.add(result);
    blocks.add(block_values(result, target.target.observable));
  });
  Json profiles = Json::array();
  for (const QuantityEstimate& found : sums.estimates()) {
    if (is_profile(found.quantity)) profiles.push_back(profile_json(found, target.level()));
  }
  return {{"seeds", read},
          {"of", completed.size()},
          {"blocks", blocks.json(target.level())},
          {"profiles", profiles}};
}

}  // namespace peclet::runner
