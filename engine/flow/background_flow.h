// The flow of the solvent as it would be without particles, at one moment.
//
//   u(x) = L x,
// L the velocity gradient of the periodic cell, so that images of a particle find the flow that they move
// with. Half the vorticity is the spin of a free sphere, the symmetric part of L the rate of strain E.
#pragma once

#include <cstddef>

#include "engine/state/matrix3.h"

namespace peclet::engine {

class BackgroundFlow {
 public:
  // gradient_ij = du_i / dx_j.
  explicit BackgroundFlow(const Matrix3& gradient) : gradient_(gradient) {}

  Vector3 velocity(const Vector3& x) const { return gradient_ * x; }
  // Half the vorticity, (curl u) / 2.
  Vector3 spin() const {
    const auto& [x, y, z] = gradient_.column;
    return {0.5 * (y.z - z.y), 0.5 * (z.x - x.z), 0.5 * (x.y - y.x)};
  }
  // E = (L + L^T) / 2.
  SymmetricTensor rate_of_strain() const {
    const auto& [x, y, z] = gradient_.column;
    return {x.x, y.y, z.z, 0.5 * (y.x + x.y), 0.5 * (z.x + x.z), 0.5 * (z.y + y.z)};
  }
  const Matrix3& gradient() const { return gradient_; }

 private:
  Matrix3 gradient_;
};

// The same as plain data, for the loops over particles.
struct alignas(32) UniformFlow {
  double gradient[3][4];  // columns, as rows of a VectorField
  double spin[4];
  bool is_simple_shear;  // nothing but du_x / dy
};
inline UniformFlow plain(const BackgroundFlow& flow) {
  UniformFlow result{};
  for (std::size_t j = 0; j < 3; ++j) {
    const Vector3& column = flow.gradient().column[j];
    result.gradient[j][0] = column.x;
    result.gradient[j][1] = column.y;
    result.gradient[j][2] = column.z;
  }
  const Vector3 spin = flow.spin();
  result.spin[0] = spin.x;
  result.spin[1] = spin.y;
  result.spin[2] = spin.z;
  result.is_simple_shear = flow.gradient() == simple_shear(flow.gradient().column[1].x);
  return result;
}

}  // namespace peclet::engine
