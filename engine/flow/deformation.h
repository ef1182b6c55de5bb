// How the periodic cell deforms in time, and with it the uniform part of the flow: dH/dt = L(t) H.
//
// The cell keeps what it has made: its displacement gradient D and its present L are state of the system.
#pragma once

#include <memory>
#include <optional>

#include "engine/flow/background_flow.h"
#include "engine/state/system.h"

namespace peclet::engine {

// A strain g sin(w t), and where its stress is.
struct Swing {
  double amplitude = 0, frequency = 0;  // g, and w in radians per time
  double SymmetricTensor::*component = &SymmetricTensor::xy;
};

class ControlledShear;

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
  // Whether L jumps in this interval, of which the end is not part.
  virtual bool jumps_between(double /*from*/, double /*to*/) const { return false; }
  // What of L is constant from this time on, but for what comes and goes; 0 where nothing is.
  virtual Matrix3 steady_gradient(double from) const = 0;
  // The shortest distance between images of a point at any time, over the edge of the cube that the box is.
  virtual double nearest_image() const { return 1; }
  // The flow as one at a given stress; null if its rate is given.
  virtual const ControlledShear* at_stress() const { return nullptr; }
  // What comes and goes.
  virtual std::optional<Swing> swing() const { return std::nullopt; }
  // The time after `from` at which the strain since then, summed over both directions, has come to this;
  // infinity if it never does.
  virtual double time_of(double strain, double from) const = 0;
  // The strain of these steps out of a run, summed over both directions.
  virtual double strain_between(double timestep, std::uint64_t from, std::uint64_t to) const {
    return timestep * mean_rate() * static_cast<double>(to - from);
  }
  // The lattice vectors of a box with these edges when it starts.
  virtual Matrix3 edges_at_start(const Vector3& box) const {
    return {Vector3{box.x, 0, 0}, Vector3{0, box.y, 0}, Vector3{0, 0, box.z}};
  }
};

// What a scene says of its flow; copies share it. A fluid at rest unless something else is said.
class ImposedFlow {
 public:
  ImposedFlow();
  explicit ImposedFlow(std::shared_ptr<const Deformation> deformation,
                       std::shared_ptr<const FlowVariation> variation = nullptr)
      : deformation_(std::move(deformation)), variation_(std::move(variation)) {
    measure_from(0);
  }

  const Deformation& deformation() const { return *deformation_; }
  // The largest shear rate of the cell, which sets times; 0 where it keeps its shape.
  double rate() const { return deformation_->largest_rate(); }
  // That of the flow that is constant in the window of all means, sqrt(2 E:E), which sets the unit of
  // stresses; 0 where none is.
  double steady_rate() const { return steady_rate_; }
  const Matrix3& steady_gradient() const { return steady_gradient_; }
  // The window begins at this time.
  void measure_from(double time);
  // Its rate of strain, E / sqrt(2 E:E).
  const SymmetricTensor& direction() const { return direction_; }
  // The part of a stress that does the work of the steady flow, over its rate: sigma:E / sqrt(2 E:E), which
  // is sigma_xy in simple shear; that also where no flow is steady.
  double shear_part(const SymmetricTensor& stress) const;
  std::optional<double> period() const;
  // Whether all work is that of one gradient, which is constant in the window: the work of waves cancels over
  // the cell, that of cycles over time.
  bool is_steady() const { return steady_rate_ > 0 && !varies() && !deformation_->swing(); }
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
  Matrix3 steady_gradient_;
  double steady_rate_ = 0;
  SymmetricTensor direction_;
};

}  // namespace peclet::engine
