#include "engine/observables/quantity.h"

namespace peclet::engine {

Json to_json(const Quantity& quantity) {
  Json json = {{"symbol", quantity.symbol},
               {"unit", quantity.unit},
               {"estimator", quantity.is_share ? "share" : "mean"}};
  for (const Axis& axis : quantity.axes) {
    json["axes"].push_back({{"name", axis.name}, {"unit", axis.unit}, {"values", axis.values}});
  }
  if (quantity.ratio) {
    json["estimator"] = "ratio";
    json["numerator"] = quantity.ratio->numerator;
    json["denominator"] = quantity.ratio->denominator;
  }
  return json;
}

std::vector<std::string> targets_in(const Quantity& quantity) {
  if (quantity.ratio) return {};
  std::string name = quantity.name;
  for (std::size_t axis = 0; axis < quantity.axes.size(); ++axis) name += "/*";
  return {name};
}

}  // namespace peclet::engine
