#include "runner/statistics/mean_estimates.h"

#include <cmath>

#include "runner/statistics/statistics.h"

namespace peclet::runner {

void MeanEstimates::add(const Json& mean) {
  if (!mean.is_object()) return;
  const Json flat = mean.flatten();
  for (const auto& [pointer, value] : flat.items()) {
    if (value.is_number()) values_[pointer].push_back(value.get<double>());
  }
}

namespace {

Json number_or_null(double number) { return std::isfinite(number) ? Json(number) : Json(nullptr); }

}  // namespace

Json MeanEstimates::estimates() const {
  Json all = Json::object();
  for (const auto& [pointer, values] : values_) {
    const Estimate found = estimate(values);
    all[pointer] = {{"count", found.count},
                    {"mean", number_or_null(found.mean)},
                    {"standard_error", number_or_null(found.standard_error)}};
  }
  return all;
}

}  // namespace peclet::runner
