// Uniaxial extension u = rate (x, -y/2, -z/2), and biaxial extension of the plane of y and z where the rate
// is below 0.
//
// No lattice meets itself again in this flow, but a cube can be turned so that its lattice never has points
// close to each other. With edges of length 1 along
//   e_k = -2/sqrt(7) [sin((2k - 1) pi/7), sin((2k - 1) 2pi/7), sin((2k - 1) 3pi/7)],   k = 1, 2, 3,
// the cube is the ring of integers of the field of cos(2pi/7) (Bayer-Fluckiger, Oggier & Viterbo, IEEE Trans.
// Inf. Theory 50, 702, 2004): |x y z| >= 1/7 for every point but the origin. A flow diag(a, b, c) with a + b
// + c = 0 keeps that product, so that points stay at least sqrt(3) / 7^(1/3) = 0.9054 apart. Lattices of this
// kind are those of Dobson, J. Chem. Phys. 141, 184103 (2014). The cell follows by changes of its basis
// (state/periodic_cell.h).
// Strain is Hencky strain, |rate| times time; the invariant sqrt(2 E:E) is sqrt(3) |rate|.
#pragma once

#include <cmath>

#include "engine/flow/flow_kind.h"

namespace peclet::engine {

class UniaxialExtension final : public Deformation {
 public:
  explicit UniaxialExtension(double rate) : rate_(rate) {}

  // Digits of the cell are lost as exp(3/2 strain): at this strain 7e-10 of its edges are.
  static constexpr double largest_strain = 10;

  Matrix3 velocity_gradient(double time) const override;
  Matrix3 displacement_gradient(double time) const override;
  double largest_rate() const override { return std::abs(rate_); }
  Matrix3 steady_gradient(double /*from*/) const override { return velocity_gradient(0); }
  double time_of(double strain, double /*from*/) const override { return strain / largest_rate(); }
  Matrix3 edges_at_start(const Vector3& box) const override;
  // sqrt(3) / 7^(1/3), rounded down.
  double nearest_image() const override { return 0.9054; }

 private:
  double rate_;
};

FlowKind uniaxial_extension_flow();

}  // namespace peclet::engine
