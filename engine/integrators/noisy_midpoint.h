// Implicit steps with noise: two systems (Fixman 1978, J. Chem. Phys. 69, 1527), because the noise belongs to
// the resistance R(x_n) while the displacement must feel how R changes on the way:
//   M (V' - V_n) = dt [F(x_n, V') + F_B],   x' = x_n + dt/2 V',
//   M (V - V_n) = dt [F(x', V) + F_B],      x_n+1 = x_n + dt V
// with contact and repulsion at the distance that the velocities lead to in half a step. One iteration of
// each, no more: with x' from V itself the spheres would gather where R is large.
//
// The stress is that of V at x_n + dt/2 V; of the noise, at x_n.
#pragma once

#include "engine/integrators/implicit.h"

namespace peclet::engine {

class NoisyMidpoint final : public Implicit {
 public:
  NoisyMidpoint(const Physics& physics, const ParticleState& particles, double timestep, double tolerance,
                std::uint64_t seed, int threads, InstructionSet set = chosen_instruction_set());

 private:
  std::optional<StepReport> find_velocities(System& system) override;
  [[nodiscard]] bool solve(System& system, const Loads* noise, StepReport& report);

  ForceField with_noise_, without_noise_;  // contact and repulsion half a step ahead
  Loads noise_;
};

}  // namespace peclet::engine
