// ControlledShear is simple shear at a given stress. Its rate is constant in each step; realisation/driver.h
// sets it.
#pragma once

#include <limits>

#include "engine/flow/flow_kind.h"

namespace peclet::engine {

class ControlledShear final : public Deformation {
 public:
  // `rate` is the rate at the start and an estimate of the largest one [1/time]. `viscosity` is that of the
  // solvent. `jammed_viscosity` is the relative viscosity above which the suspension counts as jammed.
  ControlledShear(double stress, double rate, double viscosity, double jammed_viscosity)
      : stress_(stress),
        stress_time_(viscosity / stress),
        patience_(least_strain * jammed_viscosity * viscosity / stress),
        usual_rate_(rate),
        rate_(rate) {}

  const ControlledShear* at_stress() const override { return this; }
  double stress() const { return stress_; }
  double stress_time() const { return stress_time_; }  // viscosity / stress, the unit of time
  // A suspension has jammed if it does not strain by `least_strain` within its patience [time],
  //   patience = least_strain jammed_viscosity viscosity / stress.
  static constexpr double least_strain = 0.01;
  double patience() const { return patience_; }
  double present_rate() const { return rate_; }

  // Continues from this time and strain at this rate.
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
  // Returns infinity, because future strain is unknown.
  double time_of(double /*strain*/, double /*from*/) const override {
    return std::numeric_limits<double>::infinity();
  }

 private:
  double stress_, stress_time_, patience_, usual_rate_;
  double time_ = 0, strain_ = 0, rate_;
};

FlowKind stress_flow();

}  // namespace peclet::engine
