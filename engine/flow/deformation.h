// The deformation of the periodic cell in time, and with it the uniform part of the flow: dH/dt = L(t) H.
//
// The system keeps the displacement gradient D of its cell and the present L; a deformation has no state,
// except for the rate of one at a given stress. Override what has a default here where a flow differs from
// one at a constant rate.
#pragma once

#include <memory>
#include <optional>

#include "engine/flow/background_flow.h"
#include "engine/state/system.h"

namespace peclet::engine {

// An oscillating strain g sin(w t), and the component of its stress.
struct Swing {
  double amplitude = 0, frequency = 0;  // g, and w in radians per time
  double SymmetricTensor::*component = &SymmetricTensor::xy;
};

class ControlledShear;

class Deformation {
 public:
  virtual ~Deformation() = default;

  // The velocity gradient L at this time, and the displacement gradient D since time 0.
  virtual Matrix3 velocity_gradient(double time) const = 0;
  virtual Matrix3 displacement_gradient(double time) const = 0;
  // D after whole steps. Override it if D follows from the number of steps without rounding the time first.
  virtual Matrix3 displacement_gradient(const Clock& clock) const {
    return displacement_gradient(clock.time());
  }

  virtual double largest_rate() const = 0;
  // Strain per time in the long run, summed over both directions.
  virtual double mean_rate() const { return largest_rate(); }
  // Returns whether L jumps in [from, to).
  virtual bool jumps_between(double /*from*/, double /*to*/) const { return false; }
  // Returns the steady part of L after `from`, without the oscillation; 0 if no part is steady.
  virtual Matrix3 steady_gradient(double from) const = 0;
  // The shortest distance between images of a point at any time, over the edge of the cube that the box is.
  virtual double nearest_image() const { return 1; }
  // The flow as one at a given stress; null if its rate is given.
  virtual const ControlledShear* at_stress() const { return nullptr; }
  // The oscillating part, if there is one.
  virtual std::optional<Swing> swing() const { return std::nullopt; }
  // Returns the time after `from` in which the cell makes this strain, summed over both directions; infinity
  // if it never does.
  virtual double time_of(double strain, double from) const = 0;
  // Strain of the steps `from` to `to` of a run, summed over both directions.
  virtual double strain_between(double timestep, std::uint64_t from, std::uint64_t to) const {
    return timestep * mean_rate() * static_cast<double>(to - from);
  }
  // Lattice vectors, as columns, at the start of a box with these edges.
  virtual Matrix3 edges_at_start(const Vector3& box) const {
    return {Vector3{box.x, 0, 0}, Vector3{0, box.y, 0}, Vector3{0, 0, box.z}};
  }
};

// The flow that a scene imposes: a deformation of the cell, and the variation within it. Copies share both.
// By default the fluid is at rest.
class ImposedFlow {
 public:
  ImposedFlow();
  explicit ImposedFlow(std::shared_ptr<const Deformation> deformation,
                       std::shared_ptr<const FlowVariation> variation = nullptr)
      : deformation_(std::move(deformation)), variation_(std::move(variation)) {
    measure_from(0);
  }

  const Deformation& deformation() const { return *deformation_; }
  // The largest shear rate of the cell, which sets times; 0 if the cell keeps its shape.
  double rate() const { return deformation_->largest_rate(); }
  // Rate sqrt(2 E:E) of the part of the flow that is constant in the window of all means, which sets the unit
  // of stresses; 0 if no part is.
  double steady_rate() const { return steady_rate_; }
  const Matrix3& steady_gradient() const { return steady_gradient_; }
  // Begins the window at this time.
  void measure_from(double time);
  // Rate of strain of the steady part, E / sqrt(2 E:E).
  const SymmetricTensor& direction() const { return direction_; }
  // Returns the part of a stress that does the work of the steady flow, sigma:E / sqrt(2 E:E): sigma_xy in
  // simple shear, and if no part of the flow is steady.
  double shear_part(const SymmetricTensor& stress) const;
  std::optional<double> period() const;
  // Returns whether one gradient, constant in the window, does all work: the stress of waves cancels over the
  // cell, that of cycles over time.
  bool is_steady() const { return steady_rate_ > 0 && !varies() && !deformation_->swing(); }
  bool varies() const { return variation_ != nullptr; }
  // An upper bound of the velocity gradient anywhere in this cell.
  double largest_rate(const PeriodicCell& cell) const {
    return rate() + (varies() ? variation_->largest_rate(cell) : 0);
  }
  // Returns the flow in this cell, which must outlive it.
  BackgroundFlow at(const PeriodicCell& cell) const { return BackgroundFlow(cell, variation_.get()); }

 private:
  std::shared_ptr<const Deformation> deformation_;
  std::shared_ptr<const FlowVariation> variation_;  // of the flow within the cell, if it varies
  Matrix3 steady_gradient_;
  double steady_rate_ = 0;
  SymmetricTensor direction_;
};

}  // namespace peclet::engine
