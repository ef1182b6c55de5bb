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

}  // namespace peclet::engine
