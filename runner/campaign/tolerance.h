// Defines the largest half-width that an interval may have.
#pragma once

#include <string>

#include "contract/json.h"

namespace peclet::runner {

struct Tolerance {
  enum class Kind { relative, absolute, none };

  double value = 0;
  Kind kind = Kind::relative;
  // For a relative tolerance: the observable of whose |mean| it is a share; "" for its own.
  std::string relative_to{};
  // For a relative tolerance: the half-width that is always allowed, however small the mean.
  double floor = 0;
  // For a relative tolerance: the pointer over which the points make a curve. The band of the curve may meet
  // the tolerance in place of the point's own interval. "" without a curve.
  std::string over{};
  bool is_even = false;  // the observable is even in the axis of the curve, so that a point at 0 is at rest

  Tolerance() = default;
  // Creates a relative tolerance: a share of |mean|.
  Tolerance(double share) : value(share) {}  // NOLINT: the usual kind of tolerance
  static Tolerance absolute(double value);
  // Returns the tolerance for a fixed number of realisations, which allows any half-width.
  static Tolerance none();

  bool is_relative() const { return kind == Kind::relative; }
  bool is_of_curve() const { return !over.empty(); }
  // Returns true if the half-width allowed at this mean is a share of it, not the floor or an absolute one.
  bool is_share_of(double mean) const;
  // Returns true if a mean of 0 allows no half-width.
  bool needs_a_mean() const { return is_relative() && floor == 0; }
  // Returns the allowed half-width, for the mean to which the tolerance is relative; infinite for none().
  double half_width(double mean) const;
  // Returns half-width over the allowed one: converged at 1 or less. Infinite or NaN if the mean is 0 or
  // unknown; NaN for none().
  double share(double half_width, double mean) const;

  bool operator==(const Tolerance&) const = default;
};

// Returns "5 %", "5 % of relative_viscosity", "5 % or 0.01", "5 % along /peclet", "0.1" or "none".
std::string to_string(const Tolerance& tolerance);

// Returns a half-width as the tolerance measures it at this mean: "2.3 %", "0.012"; "-" if it is not finite.
std::string width_text(const Tolerance& tolerance, double half_width, double mean);

// Returns the keys of a target in a campaign file: {"relative_tolerance": 0.05}, with "relative_to" and
// "absolute_floor" if set, {"curve": {"over": "/peclet", "relative_tolerance": 0.05}}, with "even" if set, or
// {"absolute_tolerance": 0.1}; {} for none().
Json to_json(const Tolerance& tolerance);
// Returns the key of a tolerance, which must not be none(): "absolute_tolerance", "curve/relative_tolerance".
const char* key_of(const Tolerance& tolerance);
// Reads a tolerance from the keys of to_json(). Throws Json::exception for values of another type.
Tolerance tolerance_of(const Json& target);

}  // namespace peclet::runner
