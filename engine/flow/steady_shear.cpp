#include "engine/flow/steady_shear.h"

#include <limits>

namespace peclet::engine {

Matrix3 SteadyShear::velocity_gradient(double /*time*/) const { return simple_shear(rate_); }

Matrix3 SteadyShear::displacement_gradient(double time) const { return simple_shear(rate_ * time); }

Matrix3 SteadyShear::displacement_gradient(const Clock& clock) const {
  return simple_shear(rate_ * clock.origin + rate_ * clock.timestep * static_cast<double>(clock.steps));
}

double SteadyShear::time_of(double strain, double /*from*/) const {
  return rate_ == 0 ? std::numeric_limits<double>::infinity() : strain / largest_rate();
}

FlowKind steady_shear_flow() {
  return {.key = "/flow/shear_rate",
          .keys = R"(
/flow/shear_rate? | number >= 0; in 1 / time; named shear rate, γ̇ | Shear rate; 0: no mean shear. Not
    together with peclet.
)",
          .read = [](const FlowSource& source) -> std::shared_ptr<const Deformation> {
            return std::make_shared<SteadyShear>(source.shear_rate);
          },
          .beside = {"/flow/waves", "/peclet"}};
}

}  // namespace peclet::engine
