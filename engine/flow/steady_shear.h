// Simple shear at one rate: the flow of a scene that asks for no other, at rest where the rate is 0.
#pragma once

#include "engine/flow/flow_kind.h"

namespace peclet::engine {

// Simple shear (rate y, 0, 0), constant in time.
class SteadyShear final : public Deformation {
 public:
  explicit SteadyShear(double rate) : rate_(rate) {}

  Matrix3 velocity_gradient(double time) const override;
  Matrix3 displacement_gradient(double time) const override;
  Matrix3 displacement_gradient(const Clock& clock) const override;
  double largest_rate() const override { return rate_ < 0 ? -rate_ : rate_; }
  Matrix3 steady_gradient(double /*from*/) const override { return simple_shear(rate_); }
  double time_of(double strain, double from) const override;

 private:
  double rate_;
};

inline ImposedFlow steady_shear(double rate) { return ImposedFlow(std::make_shared<SteadyShear>(rate)); }

FlowKind steady_shear_flow();

}  // namespace peclet::engine
