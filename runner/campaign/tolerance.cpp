#include "runner/campaign/tolerance.h"

#include <fmt/format.h>

#include <cmath>

#include "contract/input_error.h"
#include "contract/key_table.h"

namespace peclet::runner {
namespace {

constexpr const char* relative_key = "relative_tolerance";
constexpr const char* absolute_key = "absolute_tolerance";

bool has_number(const Json& target, const char* key) {
  return target.contains(key) && target[key].is_number();
}

}  // namespace

Tolerance Tolerance::absolute(double value) {
  Tolerance tolerance(value);
  tolerance.kind = Kind::absolute;
  return tolerance;
}

double Tolerance::half_width(double mean) const { return is_relative() ? value * std::abs(mean) : value; }

double Tolerance::share(double half_width, double mean) const {
  return is_relative() ? half_width / std::abs(mean) / value : half_width / value;
}

std::string to_string(const Tolerance& tolerance) {
  return tolerance.is_relative() ? fmt::format("{:g} %", 100 * tolerance.value)
                                 : fmt::format("{:g}", tolerance.value);
}

const char* key_of(const Tolerance& tolerance) {
  return tolerance.is_relative() ? relative_key : absolute_key;
}

Json to_json(const Tolerance& tolerance) { return {{key_of(tolerance), tolerance.value}}; }

Tolerance tolerance_of(const Json& target) {
  if (has_number(target, relative_key)) return {target[relative_key].get<double>()};
  if (has_number(target, absolute_key)) return Tolerance::absolute(target[absolute_key].get<double>());
  throw InputError("", "/target", shortened(target),
                   fmt::format("must have {} or {}", relative_key, absolute_key));
}

}  // namespace peclet::runner
