// Oscillating shear, alone or across a steady one.
#pragma once

#include "engine/flow/flow_kind.h"

namespace peclet::engine {

// Simple shear gamma = g sin(w t), which begins at time 0 in the undeformed cell at its largest rate, g w.
class OscillatoryShear final : public Deformation {
 public:
  // Amplitude g > 0 and frequency w > 0 [radians/time].
  OscillatoryShear(double amplitude, double frequency) : amplitude_(amplitude), frequency_(frequency) {}

  Matrix3 velocity_gradient(double time) const override;
  Matrix3 displacement_gradient(double time) const override;
  double largest_rate() const override { return amplitude_ * frequency_; }
  double mean_rate() const override;
  Matrix3 steady_gradient(double /*from*/) const override { return {}; }
  std::optional<Swing> swing() const override { return Swing{amplitude_, frequency_, &SymmetricTensor::xy}; }
  // `from` must be the end of a cycle.
  double time_of(double strain, double from) const override;

 private:
  double amplitude_, frequency_;
};

// Simple shear (rate y, 0, 0) and across it u_z = g w cos(w t) y: orthogonal superposition. Only the steady
// part counts as strain.
class CrossShear final : public Deformation {
 public:
  CrossShear(double rate, double amplitude, double frequency)
      : rate_(rate), amplitude_(amplitude), frequency_(frequency) {}

  Matrix3 velocity_gradient(double time) const override;
  Matrix3 displacement_gradient(double time) const override;
  double largest_rate() const override;
  double mean_rate() const override { return rate_; }
  Matrix3 steady_gradient(double /*from*/) const override { return simple_shear(rate_); }
  std::optional<Swing> swing() const override { return Swing{amplitude_, frequency_, &SymmetricTensor::yz}; }
  double time_of(double strain, double /*from*/) const override { return strain / rate_; }

 private:
  double rate_, amplitude_, frequency_;
};

FlowKind oscillation_flow();
FlowKind cross_shear_flow();

}  // namespace peclet::engine
