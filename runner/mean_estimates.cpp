#include "runner/mean_estimates.h"

#include <cmath>

#include "runner/statistics.h"

namespace peclet::runner {

void MeanEstimates::add(const Json& mean) {
  if (!mean.is_object()) return;
  const Json flat = mean.flatten();
  for (const auto& [pointer, value] : flat.items()) {
    if (value.is_number()) values_[pointer].push_back(value.get<double>());
  }
}

Json MeanEstimates::estimates() const {
  Json all = Json::object();
  for (const auto& [pointer, values] : values_) {
    const Estimate found = estimate(values);
    all[pointer] = {
        {"count", found.count},
        {"mean", found.mean},
        {"standard_error", std::isfinite(found.standard_error) ? Json(found.standard_error) : Json(nullptr)}};
  }
  return all;
}

}  // namespace peclet::runner
