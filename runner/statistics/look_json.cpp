#include "runner/statistics/look_json.h"

#include <cmath>

namespace peclet::runner {

Json number_json(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json estimate_json(const Estimate& estimate) {
  return {{"count", estimate.count},
          {"mean", number_json(estimate.mean)},
          {"standard_error", number_json(estimate.standard_error)}};
}

Estimate::Values stored_values(const Estimate& estimate, double half_width) {
  if (estimate.count < 2) return Estimate::Values::spread;
  if (std::isnan(half_width)) return Estimate::Values::equal;
  const double mean = estimate.mean, ones = estimate.count * mean;
  const double variance = estimate.standard_error * estimate.standard_error * (estimate.count - 1);
  // The variance is compared relative to that of a share, which may be small itself.
  constexpr double rounding = 1e-12, same = 1e-9;
  const bool is_share = half_width > 0 && mean >= 0 && mean <= 1 &&
                        std::abs(ones - std::round(ones)) <= rounding * estimate.count &&
                        std::abs(variance - mean * (1 - mean)) <= same * mean * (1 - mean);
  return is_share ? Estimate::Values::share : Estimate::Values::spread;
}

Json observables_json(const Look& look) {
  Json json = Json::array();
  for (const ObservableLook& one : look.each) {
    Json& of = json.emplace_back(estimate_json(one.estimate));
    of["observable"] = one.observable;
    of["half_width"] = number_json(one.half_width);
    of["share_of_tolerance"] = number_json(one.share);
    of["skewness"] = number_json(one.skewness);
    of["transient"] = one.untested ? Json(nullptr) : Json(one.transient);
    of["verdict"] = one.verdict ? Json(to_string(*one.verdict)) : Json(nullptr);
  }
  return json;
}

std::vector<ObservableLook> observables_of(const Json& json) {
  const auto number = [](const Json& value) { return value.is_null() ? std::nan("") : value.get<double>(); };
  std::vector<ObservableLook> each;
  for (const Json& of : json) {
    ObservableLook& one = each.emplace_back();
    one.observable = of.at("observable").get<std::string>();
    one.estimate = {of.at("count").get<int>(), number(of.at("mean")), number(of.at("standard_error"))};
    one.half_width = number(of.at("half_width"));
    one.estimate.values = stored_values(one.estimate, one.half_width);
    one.share = number(of.at("share_of_tolerance"));
    one.skewness = number(of.at("skewness"));
    one.untested = of.at("transient").is_null();
    one.transient = !one.untested && of.at("transient").get<bool>();
    if (!of.at("verdict").is_null()) one.verdict = verdict_of(of.at("verdict").get<std::string>()).value();
  }
  return each;
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
  json["near_maximum"] = look.near_maximum;
  json["repeated_seeds"] = look.repeated;
  if (!look.each.empty()) json["observables"] = observables_json(look);
  return json;
}

}  // namespace peclet::runner
