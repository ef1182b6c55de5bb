// BackgroundFlow gives the flow that the solvent would have without particles, at one moment:
//   u(x) = L x + u'(x)
// L is the velocity gradient of the periodic cell [1/time]: images of a particle move with the flow at their
// places. u' varies within the cell [length/time]. A sphere of radius a feels at its centre
//   the velocity        (1 + a^2/6 lap) u
//   the spin            (curl u) / 2
//   the rate of strain  (1 + a^2/10 lap) E,  E = (grad u + grad u^T) / 2     (for its stresslet)
// (Faxen 1922; Monti et al. 2021, Phys. Fluids 33, 103314, eq. A.1). A uniform gradient needs no correction.
#pragma once

#include <cstddef>

#include "engine/state/periodic_cell.h"

namespace peclet::engine {

// UniformFlow is plain data, because files that are compiled for one instruction set only share it.
struct alignas(32) UniformFlow {
  double gradient[3][4];  // columns of L, laid out as rows of a VectorField
  double spin[4];
  bool is_simple_shear;  // all components of L but du_x / dy are 0
};

// Returns half the vorticity of gradient_ij = du_i / dx_j.
inline Vector3 spin_of(const Matrix3& gradient) {
  const auto& [x, y, z] = gradient.column;
  return {0.5 * (y.z - z.y), 0.5 * (z.x - x.z), 0.5 * (x.y - y.x)};
}
// Returns the rate of strain, the symmetric part of the gradient.
inline SymmetricTensor strain_of(const Matrix3& gradient) {
  const auto& [x, y, z] = gradient.column;
  return {x.x, y.y, z.z, 0.5 * (y.x + x.y), 0.5 * (z.x + x.z), 0.5 * (z.y + y.z)};
}

// FlowVariation is u', which is the same at all images of a point.
class FlowVariation {
 public:
  virtual ~FlowVariation() = default;

  struct Local {
    Vector3 velocity, laplacian;
    Matrix3 gradient, laplacian_of_gradient;
  };
  // Returns u' and its derivatives at x; the gradient is du'_i / dx_j.
  virtual Local at(const Vector3& x, const PeriodicCell& cell) const = 0;

  // Returns an upper bound of |du'_i / dx_j| in this cell [1/time].
  virtual double largest_rate(const PeriodicCell& cell) const = 0;
};

class BackgroundFlow {
 public:
  // `variation` may be null. It and the cell must outlive this object.
  explicit BackgroundFlow(const PeriodicCell& cell, const FlowVariation* variation = nullptr)
      : cell_(cell), variation_(variation) {}

  // Returns u at x, or with a radius the velocity that a sphere there feels.
  Vector3 velocity(const Vector3& x, double radius = 0) const {
    return cell_.velocity_gradient() * x + varying_motion(x, radius).velocity;
  }
  Vector3 spin(const Vector3& x) const {
    return spin_of(cell_.velocity_gradient()) + varying_motion(x, 0).spin;
  }

  struct Motion {
    Vector3 velocity, spin;
  };
  // Returns the contributions of u' to velocity() and spin().
  Motion varying_motion(const Vector3& x, double radius) const {
    if (variation_ == nullptr) return {};
    const FlowVariation::Local local = variation_->at(x, cell_);
    return {local.velocity + (radius * radius / 6) * local.laplacian, spin_of(local.gradient)};
  }
  struct PointMotion {
    Vector3 velocity, spin;
    SymmetricTensor strain;
  };
  // Returns u', its spin and its rate of strain at a point, without Faxen's corrections.
  PointMotion varying_at(const Vector3& x) const {
    if (variation_ == nullptr) return {};
    const FlowVariation::Local local = variation_->at(x, cell_);
    return {local.velocity, spin_of(local.gradient), strain_of(local.gradient)};
  }
  // Returns the rate of strain of u' that a sphere of this radius feels.
  SymmetricTensor varying_strain(const Vector3& x, double radius) const {
    if (variation_ == nullptr) return {};
    const FlowVariation::Local local = variation_->at(x, cell_);
    return strain_of(local.gradient + (radius * radius / 10) * local.laplacian_of_gradient);
  }

 private:
  const PeriodicCell& cell_;
  const FlowVariation* variation_;
};

inline UniformFlow plain_flow(const Matrix3& gradient) {
  UniformFlow result{};
  for (std::size_t j = 0; j < 3; ++j) {
    const Vector3& column = gradient.column[j];
    result.gradient[j][0] = column.x;
    result.gradient[j][1] = column.y;
    result.gradient[j][2] = column.z;
  }
  const Vector3 spin = spin_of(gradient);
  result.spin[0] = spin.x;
  result.spin[1] = spin.y;
  result.spin[2] = spin.z;
  result.is_simple_shear = gradient == simple_shear(gradient.column[1].x);
  return result;
}

}  // namespace peclet::engine
