#include "engine/flow/extension.h"

namespace peclet::engine {

FlowKind planar_extension_flow() {
  return {.key = "/flow/extension_rate",
          .keys = R"(
/flow/extension_rate? | number > 0; in 1 / time; named extension rate, ε̇ | Planar extension in place of
    shear: (rate x, -rate y, 0). Strains are Hencky strains, at most 10 in a realisation.
)",
          .read = [](const FlowSource& source) -> std::shared_ptr<const Deformation> {
            return std::make_shared<PlanarExtension>(source.scene.number("/flow/extension_rate"));
          },
          .largest_strain = PlanarExtension::largest_strain,
          .own_cell = "a turned cube",
          .refused_observables = {"mean_squared_displacement", "pair_distribution", "profiles"}};
}

FlowKind uniaxial_extension_flow() {
  return {.key = "/flow/uniaxial_rate",
          .keys = R"(
/flow/uniaxial_rate? | number; in 1 / time; named uniaxial extension rate, ε̇ | Uniaxial extension in place
    of shear: (rate x, -rate y / 2, -rate z / 2); biaxial extension along y and z if the rate is below 0.
    Strains are Hencky strains along x, at most 10 in a realisation.
)",
          .read = [](const FlowSource& source) -> std::shared_ptr<const Deformation> {
            const double rate = source.scene.number("/flow/uniaxial_rate");
            if (rate == 0) source.scene.refuse("/flow/uniaxial_rate", "must be a number other than 0");
            return std::make_shared<UniaxialExtension>(rate);
          },
          .largest_strain = UniaxialExtension::largest_strain,
          .own_cell = "a turned cube",
          .refused_observables = {"mean_squared_displacement", "pair_distribution", "profiles"}};
}

}  // namespace peclet::engine
