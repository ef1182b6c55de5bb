// How the periodic cell deforms in time, and with it the uniform part of the flow: dH/dt = L(t) H.
//
// The cell keeps what it has made: its displacement gradient D and its present L are state of the system.
#pragma once

#include <memory>
#include <numbers>
#include <optional>

#include "engine/flow/background_flow.h"
#include "engine/state/system.h"

namespace peclet::engine {

class Deformation {
 public:
  virtual ~Deformation() = default;

  // L at this time, and the displacement gradient made since time 0.
  virtual Matrix3 velocity_gradient(double time) const = 0;
  virtual Matrix3 displacement_gradient(double time) const = 0;
  // After whole steps. Overridden where the steps can be counted without rounding the time first.
  virtual Matrix3 displacement_gradient(const Clock& clock) const {
    return displacement_gradient(clock.time());
  }

  virtual double largest_rate() const = 0;
  // Strain over time in the long run, summed over both directions.
  virtual double mean_rate() const { return largest_rate(); }
  // After which all comes back; nothing where the flow is steady.
  virtual std::optional<double> period() const { return std::nullopt; }
  // When the strain, summed over both directions, has come to this; infinity if it never does.
  virtual double time_of(double strain) const = 0;

  // Brings the cell to where it is at this time.
  void drive(PeriodicCell& cell, double time) const {
    cell.deform(displacement_gradient(time), velocity_gradient(time));
  }
  void drive(PeriodicCell& cell, const Clock& clock) const {
    cell.deform(displacement_gradient(clock), velocity_gradient(clock.time()));
  }
};

// Simple shear (rate y, 0, 0), constant in time.
class SteadyShear final : public Deformation {
 public:
  explicit SteadyShear(double rate) : rate_(rate) {}

  Matrix3 velocity_gradient(double time) const override;
  Matrix3 displacement_gradient(double time) const override;
  Matrix3 displacement_gradient(const Clock& clock) const override;
  double largest_rate() const override { return rate_ < 0 ? -rate_ : rate_; }
  double time_of(double strain) const override;

 private:
  double rate_;
};

// Simple shear to and fro, gamma = g sin(w t): at rate g w through the cube, which it finds at time 0.
class OscillatoryShear final : public Deformation {
 public:
  // Both above 0; the frequency w in radians per time.
  OscillatoryShear(double amplitude, double frequency) : amplitude_(amplitude), frequency_(frequency) {}

  double amplitude() const { return amplitude_; }
  double frequency() const { return frequency_; }

  Matrix3 velocity_gradient(double time) const override;
  Matrix3 displacement_gradient(double time) const override;
  double largest_rate() const override { return amplitude_ * frequency_; }
  double mean_rate() const override { return 4 * amplitude_ / *period(); }
  std::optional<double> period() const override { return 2 * std::numbers::pi / frequency_; }
  double time_of(double strain) const override;

 private:
  double amplitude_, frequency_;
};

// What a scene says of its flow; copies share it. A fluid at rest unless something else is said.
class ImposedFlow {
 public:
  ImposedFlow() : ImposedFlow(std::make_shared<SteadyShear>(0)) {}
  explicit ImposedFlow(std::shared_ptr<const Deformation> deformation,
                       std::shared_ptr<const FlowVariation> variation = nullptr)
      : deformation_(std::move(deformation)), variation_(std::move(variation)) {}

  const Deformation& deformation() const { return *deformation_; }
  // The largest shear rate of the cell, which sets times; 0 where it keeps its shape.
  double rate() const { return deformation_->largest_rate(); }
  // That of a steady flow, which sets the unit of stresses; 0 where it comes and goes.
  double steady_rate() const { return period() ? 0 : rate(); }
  std::optional<double> period() const { return deformation_->period(); }
  bool varies() const { return variation_ != nullptr; }
  // At least that of the strongest gradient anywhere in this cell.
  double largest_rate(const PeriodicCell& cell) const {
    return rate() + (varies() ? variation_->largest_rate(cell) : 0);
  }
  // The flow of this moment. The cell must outlive it.
  BackgroundFlow at(const PeriodicCell& cell) const { return BackgroundFlow(cell, variation_.get()); }

 private:
  std::shared_ptr<const Deformation> deformation_;
  std::shared_ptr<const FlowVariation> variation_;  // of the flow within the cell, if it varies
};

inline ImposedFlow steady_shear(double rate) { return ImposedFlow(std::make_shared<SteadyShear>(rate)); }

}  // namespace peclet::engine
