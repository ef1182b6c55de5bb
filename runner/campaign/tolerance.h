// How narrow an interval has to be, if it has to be narrow at all.
#pragma once

#include <string>

#include "contract/json.h"

namespace peclet::runner {

struct Tolerance {
  enum class Kind { relative, absolute, none };

  double value = 0;
  Kind kind = Kind::relative;
  // Of a relative one: the observable whose |mean| it is a share of; "" for its own.
  std::string relative_to{};
  // Of a relative one: the half-width that is good enough however small the mean.
  double floor = 0;

  // A share of |mean|, unless it says otherwise.
  Tolerance() = default;
  Tolerance(double share) : value(share) {}  // NOLINT: a number is what people mean by a tolerance
  static Tolerance absolute(double value);
  // Any half-width is good enough: a campaign of a fixed number of realisations asks for none.
  static Tolerance none();

  bool is_relative() const { return kind == Kind::relative; }
  // Whether the half-width that is good enough around this mean is a share of it, and no number of its own.
  bool is_share_of(double mean) const;
  // Whether no half-width is good enough for a mean of 0.
  bool needs_a_mean() const { return is_relative() && floor == 0; }
  // The half-width that is good enough, for the mean that it is a share of; infinite without a tolerance.
  double half_width(double mean) const;
  // Half-width over the one that is good enough: converged at 1. Infinite or NaN where there is no measure,
  // NaN without a tolerance.
  double share(double half_width, double mean) const;

  bool operator==(const Tolerance&) const = default;
};

// "5 %", "5 % of relative_viscosity", "5 % or 0.01", "0.1"; "none"
std::string to_string(const Tolerance& tolerance);

// A half-width as the tolerance measures it, beside the mean that it is a share of: "2.3 %", "0.012"; "-"
// where there is none.
std::string width_text(const Tolerance& tolerance, double half_width, double mean);

// {"relative_tolerance": 0.05}, with "relative_to" where it has one, or {"absolute_tolerance": 0.1}: the keys
// of a target, as the campaign file has them. {} for none.
Json to_json(const Tolerance& tolerance);
// Requires a tolerance.
const char* key_of(const Tolerance& tolerance);
// Reads a tolerance from the keys of to_json(), of campaign_keys(). Throws Json::exception for other values.
Tolerance tolerance_of(const Json& target);

}  // namespace peclet::runner
