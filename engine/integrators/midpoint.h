// Midpoint is the implicit midpoint rule, without noise:
//   x' = x_n + dt/2 V,   M (V - V_n) = dt F(x', V),   x_n+1 = x_n + dt V.
// The resistance of a pair is averaged over the gaps between x_n and x_n+1 (terms/step_resistance.h). Springs
// of friction push after 0.6 of their advance in the step; Coulomb's law cuts them there and at the end.
//
// Newton's iterations start from V_n plus the last change. They end when the residual, over the motion
// relative to the flow and in the energy norm, is below the tolerance, or after six; with friction after
// three, or eight if the residual is large. The stress is that of V at x_n + dt/2 V, with the averaged
// resistance.
#pragma once

#include "engine/integrators/implicit.h"

namespace peclet::engine {

class Midpoint final : public Implicit {
 public:
  Midpoint(const Physics& physics, const ParticleState& particles, double timestep, double tolerance,
           std::uint64_t seed, int threads, InstructionSet set = chosen_instruction_set());

  // The share s of a step's advance after which springs push. Half is of second order. A little more damps
  // stiff springs that stick: with z = dt k / R a step multiplies them by (1 - (1 - s) z) / (1 + s z), which
  // tends to -(1 - s) / s. The error of first order is a fifth of that of s = 1.
  static constexpr double felt_share = 0.6;

  void mark(const System& system) override;
  void return_to_mark(System& system) override;
  void save(ArchiveWriter& archive) const override;
  void load(ArchiveReader& archive) override;

 private:
  std::optional<StepReport> find_velocities(System& system) override;
  SymmetricTensor stress_of_motion(const System& system) const;
  void keep_change(const System& system) override;
  void forget_change() override;

  VectorField velocity_change_, spin_change_;  // changes in the last step, by particle id
  VectorField marked_velocity_change_, marked_spin_change_;
};

}  // namespace peclet::engine
