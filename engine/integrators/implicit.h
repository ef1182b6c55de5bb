// Steps that are not bound by the rate of lubrication: their velocities V solve an equation, and
//   x_n+1 = x_n + dt V.
// What such methods share: the way from the origin of a step and back to it, and the list of neighbours,
// which must hold half a step ahead. How V is found is in midpoint.h and, with noise, in noisy_midpoint.h.
//
// A step in which spheres would leap, or whose velocities are not found, is made again as two of half the
// size, and these likewise, once divide_steps() has allowed it; so is a step in which the rate of the flow
// jumps, after which springs let go at once. What divides a step lies in it alone: a run
// that is resumed between steps divides the same ones. Halves share the noise of their step (normal_block.h).
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

  // From now on steps are divided, into parts of 2^-deepest_division of them at the least, in which a
  // particle would move farther than this relative to the flow. Before, none is.
  void divide_steps(double longest_way);
  static constexpr int deepest_division = 10;

 protected:
  // The forces are without noise, at the distances as they are, with that part of the resistance.
  Implicit(const Physics& physics, const ParticleState& particles, double timestep, double tolerance,
           std::uint64_t seed, int threads, InstructionSet set, double drag_share = 1,
           StepResistance::Part part = StepResistance::Part::whole);

  // Finds the velocities; nothing where the list of pairs does not hold half a step ahead.
  virtual std::optional<StepReport> find_velocities(System& system) = 0;
  // Shows the watcher the pairs of the step, in its middle.
  virtual void show_step(const System& system);
  // Before the particles move with the velocities that have been found.
  virtual void keep_change(const System& /*system*/) {}
  // What was kept says nothing of the next step.
  virtual void forget_change() {}

  void restore_springs(System& system) const;
  // To where the present velocities lead. Returns whether the list holds there.
  bool move_half_a_step(System& system);

  VelocitySolver solver_;
  StepOrigin origin_;  // once velocities have gained what the flow gains in half a step
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
  std::unique_ptr<Implicit> half_;  // makes the halves of a step; nothing in it outlives a step
};

// Implicit steps, with noise where there is a temperature. `tolerance`: residual of the equations, relative
// to the motion relative to the flow, in the energy norm.
std::unique_ptr<Implicit> implicit_steps(const Physics& physics, const ParticleState& particles,
                                         double timestep, double tolerance, std::uint64_t seed, int threads,
                                         InstructionSet set = chosen_instruction_set());

}  // namespace peclet::engine
