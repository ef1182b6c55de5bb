#include "engine/flow/deformation.h"

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

}  // namespace peclet::engine
