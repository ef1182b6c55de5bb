#include "engine/flow/uniaxial_extension.h"

#include <numbers>

namespace peclet::engine {

Matrix3 UniaxialExtension::velocity_gradient(double /*time*/) const {
  return {Vector3{rate_, 0, 0}, Vector3{0, -0.5 * rate_, 0}, Vector3{0, 0, -0.5 * rate_}};
}

Matrix3 UniaxialExtension::displacement_gradient(double time) const {
  const double across = std::expm1(-0.5 * rate_ * time);
  return {Vector3{std::expm1(rate_ * time), 0, 0}, Vector3{0, across, 0}, Vector3{0, 0, across}};
}

Matrix3 UniaxialExtension::edges_at_start(const Vector3& box) const {
  const auto edge = [](int k, double length) {
    const double angle = (2 * k - 1) * std::numbers::pi / 7, scale = -2 * length / std::sqrt(7.0);
    return scale * Vector3{std::sin(angle), std::sin(2 * angle), std::sin(3 * angle)};
  };
  return {edge(1, box.x), edge(2, box.y), edge(3, box.z)};
}

FlowKind uniaxial_extension_flow() {
  return {.key = "/flow/uniaxial_rate",
          .keys = R"(
/flow/uniaxial_rate? | number; in 1 / time; named uniaxial extension rate, ε̇ | Uniaxial extension in the
    place of shear: (rate x, -rate y / 2, -rate z / 2); biaxial extension along y and z where it is below 0.
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
