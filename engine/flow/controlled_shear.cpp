#include "engine/flow/controlled_shear.h"

#include <algorithm>
#include <cmath>

namespace peclet::engine {
namespace {

// Estimates the shear rate [1/time] of frictionless spheres at this stress: the relative viscosity is that of
// Krieger & Dougherty (1959), (1 - phi / 0.65)^-1.6. Friction, noise and other forces raise it.
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
                 "must be kim-karrila with /flow/stress and noise: the stress of mari is not that of the "
                 "forces alone");
  }
  const double stress = scene.number("/flow/stress");
  return std::make_shared<ControlledShear>(
      stress, estimated_rate(stress, source.viscosity, source.volume_fraction), source.viscosity,
      scene.number_or("/flow/jammed_viscosity", usual_jammed_viscosity));
}

}  // namespace

FlowKind stress_flow() {
  return {.key = "/flow/stress",
          .keys = R"(
/flow/stress? | number > 0; in stress; named shear stress, σ | Shear stress that is held in place of a rate;
    the mean rate is measured.
/flow/jammed_viscosity? | number > 0; if stress | Relative viscosity above which a realisation at a given
    stress has jammed; 10000 unless given.
)",
          .read = read_stress,
          .unit = "stress_times",
          .without_strain = "whose strain is not known beforehand; give stress_times instead",
          .refused_observables = {"mean_squared_displacement", "profiles", "transient"}};
}

}  // namespace peclet::engine
