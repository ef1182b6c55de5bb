// The implicit midpoint rule, without noise:
//   x' = x_n + dt/2 V,   M (V - V_n) = dt F(x', V),   x_n+1 = x_n + dt V,
// with the resistance of a pair averaged over the gaps between x_n and x_n+1 (terms/step_resistance.h).
// Springs of friction push after 0.6 of the way that V stretches them in the step, and Coulomb's law cuts
// them there and at its end. Newton's iterations start from the velocities that the last change would lead
// to. They go on until the residual, relative to the motion relative to the streaming flow and in the energy
// norm of the system, is below the tolerance, or for six iterations; with friction for three, and for eight
// where the residual is large.
//
// The stress is that of V at x_n + dt/2 V, with the averaged resistance.
#pragma once

#include "engine/integrators/implicit.h"

namespace peclet::engine {

class Midpoint final : public Implicit {
 public:
  Midpoint(const Physics& physics, const ParticleState& particles, double timestep, double tolerance,
           std::uint64_t seed, int threads, InstructionSet set = chosen_instruction_set());

  void mark(const System& system) override;
  void return_to_mark(System& system) override;
  void save(ArchiveWriter& archive) const override;
  void load(ArchiveReader& archive) override;

 private:
  std::optional<StepReport> find_velocities(System& system) override;
  SymmetricTensor stress_of_motion(const System& system) const;
  void keep_change(const System& system) override;
  void forget_change() override;

  VectorField velocity_change_, spin_change_;  // of the last step, for each id
  VectorField marked_velocity_change_, marked_spin_change_;
};

}  // namespace peclet::engine
