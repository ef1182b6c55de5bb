#include "engine/flow/controlled_shear.h"

#include <algorithm>
#include <cmath>

namespace peclet::engine {
namespace {

// About the rate of spheres without friction: the viscosity of Krieger & Dougherty (1959), (1 - phi /
// phi_m)^-1.6 with phi_m = 0.65. Friction, noise and other forces between spheres add to it.
double estimated_rate(double stress, double viscosity, double volume_fraction) {
  constexpr double densest = 0.6, largest = 0.65, exponent = 1.6;
  return stress / viscosity * std::pow(1 - std::min(volume_fraction, densest) / largest, exponent);
}

std::shared_ptr<const Deformation> read_stress(const FlowSource& source) {
  constexpr double usual_jammed_viscosity = 1e4;
  const SceneDocument& scene = source.scene;
  if (source.thermal_energy > 0 && scene.has("/lubrication/form") &&
      scene.at("/lubrication/form") == "mari") {
    scene.refuse("/lubrication/form",
                 "must be another one where a stress acts with noise: its stress is not that of the forces "
                 "alone");
  }
  const double stress = scene.number("/flow/stress");
  return std::make_shared<ControlledShear>(
      stress, estimated_rate(stress, source.viscosity, source.volume_fraction), source.viscosity,
      scene.number_or("/flow/jammed_viscosity", usual_jammed_viscosity));
}

}  // namespace

FlowKind stress_flow() {
  return {
      .key = "/flow/stress",
      .keys = R"(
/flow/stress? | number > 0; in stress; named shear stress, σ | Shear stress that is held in the place of a
    rate: its mean rate is what is measured.
/flow/jammed_viscosity? | number > 0; if stress | Relative viscosity beyond which a realisation under a stress
    has jammed; 10000 unless given.
)",
      .read = read_stress,
      .unit = "stress_times",
      .without_strain = "whose strain is not known beforehand; stress_times are the same for all stresses",
      .refused_observables = {"mean_squared_displacement", "profiles", "transient"}};
}

}  // namespace peclet::engine
