// SteadyShear, OscillatoryShear and CrossShear are simple shear at a given rate.
#pragma once

#include <cmath>
#include <limits>
#include <numbers>

#include "engine/flow/flow_kind.h"

namespace peclet::engine {

// SteadyShear is the flow u = (rate y, 0, 0), constant in time; a fluid at rest if the rate is 0.
class SteadyShear final : public Deformation {
 public:
  explicit SteadyShear(double rate) : rate_(rate) {}

  Matrix3 velocity_gradient(double /*time*/) const override { return simple_shear(rate_); }
  Matrix3 displacement_gradient(double time) const override { return simple_shear(rate_ * time); }
  Matrix3 displacement_gradient(const Clock& clock) const override {
    return simple_shear(rate_ * clock.origin + rate_ * clock.timestep * static_cast<double>(clock.steps));
  }
  double largest_rate() const override { return rate_ < 0 ? -rate_ : rate_; }
  Matrix3 steady_gradient(double /*from*/) const override { return simple_shear(rate_); }
  double time_of(double strain, double /*from*/) const override {
    return rate_ == 0 ? std::numeric_limits<double>::infinity() : strain / largest_rate();
  }

 private:
  double rate_;
};

inline ImposedFlow steady_shear(double rate) { return ImposedFlow(std::make_shared<SteadyShear>(rate)); }

FlowKind steady_shear_flow();

// OscillatoryShear is simple shear of the strain g sin(w t). It begins at time 0 without strain, at its
// largest rate g w.
class OscillatoryShear final : public Deformation {
 public:
  // Amplitude g > 0 and frequency w > 0 [radians/time].
  OscillatoryShear(double amplitude, double frequency) : amplitude_(amplitude), frequency_(frequency) {}

  Matrix3 velocity_gradient(double time) const override {
    return simple_shear(amplitude_ * frequency_ * std::cos(frequency_ * time));
  }
  Matrix3 displacement_gradient(double time) const override {
    return simple_shear(amplitude_ * std::sin(frequency_ * time));
  }
  double largest_rate() const override { return amplitude_ * frequency_; }
  double mean_rate() const override { return 2 * amplitude_ * frequency_ / std::numbers::pi; }
  Matrix3 steady_gradient(double /*from*/) const override { return {}; }
  std::optional<Swing> swing() const override { return Swing{amplitude_, frequency_, &SymmetricTensor::xy}; }
  // Requires `from` at the end of a cycle. Each quarter of a cycle strains by g, alternately away from the
  // cube and back.
  double time_of(double strain, double /*from*/) const override {
    if (std::isinf(strain)) return strain;
    const double quarters = std::floor(strain / amplitude_), rest = strain / amplitude_ - quarters;
    const bool away = std::fmod(quarters, 2) == 0;
    const double phase = away ? std::asin(rest) : std::acos(1 - rest);
    return (0.5 * std::numbers::pi * quarters + phase) / frequency_;
  }

 private:
  double amplitude_, frequency_;
};

// CrossShear superposes the steady flow u_x = rate y and the oscillation u_z = g w cos(w t) y (orthogonal
// superposition). Only the steady part counts as strain.
class CrossShear final : public Deformation {
 public:
  CrossShear(double rate, double amplitude, double frequency)
      : rate_(rate), amplitude_(amplitude), frequency_(frequency) {}

  Matrix3 velocity_gradient(double time) const override {
    return shears_along_y(rate_, amplitude_ * frequency_ * std::cos(frequency_ * time));
  }
  // Adds the two shears, which commute: neither moves what the other one shears.
  Matrix3 displacement_gradient(double time) const override {
    return shears_along_y(rate_ * time, amplitude_ * std::sin(frequency_ * time));
  }
  double largest_rate() const override { return std::hypot(rate_, amplitude_ * frequency_); }
  double mean_rate() const override { return rate_; }
  Matrix3 steady_gradient(double /*from*/) const override { return simple_shear(rate_); }
  std::optional<Swing> swing() const override { return Swing{amplitude_, frequency_, &SymmetricTensor::yz}; }
  double time_of(double strain, double /*from*/) const override { return strain / rate_; }

 private:
  // Returns the gradient with du_x / dy = x and du_z / dy = z.
  static Matrix3 shears_along_y(double x, double z) { return {Vector3{}, Vector3{x, 0, z}, Vector3{}}; }

  double rate_, amplitude_, frequency_;
};

FlowKind oscillation_flow();
FlowKind cross_shear_flow();

}  // namespace peclet::engine
