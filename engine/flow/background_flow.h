// The flow of the solvent as it would be without particles, at one moment.
//
//   u(x) = L x + u'(x),
// L the velocity gradient of the periodic cell, so that images of a particle find the flow that they move
// with, and u' what varies within the cell. A sphere of radius a feels at its centre
//   the velocity  (1 + a^2/6 lap) u     (Faxen 1922; Monti et al. 2021, Phys. Fluids 33, 103314, eq. A.1)
//   the spin      (curl u) / 2
//   the strain    (1 + a^2/10 lap) E, E = (grad u + grad u^T) / 2     (for its stresslet)
// The corrections are those of u' alone; a uniform gradient has none.
#pragma once

#include <cstddef>

#include "engine/state/periodic_cell.h"

namespace peclet::engine {

// A uniform flow for the loops over particles: plain data, because it is shared with files that are compiled
// for one processor only.
struct alignas(32) UniformFlow {
  double gradient[3][4];  // columns, as rows of a VectorField
  double spin[4];
  bool is_simple_shear;  // nothing but du_x / dy
};

// Half the vorticity, and the symmetric part, of gradient_ij = du_i / dx_j.
inline Vector3 spin_of(const Matrix3& gradient) {
  const auto& [x, y, z] = gradient.column;
  return {0.5 * (y.z - z.y), 0.5 * (z.x - x.z), 0.5 * (x.y - y.x)};
}
inline SymmetricTensor strain_of(const Matrix3& gradient) {
  const auto& [x, y, z] = gradient.column;
  return {x.x, y.y, z.z, 0.5 * (y.x + x.y), 0.5 * (z.x + x.z), 0.5 * (z.y + y.z)};
}

// u', the same for all images of a point.
class FlowVariation {
 public:
  virtual ~FlowVariation() = default;

  struct Local {
    Vector3 velocity, laplacian;
    Matrix3 gradient, laplacian_of_gradient;
  };
  virtual Local at(const Vector3& x, const PeriodicCell& cell) const = 0;

  // At least as large as any du_i / dx_j in this cell.
  virtual double largest_rate(const PeriodicCell& cell) const = 0;
};

class BackgroundFlow {
 public:
  // `variation` may be null; it and the cell must outlive this.
  explicit BackgroundFlow(const PeriodicCell& cell, const FlowVariation* variation = nullptr)
      : cell_(cell), variation_(variation) {}

  // At a point; with a radius, what a sphere there feels.
  Vector3 velocity(const Vector3& x, double radius = 0) const {
    return cell_.velocity_gradient() * x + varying_motion(x, radius).velocity;
  }
  Vector3 spin(const Vector3& x) const {
    return spin_of(cell_.velocity_gradient()) + varying_motion(x, 0).spin;
  }

  // The part of u' in them, and in the rate of strain.
  struct Motion {
    Vector3 velocity, spin;
  };
  Motion varying_motion(const Vector3& x, double radius) const {
    if (variation_ == nullptr) return {};
    const FlowVariation::Local local = variation_->at(x, cell_);
    return {local.velocity + (radius * radius / 6) * local.laplacian, spin_of(local.gradient)};
  }
  // At a point, which has no radius.
  struct PointMotion {
    Vector3 velocity, spin;
    SymmetricTensor strain;
  };
  PointMotion varying_at(const Vector3& x) const {
    if (variation_ == nullptr) return {};
    const FlowVariation::Local local = variation_->at(x, cell_);
    return {local.velocity, spin_of(local.gradient), strain_of(local.gradient)};
  }
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
