#include "engine/flow/planar_extension.h"

#include <cmath>

namespace peclet::engine {

Matrix3 PlanarExtension::velocity_gradient(double /*time*/) const {
  return {Vector3{rate_, 0, 0}, Vector3{0, -rate_, 0}, Vector3{}};
}

Matrix3 PlanarExtension::displacement_gradient(double time) const {
  return {Vector3{std::expm1(rate_ * time), 0, 0}, Vector3{0, std::expm1(-rate_ * time), 0}, Vector3{}};
}

Matrix3 PlanarExtension::edges_at_start(const Vector3& box) const {
  const double angle = 0.5 * std::atan(2.0), c = std::cos(angle), s = std::sin(angle);
  return {box.x * Vector3{c, s, 0}, box.y * Vector3{-s, c, 0}, Vector3{0, 0, box.z}};
}

FlowKind planar_extension_flow() {
  return {.key = "/flow/extension_rate",
          .keys = R"(
/flow/extension_rate? | number > 0; in 1 / time; named extension rate, ε̇ | Planar extension in the place of
    shear: (rate x, -rate y, 0). Strains are Hencky strains, at most 10 in a realisation.
)",
          .read = [](const FlowSource& source) -> std::shared_ptr<const Deformation> {
            return std::make_shared<PlanarExtension>(source.scene.number("/flow/extension_rate"));
          },
          .largest_strain = PlanarExtension::largest_strain,
          .own_cell = "a turned cube",
          .refused_observables = {"mean_squared_displacement", "pair_distribution", "profiles"}};
}

}  // namespace peclet::engine
