// Integrator advances a system by steps in time, whatever the method.
#pragma once

#include <optional>

#include "engine/kernels/force_field.h"

namespace peclet::engine {

// StepReport holds what a step reports.
struct StepReport {
  PairSums sums;  // sums of the forces that acted, including noise (kernels/pair_pass.h)
  // Stress of the motion times the volume: -sum m sym(V V') relative to the flow. With noise it is a part of
  // the stress. Without noise it is computed only after watch_motion().
  SymmetricTensor motion;
  // Largest displacement of a particle in this step, relative to the flow; NaN if one is not finite.
  double largest_displacement = 0;
  int solver_iterations = 0;   // 0 if the method solves no equations
  double solver_residual = 0;  // residual of the equations, relative to the motion
  int division = 0;            // the smallest part of the step was 2^-division of it
  bool broke_off = false;      // the step was not made: its smallest part has no solution
};

// StepOrigin stores the state at the start of a step and restores it.
class StepOrigin {
 public:
  // Stores what every step changes: positions, velocities, springs, cell and clock. They can be restored
  // until the list of neighbours is rebuilt.
  void mark(const System& system, int threads);
  // Stores the list as well, so that the state can be restored after rebuilds.
  void mark_with_list(const System& system, int threads);
  // Restores the stored state bit by bit. Requires a mark.
  void return_to(System& system, int threads) const;

  const VectorField& position() const { return marked_.particles.position; }
  const VectorField& velocity() const { return marked_.particles.velocity; }
  const VectorField& spin() const { return marked_.particles.angular_velocity; }
  const SpringField& springs() const { return marked_.springs; }

 private:
  System marked_;
};

// Integrator owns the forces between steps; the caller owns the system. After start() or load(), each
// advance() makes one step: positions, velocities, springs, box, list and step counter change.
class Integrator {
 public:
  virtual ~Integrator() = default;

  double timestep() const { return timestep_; }

  // Steps between samples of what is not accumulated at every step. They cost little of a run.
  struct Intervals {
    std::uint64_t sampling, energy, stability, comparison;
    int compared_steps;  // number in one comparison with half steps
  };
  virtual Intervals intervals() const = 0;

  // Makes steps report the stress of the motion from now on.
  void watch_motion() { watches_motion_ = true; }

  // Makes steps show the pairs of their report to the watcher, with this weight; null shows them no more.
  void show_pairs_to(PairWatcher* watcher, double weight = 1) {
    watcher_ = watcher;
    weight_ = weight;
  }

  // Prepares the springs, the clock and a new list of the system.
  virtual void start(System& system);
  StepReport advance(System& system) {
    const StepReport report = advance_open(system);
    complete(system);
    return report;
  }
  // Makes a step whose velocities, forces and torques are those of the full step only after complete(). A
  // method may leave work to the next step, which saves a pass over all particles.
  virtual StepReport advance_open(System& system) = 0;
  // Completes the last step; has no effect if it is complete.
  virtual void complete(System& system) = 0;

  // Returns the part of the method's stable range that the step uses at the present configuration. From 1 on
  // disturbances grow; it is 0 for a method that is stable at any step.
  virtual double stability_share(const System& system) const = 0;

  // Returns the energy that the last step has made because it is finite: dissipated and stored energy less
  // the work of the flow. It has no meaning with noise, and is empty for a method that does not count it.
  virtual std::optional<double> spurious_energy(const System& system) const = 0;

  // Returns the shear stress (ImposedFlow::shear_part) of pairs, times the volume, summed over the next
  // `steps` steps of a copy of the system; `halved` is the same in half steps, of which two count as one.
  // Requires a complete step. It has no meaning with noise, which half steps draw anew.
  struct HalfSteps {
    double whole = 0, halved = 0;
  };
  virtual HalfSteps compare_half_steps(const System& system, int steps) const = 0;

  // Stores the state before a step; return_to_mark() restores it repeatedly. Requires a complete step.
  virtual void mark(const System& system);
  virtual void return_to_mark(System& system);

  // Save and load what the integrator keeps between steps besides the system.
  virtual void save(ArchiveWriter& archive) const { archive.put(displacement_bound_); }
  virtual void load(ArchiveReader& archive) { archive.get_all(displacement_bound_); }

 protected:
  Integrator(ForceField field, double timestep) : field_(std::move(field)), timestep_(timestep) {}

  void rebuild_list(System& system);
  bool watches_motion() const { return watches_motion_; }
  PairWatcher* watcher() const { return watcher_; }
  double weight() const { return weight_; }

  ForceField field_;
  double timestep_;
  // An upper bound of the displacements since the list was built. Each step adds its largest one; the true
  // value replaces the bound when it comes near what the list allows.
  double displacement_bound_ = 0;

 private:
  StepOrigin mark_;
  double marked_bound_ = 0;
  bool watches_motion_ = false;
  PairWatcher* watcher_ = nullptr;
  double weight_ = 1;
};

// Returns true if the flow does not accelerate with this gradient: it is that of the cell, and L L = 0.
bool keeps_flow(const System& system, const Matrix3& gradient);

// Gives the cell this velocity gradient L, and adds to velocities and spins what the flow gains: by the
// change of L, and by `time` in it.
//
// The solvent at x has the acceleration (dL/dt + L L) x. Its pressure accelerates spheres of its density as
// well, by a force m (dL/dt + L L) x and a torque of the changing spin. By drag alone spheres would lag
// behind the flow by their inertial time, and by more the farther they are from the (arbitrary) origin. With
// these terms velocities relative to the flow obey dv/dt = F / m - L v, whatever the origin. In steady shear
// both are zero.
void follow_flow(System& system, const Matrix3& gradient, double time, int threads);

}  // namespace peclet::engine
