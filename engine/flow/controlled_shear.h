// Simple shear at a given stress: its rate, constant in each step, is set from step to step by what controls
// it (realisation/stress_control.h).
#pragma once

#include <limits>
#include <memory>

#include "engine/flow/deformation.h"

namespace peclet::engine {

class ControlledShear final : public Deformation {
 public:
  // `rate`: at the start, and an estimate of the largest one, which sets times.
  ControlledShear(double stress, double rate) : stress_(stress), usual_rate_(rate), rate_(rate) {}

  std::optional<double> stress() const override { return stress_; }
  double present_rate() const { return rate_; }

  // From this time and strain on.
  void go_on(double time, double strain, double rate) {
    time_ = time;
    strain_ = strain;
    rate_ = rate;
  }

  Matrix3 velocity_gradient(double /*time*/) const override { return simple_shear(rate_); }
  Matrix3 displacement_gradient(double time) const override {
    return simple_shear(strain_ + rate_ * (time - time_));
  }
  double largest_rate() const override { return usual_rate_; }
  Matrix3 steady_gradient(double /*from*/) const override { return {}; }
  // No strain is known beforehand.
  double time_of(double /*strain*/, double /*from*/) const override {
    return std::numeric_limits<double>::infinity();
  }
  std::shared_ptr<Deformation> own_copy() const override { return std::make_shared<ControlledShear>(*this); }

 private:
  double stress_, usual_rate_;
  double time_ = 0, strain_ = 0, rate_;
};

}  // namespace peclet::engine
