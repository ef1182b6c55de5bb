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

FlowKind oscillation_flow() {
  return {.key = "/flow/oscillation",
          .keys = R"(
/flow/oscillation? | object | Oscillating shear in place of shear_rate: strain = amplitude sin(frequency t).
/flow/oscillation/amplitude | number > 0; named amplitude of the strain, γ_0 | Largest strain.
/flow/oscillation/frequency | number > 0; in 1 / time; named angular frequency, ω | Angular frequency, in
    radians per time.
)",
          .read = [](const FlowSource& source) -> std::shared_ptr<const Deformation> {
            return std::make_shared<OscillatoryShear>(source.scene.number("/flow/oscillation/amplitude"),
                                                      source.scene.number("/flow/oscillation/frequency"));
          },
          .unit = "cycles",
          .without_strain = "whose strain comes and goes; cycles are even",
          .has_whole_cycles = true,
          .refused_observables = {"transient"}};
}

FlowKind cross_shear_flow() {
  return {.key = "/flow/cross_shear",
          .keys = R"(
/flow/cross_shear? | object | Oscillating shear across the steady one: u_z = y d/dt [amplitude sin(frequency
    t)].
/flow/cross_shear/amplitude | number > 0; named amplitude of the strain across, γ_0 | Its largest strain.
/flow/cross_shear/frequency | number > 0; in 1 / time; named angular frequency across, ω | Angular frequency,
    in radians per time.
)",
          .read = [](const FlowSource& source) -> std::shared_ptr<const Deformation> {
            if (!(source.shear_rate > 0)) {
              source.scene.refuse(
                  "/flow/cross_shear",
                  "must be left out unless the shear rate is > 0; /flow/oscillation shears to "
                  "and fro alone");
            }
            return std::make_shared<CrossShear>(source.shear_rate,
                                                source.scene.number("/flow/cross_shear/amplitude"),
                                                source.scene.number("/flow/cross_shear/frequency"));
          },
          .beside = {"/flow/shear_rate", "/peclet"},
          .unit = "cycles",
          .refused_observables = {"mean_squared_displacement", "transient"}};
}

}  // namespace peclet::engine
