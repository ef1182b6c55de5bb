// Planar extension u = rate (x, -y, 0).
//
// A square lattice in the plane, turned by atan(2) / 2, meets itself again after every Hencky strain of
// ln((3 + sqrt 5) / 2) = 0.9624, and its points never come closer than 0.946 of its edge: Kraynik & Reinelt,
// Int. J. Multiphase Flow 18, 1045 (1992). The cell follows by changes of its basis (state/periodic_cell.h).
// Strain is Hencky strain, rate times time; the invariant sqrt(2 E:E) of the rate of strain is 2 rate.
#pragma once

#include "engine/flow/flow_kind.h"

namespace peclet::engine {

class PlanarExtension final : public Deformation {
 public:
  explicit PlanarExtension(double rate) : rate_(rate) {}

  // The cell is what the lattice of the start has become: digits are lost as exp(2 strain), and at this
  // strain 5e-8 of its edges are.
  static constexpr double largest_strain = 10;

  Matrix3 velocity_gradient(double time) const override;
  Matrix3 displacement_gradient(double time) const override;
  double largest_rate() const override { return rate_; }
  Matrix3 steady_gradient(double /*from*/) const override { return velocity_gradient(0); }
  double time_of(double strain, double /*from*/) const override { return strain / rate_; }
  Matrix3 edges_at_start(const Vector3& box) const override;
  // sqrt(2) / 5^(1/4), rounded down.
  double nearest_image() const override { return 0.9457; }

 private:
  double rate_;
};

FlowKind planar_extension_flow();

}  // namespace peclet::engine
