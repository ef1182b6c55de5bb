#include "runner/campaign/tolerance.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "runner/campaign/number_text.h"

namespace peclet::runner {
namespace {

constexpr const char* relative_key = "relative_tolerance";
constexpr const char* absolute_key = "absolute_tolerance";
constexpr const char* measure_key = "relative_to";
constexpr const char* floor_key = "absolute_floor";
constexpr const char *curve_key = "curve", *over_key = "over", *even_key = "even",
                     *curve_tolerance_key = "curve/relative_tolerance";

}  // namespace

Tolerance Tolerance::absolute(double value) {
  Tolerance tolerance(value);
  tolerance.kind = Kind::absolute;
  return tolerance;
}

Tolerance Tolerance::none() {
  Tolerance tolerance(std::numeric_limits<double>::infinity());
  tolerance.kind = Kind::none;
  return tolerance;
}

bool Tolerance::is_share_of(double mean) const { return is_relative() && value * std::abs(mean) >= floor; }

double Tolerance::half_width(double mean) const {
  return is_relative() ? std::max(value * std::abs(mean), floor) : value;
}

double Tolerance::share(double half_width, double mean) const {
  if (kind == Kind::none) return std::numeric_limits<double>::quiet_NaN();
  return is_share_of(mean) ? half_width / std::abs(mean) / value : half_width / this->half_width(mean);
}

std::string to_string(const Tolerance& tolerance) {
  if (tolerance.kind == Tolerance::Kind::none) return "none";
  if (!tolerance.is_relative()) return fmt::format("{:g}", tolerance.value);
  return fmt::format("{:g} %{}{}{}{}{}", 100 * tolerance.value, tolerance.relative_to.empty() ? "" : " of ",
                     tolerance.relative_to, tolerance.is_of_curve() ? " along " : "", tolerance.over,
                     tolerance.floor > 0 ? fmt::format(" or {:g}", tolerance.floor) : "");
}

std::string width_text(const Tolerance& tolerance, double half_width, double mean) {
  return tolerance.is_share_of(mean) ? percent(half_width / std::abs(mean)) : rough(half_width);
}

const char* key_of(const Tolerance& tolerance) {
  if (tolerance.is_of_curve()) return curve_tolerance_key;
  return tolerance.is_relative() ? relative_key : absolute_key;
}

Json to_json(const Tolerance& tolerance) {
  if (tolerance.kind == Tolerance::Kind::none) return Json::object();
  if (tolerance.is_of_curve()) {
    Json curve = {{over_key, tolerance.over}, {relative_key, tolerance.value}};
    if (tolerance.is_even) curve[even_key] = true;
    return {{curve_key, curve}};
  }
  Json json = {{key_of(tolerance), tolerance.value}};
  if (!tolerance.relative_to.empty()) json[measure_key] = tolerance.relative_to;
  if (tolerance.floor > 0) json[floor_key] = tolerance.floor;
  return json;
}

Tolerance tolerance_of(const Json& target) {
  if (target.contains(absolute_key)) return Tolerance::absolute(target[absolute_key].get<double>());
  if (target.contains(curve_key)) {
    const Json& curve = target[curve_key];
    Tolerance tolerance(curve[relative_key].get<double>());
    tolerance.over = curve[over_key].get<std::string>();
    tolerance.is_even = curve.value(even_key, false);
    return tolerance;
  }
  if (!target.contains(relative_key)) return Tolerance::none();
  Tolerance tolerance(target[relative_key].get<double>());
  tolerance.relative_to = target.value(measure_key, "");
  tolerance.floor = target.value(floor_key, 0.0);
  return tolerance;
}

}  // namespace peclet::runner
