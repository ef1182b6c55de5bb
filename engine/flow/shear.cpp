#include "engine/flow/shear.h"

namespace peclet::engine {

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
          .without_strain = "whose strain oscillates; give cycles instead",
          .has_whole_cycles = true,
          .refused_observables = {"transient"}};
}

FlowKind cross_shear_flow() {
  return {.key = "/flow/cross_shear",
          .keys = R"(
/flow/cross_shear? | object | Oscillating shear across the steady one: u_z = y d/dt [amplitude sin(frequency
    t)].
/flow/cross_shear/amplitude | number > 0; named amplitude of the strain across, γ_0 | Largest strain across.
/flow/cross_shear/frequency | number > 0; in 1 / time; named angular frequency across, ω | Angular frequency,
    in radians per time.
)",
          .read = [](const FlowSource& source) -> std::shared_ptr<const Deformation> {
            if (!(source.shear_rate > 0)) {
              source.scene.refuse("/flow/cross_shear",
                                  "must be left out unless the shear rate is > 0; /flow/oscillation is "
                                  "oscillating shear alone");
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
