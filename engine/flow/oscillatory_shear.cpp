#include "engine/flow/oscillatory_shear.h"

#include <cmath>
#include <numbers>

namespace peclet::engine {
namespace {

// Along x and along z, both of them along y.
Matrix3 shears_along_y(double x, double z) { return {Vector3{}, Vector3{x, 0, z}, Vector3{}}; }

}  // namespace

Matrix3 OscillatoryShear::velocity_gradient(double time) const {
  return simple_shear(amplitude_ * frequency_ * std::cos(frequency_ * time));
}

Matrix3 OscillatoryShear::displacement_gradient(double time) const {
  return simple_shear(amplitude_ * std::sin(frequency_ * time));
}

double OscillatoryShear::mean_rate() const { return 2 * amplitude_ * frequency_ / std::numbers::pi; }

// Quarters of a cycle have a strain of g each, away from the cube and back to it in turn.
double OscillatoryShear::time_of(double strain, double /*from*/) const {
  if (std::isinf(strain)) return strain;
  const double quarters = std::floor(strain / amplitude_), rest = strain / amplitude_ - quarters;
  const bool away = std::fmod(quarters, 2) == 0;
  const double phase = away ? std::asin(rest) : std::acos(1 - rest);
  return (0.5 * std::numbers::pi * quarters + phase) / frequency_;
}

Matrix3 CrossShear::velocity_gradient(double time) const {
  return shears_along_y(rate_, amplitude_ * frequency_ * std::cos(frequency_ * time));
}

// The two shears commute: neither moves what the other one shears.
Matrix3 CrossShear::displacement_gradient(double time) const {
  return shears_along_y(rate_ * time, amplitude_ * std::sin(frequency_ * time));
}

double CrossShear::largest_rate() const { return std::hypot(rate_, amplitude_ * frequency_); }

}  // namespace peclet::engine
