#include "runner/statistics/look_json.h"

#include <cmath>

namespace peclet::runner {

Json number_json(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json estimate_json(const Estimate& estimate) {
  return {{"count", estimate.count},
          {"mean", number_json(estimate.mean)},
          {"standard_error", number_json(estimate.standard_error)}};
}

Json look_json(const Look& look) {
  Json json = estimate_json(look.controlled);
  json["seeds"] = look.seeds;
  json["lost"] = look.lost;
  json["half_width"] = number_json(look.controlled_half_width);
  json["uncontrolled"] = estimate_json(look.estimate);
  json["uncontrolled"]["half_width"] = number_json(look.half_width);
  json["skewness"] = number_json(look.skewness);
  json["transient"] = look.untested ? Json(nullptr) : Json(look.transient);
  json["verdict"] = to_string(look.verdict);
  return json;
}

}  // namespace peclet::runner
