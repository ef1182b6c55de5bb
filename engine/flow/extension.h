// PlanarExtension and UniaxialExtension stretch the fluid at a constant rate. The cell stays compact by
// changes of its basis (state/periodic_cell.h).
#pragma once

#include <cmath>
#include <numbers>

#include "engine/flow/flow_kind.h"

namespace peclet::engine {

// PlanarExtension is the flow u = rate (x, -y, 0) [rate: 1/time].
//
// A square lattice in the plane, turned by atan(2) / 2, coincides with itself after every Hencky strain of
// ln((3 + sqrt 5) / 2) = 0.9624. Its points never come closer than 0.946 of its edge (Kraynik & Reinelt, Int.
// J. Multiphase Flow 18, 1045 (1992)). Strain is Hencky strain, rate times time; sqrt(2 E:E) is 2 rate.
class PlanarExtension final : public Deformation {
 public:
  explicit PlanarExtension(double rate) : rate_(rate) {}

  // The largest strain of a realisation. Edges of the cell lose digits as exp(2 strain), because they follow
  // from those at the start: here their relative error is 5e-8.
  static constexpr double largest_strain = 10;

  Matrix3 velocity_gradient(double /*time*/) const override {
    return {Vector3{rate_, 0, 0}, Vector3{0, -rate_, 0}, Vector3{}};
  }
  Matrix3 displacement_gradient(double time) const override {
    return {Vector3{std::expm1(rate_ * time), 0, 0}, Vector3{0, std::expm1(-rate_ * time), 0}, Vector3{}};
  }
  double largest_rate() const override { return rate_; }
  Matrix3 steady_gradient(double /*from*/) const override { return velocity_gradient(0); }
  double time_of(double strain, double /*from*/) const override { return strain / rate_; }
  Matrix3 edges_at_start(const Vector3& box) const override {
    const double angle = 0.5 * std::atan(2.0), c = std::cos(angle), s = std::sin(angle);
    return {box.x * Vector3{c, s, 0}, box.y * Vector3{-s, c, 0}, Vector3{0, 0, box.z}};
  }
  double nearest_image() const override { return 0.9457; }  // sqrt(2) / 5^(1/4), rounded down

 private:
  double rate_;
};

FlowKind planar_extension_flow();

// UniaxialExtension is the flow u = rate (x, -y/2, -z/2) [rate: 1/time]; biaxial extension if rate < 0.
//
// No lattice coincides with itself again in this flow, but points of a suitably turned cubic lattice never
// come close to each other (Dobson, J. Chem. Phys. 141, 184103 (2014)). Its edges of length 1 are
//   e_k = -2/sqrt(7) [sin((2k - 1) pi/7), sin((2k - 1) 2pi/7), sin((2k - 1) 3pi/7)],   k = 1, 2, 3.
// The lattice is the ring of integers of the field of cos(2pi/7) (Bayer-Fluckiger, Oggier & Viterbo, IEEE
// Trans. Inf. Theory 50, 702, 2004): |x y z| >= 1/7 for every point but the origin. A flow diag(a, b, c) with
// a + b + c = 0 keeps that product, so points stay at least sqrt(3) / 7^(1/3) = 0.9054 apart. Strain is
// Hencky strain, |rate| times time; sqrt(2 E:E) is sqrt(3) |rate|.
class UniaxialExtension final : public Deformation {
 public:
  explicit UniaxialExtension(double rate) : rate_(rate) {}

  // The largest strain of a realisation. Edges lose digits as exp(3/2 strain): their error here is 7e-10.
  static constexpr double largest_strain = 10;

  Matrix3 velocity_gradient(double /*time*/) const override {
    return {Vector3{rate_, 0, 0}, Vector3{0, -0.5 * rate_, 0}, Vector3{0, 0, -0.5 * rate_}};
  }
  Matrix3 displacement_gradient(double time) const override {
    const double across = std::expm1(-0.5 * rate_ * time);
    return {Vector3{std::expm1(rate_ * time), 0, 0}, Vector3{0, across, 0}, Vector3{0, 0, across}};
  }
  double largest_rate() const override { return std::abs(rate_); }
  Matrix3 steady_gradient(double /*from*/) const override { return velocity_gradient(0); }
  double time_of(double strain, double /*from*/) const override { return strain / largest_rate(); }
  Matrix3 edges_at_start(const Vector3& box) const override {
    const auto edge = [](int k, double length) {
      const double angle = (2 * k - 1) * std::numbers::pi / 7, scale = -2 * length / std::sqrt(7.0);
      return scale * Vector3{std::sin(angle), std::sin(2 * angle), std::sin(3 * angle)};
    };
    return {edge(1, box.x), edge(2, box.y), edge(3, box.z)};
  }
  double nearest_image() const override { return 0.9054; }  // sqrt(3) / 7^(1/3), rounded down

 private:
  double rate_;
};

FlowKind uniaxial_extension_flow();

}  // namespace peclet::engine
