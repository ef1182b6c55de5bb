#include "engine/flow/deformation.h"

#include <cmath>
#include <limits>

namespace peclet::engine {

Matrix3 SteadyShear::velocity_gradient(double /*time*/) const { return simple_shear(rate_); }

Matrix3 SteadyShear::displacement_gradient(double time) const { return simple_shear(rate_ * time); }

Matrix3 SteadyShear::displacement_gradient(const Clock& clock) const {
  return simple_shear(rate_ * clock.origin + rate_ * clock.timestep * static_cast<double>(clock.steps));
}

double SteadyShear::time_of(double strain) const {
  return rate_ == 0 ? std::numeric_limits<double>::infinity() : strain / largest_rate();
}

Matrix3 OscillatoryShear::velocity_gradient(double time) const {
  return simple_shear(amplitude_ * frequency_ * std::cos(frequency_ * time));
}

Matrix3 OscillatoryShear::displacement_gradient(double time) const {
  return simple_shear(amplitude_ * std::sin(frequency_ * time));
}

// Quarters of a cycle have a strain of g each, away from the cube and back to it in turn.
double OscillatoryShear::time_of(double strain) const {
  if (std::isinf(strain)) return strain;
  const double quarters = std::floor(strain / amplitude_), rest = strain / amplitude_ - quarters;
  const bool away = std::fmod(quarters, 2) == 0;
  const double phase = away ? std::asin(rest) : std::acos(1 - rest);
  return (0.5 * std::numbers::pi * quarters + phase) / frequency_;
}

}  // namespace peclet::engine
