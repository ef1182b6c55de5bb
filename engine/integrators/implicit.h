// Implicit is the base of methods whose steps are not limited by the rate of lubrication: the velocities V of
// a step solve an equation, and
//   x_n+1 = x_n + dt V.
// It moves the particles from the origin of a step and back, and keeps the list of neighbours, which must
// hold half a step ahead. midpoint.h and, with noise, noisy_midpoint.h find V.
//
// After divide_steps() a step, or a half of one, is made again as two halves in three cases: spheres would
// move too far, V is not found, or the rate of the flow jumps. After a jump springs relax at once. The
// division depends on the step alone: a resumed run divides the same steps. Halves share the noise of their
// step (normal_block.h).
#pragma once

#include <memory>
#include <optional>

#include "engine/integrators/velocity_solver.h"

namespace peclet::engine {

class Implicit : public Integrator {
 public:
  Intervals intervals() const final;
  StepReport advance_open(System& system) final;
  void complete(System& /*system*/) final {}
  double stability_share(const System& /*system*/) const final { return 0; }
  std::optional<double> spurious_energy(const System& /*system*/) const final { return std::nullopt; }
  HalfSteps compare_half_steps(const System& system, int steps) const final;

  // Allows steps to be divided from now on, into parts of at least 2^-deepest_division: a particle may move
  // no farther than `longest_way` relative to the flow [length] in a part.
  void divide_steps(double longest_way);
  double longest_way() const { return longest_way_; }
  static constexpr int deepest_division = 10;

 protected:
  // The forces have no noise. `part` is the part of the resistance that they have. `drag_share` is the share
  // of the drag in the equations for V.
  Implicit(const Physics& physics, const ParticleState& particles, double timestep, double tolerance,
           std::uint64_t seed, int threads, InstructionSet set, double drag_share = 1,
           StepResistance::Part part = StepResistance::Part::whole);

  // Finds the velocities. Returns nothing if the list of pairs does not hold half a step ahead.
  virtual std::optional<StepReport> find_velocities(System& system) = 0;
  // Shows the pairs of the step to the watcher, with the system in the middle of the step.
  virtual void show_step(const System& system);
  // Stores the change of the velocities in this step, as a guess for the next one.
  virtual void keep_change(const System& /*system*/) {}
  // Discards the stored change.
  virtual void forget_change() {}

  void restore_springs(System& system) const;
  // Moves particles half a step from the origin at the present velocities. Returns true if the list holds.
  bool move_half_a_step(System& system);

  VelocitySolver solver_;
  StepOrigin origin_;  // after the velocities have gained what the flow gains in half a step
  Loads loads_;

 private:
  StepReport advance_part(System& system);
  StepReport advance_halves(System& system);
  bool is_to_be_divided(const StepReport& report) const;
  bool meets_a_jump(const System& system) const;
  void follow_list(System& system, double way);
  std::unique_ptr<Implicit> with_timestep(double timestep, const ParticleState& particles) const;
  void return_to_origin(System& system);
  void move(System& system, double time);
  double displacement(const System& system) const;

  Physics physics_;
  std::uint64_t seed_;
  InstructionSet set_;
  double longest_way_ = 0;
  int divisions_left_ = 0;
  std::unique_ptr<Implicit> half_;  // makes the halves of a step; has no state between steps
};

// Returns the implicit method of these physics, with noise if the temperature is above 0. `tolerance` bounds
// the residual of the equations over the motion relative to the flow, in the energy norm.
std::unique_ptr<Implicit> implicit_steps(const Physics& physics, const ParticleState& particles,
                                         double timestep, double tolerance, std::uint64_t seed, int threads,
                                         InstructionSet set = chosen_instruction_set());

}  // namespace peclet::engine
