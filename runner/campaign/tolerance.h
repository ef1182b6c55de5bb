// How narrow an interval has to be.
#pragma once

#include <string>

#include "contract/json.h"

namespace peclet::runner {

struct Tolerance {
  enum class Kind { relative, absolute };

  double value = 0;
  Kind kind = Kind::relative;

  // A share of |mean|, unless it says otherwise.
  Tolerance() = default;
  Tolerance(double share) : value(share) {}  // NOLINT: a number is what people mean by a tolerance
  static Tolerance absolute(double value);

  bool is_relative() const { return kind == Kind::relative; }
  // The half-width that is good enough around this mean.
  double half_width(double mean) const;
  // Half-width over the one that is good enough: converged at 1. Infinite or NaN where there is no measure.
  double share(double half_width, double mean) const;

  bool operator==(const Tolerance&) const = default;
};

// "5 %", "0.1"
std::string to_string(const Tolerance& tolerance);

// {"relative_tolerance": 0.05} or {"absolute_tolerance": 0.1}: the key of a target, as the campaign file has
// it.
Json to_json(const Tolerance& tolerance);
const char* key_of(const Tolerance& tolerance);
// Of an object that has one of these keys. Throws InputError when it has none.
Tolerance tolerance_of(const Json& target);

}  // namespace peclet::runner
