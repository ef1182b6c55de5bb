// One step in time, whatever the method.
#pragma once

#include <optional>

#include "engine/kernels/force_field.h"

namespace peclet::engine {

// What a step says about itself.
struct StepReport {
  PairSums sums;  // of the forces that acted, those of the noise included (kernels/pair_pass.h)
  // The stress of the motion, times the volume: -sum m sym(V V') relative to the flow. With noise it belongs
  // to the stress; without noise it is computed where it is asked for.
  SymmetricTensor motion;
  double largest_displacement =
      0;  // of a particle relative to the streaming flow, in this step; NaN if one is not finite
  int solver_iterations = 0;   // of a method that solves for the velocities
  double solver_residual = 0;  // what its equations are left with, relative to the motion
  int division = 0;        // of a method that divides steps: the smallest part was 2^-division of the step
  bool broke_off = false;  // the step was not made: not even its smallest part has velocities
};

// The state that a step starts from, and the way back to it.
class StepOrigin {
 public:
  // Copies what every step changes: places, motion, springs, cell and clock. The way back leads to them as
  // long as the list of neighbours is the same.
  void mark(const System& system, int threads);
  // Copies the list as well, if it has been rebuilt since it was last copied. The way back then leads across
  // rebuilds.
  void mark_with_list(const System& system, int threads);
  // Makes the system what it was at the mark, bit by bit. Requires a mark.
  void return_to(System& system, int threads) const;

  const VectorField& position() const { return marked_.particles.position; }
  const VectorField& velocity() const { return marked_.particles.velocity; }
  const VectorField& spin() const { return marked_.particles.angular_velocity; }
  const SpringField& springs() const { return marked_.springs; }

 private:
  System marked_;
};

// Owns the forces between steps; the system belongs to the caller. After start() or load(), each advance()
// takes the system from one step to the next: positions, velocities, springs, box, list and step counter.
class Integrator {
 public:
  virtual ~Integrator() = default;

  double timestep() const { return timestep_; }

  // Steps between looks at what is not accumulated at every step: seldom enough to cost little of a run.
  struct Intervals {
    std::uint64_t sampling, energy, stability, comparison;
    int compared_steps;  // in one comparison with half steps
  };
  virtual Intervals intervals() const = 0;

  // From now on steps report the stress of the motion.
  void watch_motion() { watches_motion_ = true; }

  // Until this is said again, steps show the pairs of their report, with this weight. Null: nobody looks.
  void show_pairs_to(PairWatcher* watcher, double weight = 1) {
    watcher_ = watcher;
    weight_ = weight;
  }

  // Begins with this system: its springs, its clock and a new list.
  virtual void start(System& system);
  StepReport advance(System& system) {
    const StepReport report = advance_open(system);
    complete(system);
    return report;
  }
  // The same, but velocities, forces and torques are those of the full step only after complete(). A method
  // may leave a part of the work to the next step, which saves a walk through all particles.
  virtual StepReport advance_open(System& system) = 0;
  virtual void complete(System& system) = 0;  // nothing happens when the step is complete

  // The part of the method's stable range that the step uses at the present configuration: from 1 on
  // disturbances grow. 0 for a method that is stable at any step.
  virtual double stability_share(const System& system) const = 0;

  // The energy that the last step has made (or lost, below 0) because it is finite: dissipated and stored
  // energy less the work of the flow. Means nothing with noise; nothing of a method that does not count it.
  virtual std::optional<double> spurious_energy(const System& system) const = 0;

  // The shear stress (ImposedFlow::shear_part) of pairs, times the volume, summed over the next `steps` steps
  // of a copy of the (complete) system; and over the same time with steps of half the size, of which two
  // count as one. Means nothing with noise, which another step draws anew.
  struct HalfSteps {
    double whole = 0, halved = 0;
  };
  virtual HalfSteps compare_half_steps(const System& system, int steps) const = 0;

  // Marks the state before a step, to which return_to_mark() leads back any number of times. Requires a
  // complete step.
  virtual void mark(const System& system);
  virtual void return_to_mark(System& system);

  // What the integrator keeps between steps besides the system.
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
  // An upper bound of the displacements since the list was built. A step raises it by its largest one; the
  // true value replaces it when it comes near what the list allows.
  double displacement_bound_ = 0;

 private:
  StepOrigin mark_;
  double marked_bound_ = 0;
  bool watches_motion_ = false;
  PairWatcher* watcher_ = nullptr;
  double weight_ = 1;
};

// Spheres in a flow whose gradient changes, or stretches them with the fluid.
//
// The solvent at x has the acceleration (dL/dt + L L) x, and what accelerates it accelerates spheres of its
// density as well: its pressure. A force m (dL/dt + L L) x and a torque of the changing spin stand for that.
// Without them spheres would lag behind the flow by their inertial time, by more the farther they are from
// the origin, which is no place of a periodic suspension; with them velocities relative to the flow follow
// dv/dt = F / m - L v, whatever the origin. In steady shear both terms are zero.
//
// Whether the flow gains nothing by having this gradient, for a while, in the place of the cell's.
bool keeps_flow(const System& system, const Matrix3& gradient);

// Gives the cell this velocity gradient, and to velocities and spins what the flow has gained: by the change
// of the gradient, and by `time` in it.
void follow_flow(System& system, const Matrix3& gradient, double time, int threads);

}  // namespace peclet::engine
