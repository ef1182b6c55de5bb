// Deformation tells how the periodic cell deforms in time, and thus the uniform part of the flow:
//   dH/dt = L(t) H
// with the lattice vectors as columns of H and the velocity gradient L [1/time].
//
// The system keeps the displacement gradient D of its cell and the present L. A deformation has no state,
// except for the rate of one at a given stress. The defaults are those of a constant rate: override them
// where a flow differs.
#pragma once

#include <memory>
#include <optional>

#include "engine/flow/background_flow.h"
#include "engine/state/system.h"

namespace peclet::engine {

// Swing is an oscillating strain g sin(w t) and the stress component that it drives.
struct Swing {
  double amplitude = 0, frequency = 0;  // g, and w [radians/time]
  double SymmetricTensor::*component = &SymmetricTensor::xy;
};

class ControlledShear;

class Deformation {
 public:
  virtual ~Deformation() = default;

  // Return L at this time, and the displacement gradient D since time 0.
  virtual Matrix3 velocity_gradient(double time) const = 0;
  virtual Matrix3 displacement_gradient(double time) const = 0;
  // Returns D at the time of the clock. Override it to avoid rounding the time first.
  virtual Matrix3 displacement_gradient(const Clock& clock) const {
    return displacement_gradient(clock.time());
  }

  // Returns the largest rate of strain at any time [1/time].
  virtual double largest_rate() const = 0;
  // Returns the long-time average of the strain per time [1/time], summed over both directions.
  virtual double mean_rate() const { return largest_rate(); }
  // Returns true if L jumps in [from, to).
  virtual bool jumps_between(double /*from*/, double /*to*/) const { return false; }
  // Returns the steady part of L after `from`, without the oscillation; 0 if no part is steady.
  virtual Matrix3 steady_gradient(double from) const = 0;
  // Returns the shortest distance between images of a point at any time, over the edge of the initial cube.
  virtual double nearest_image() const { return 1; }
  // Returns this flow if its stress is given; null if its rate is given.
  virtual const ControlledShear* at_stress() const { return nullptr; }
  // Returns the oscillating part; empty in a flow without oscillation.
  virtual std::optional<Swing> swing() const { return std::nullopt; }
  // Returns the time after `from` in which the cell makes this strain, summed over both directions; infinity
  // if it never does.
  virtual double time_of(double strain, double from) const = 0;
  // Returns the strain of the steps `from` to `to` of a run, summed over both directions.
  virtual double strain_between(double timestep, std::uint64_t from, std::uint64_t to) const {
    return timestep * mean_rate() * static_cast<double>(to - from);
  }
  // Returns the initial lattice vectors of a box with these edges, as columns.
  virtual Matrix3 edges_at_start(const Vector3& box) const {
    return {Vector3{box.x, 0, 0}, Vector3{0, box.y, 0}, Vector3{0, 0, box.z}};
  }
};

// ImposedFlow is the flow that a scene imposes: a deformation of the cell and the variation within it. Copies
// share both. By default the fluid is at rest.
class ImposedFlow {
 public:
  ImposedFlow();
  explicit ImposedFlow(std::shared_ptr<const Deformation> deformation,
                       std::shared_ptr<const FlowVariation> variation = nullptr)
      : deformation_(std::move(deformation)), variation_(std::move(variation)) {
    measure_from(0);
  }

  const Deformation& deformation() const { return *deformation_; }
  // Returns the largest rate of strain of the cell [1/time]; 0 if the cell keeps its shape.
  double rate() const { return deformation_->largest_rate(); }
  // Returns the rate sqrt(2 E:E) [1/time] of the flow that is steady in the window of all means; 0 if no part
  // is. Times the viscosity it is the unit of stresses.
  double steady_rate() const { return steady_rate_; }
  const Matrix3& steady_gradient() const { return steady_gradient_; }
  // Begins the window of all means at this time.
  void measure_from(double time);
  // Returns E / sqrt(2 E:E) of the steady part; that of simple shear if no part is steady.
  const SymmetricTensor& direction() const { return direction_; }
  // Returns the part of a stress that does the work of the steady flow, sigma:E / sqrt(2 E:E): sigma_xy in
  // simple shear, and if no part of the flow is steady.
  double shear_part(const SymmetricTensor& stress) const;
  // Returns the period of the oscillation [time]; empty without an oscillation.
  std::optional<double> period() const;
  // Returns true if one gradient, constant in the window, does all work. The work of waves and of cycles does
  // not show in the mean stress: it cancels over the cell, or over time.
  bool is_steady() const { return steady_rate_ > 0 && !varies() && !deformation_->swing(); }
  bool varies() const { return variation_ != nullptr; }
  // Returns an upper bound of the velocity gradient anywhere in this cell [1/time].
  double largest_rate(const PeriodicCell& cell) const {
    return rate() + (varies() ? variation_->largest_rate(cell) : 0);
  }
  // Returns the flow in this cell, which must outlive the result.
  BackgroundFlow at(const PeriodicCell& cell) const { return BackgroundFlow(cell, variation_.get()); }

 private:
  std::shared_ptr<const Deformation> deformation_;
  std::shared_ptr<const FlowVariation> variation_;  // null if the flow is uniform
  Matrix3 steady_gradient_;
  double steady_rate_ = 0;
  SymmetricTensor direction_;
};

}  // namespace peclet::engine
