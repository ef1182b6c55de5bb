// Implicit steps with noise: two systems (Fixman 1978, J. Chem. Phys. 69, 1527), because the noise belongs to
// the resistance R(x_n) while the displacement must feel how R changes on the way:
//   M (V' - V_n) = dt [F(x_n, V') + F_B],   x' = x_n + dt/2 V',
//   M (V - V_n) = dt [F(x', V) + F_B],      x_n+1 = x_n + dt V
// with contact and repulsion at the distance that the velocities lead to in half a step. One iteration of
// each, no more: with x' from V itself the spheres would gather where R is large. V' need not be exact.
//
// A velocity that only decays, as with R V above, has the variance kT / (m + dt R / 2): as if the mass were
// larger where R is. Where R jumps, the flux of pairs then makes the density jump, to 0.9 beyond the outer
// gap. So the drag and what jumps there, R_o, act on (V_n + V) / 2 at x_n in both systems: inertia carries
// the pair half a step to x_n and half a step on, and between free flights a velocity of variance kT / m
// turns into another one of that variance, whatever R_o is at x_n; no density has a bias of it. The rest of
// R, which is continuous, is as above, at the gaps of terms/step_resistance.h. Steps too long for that, in
// which a thermal flight is as long as the range or velocities have forgotten all (terms/lubrication.h),
// are those above.
//
// The stress is that of the forces that act (acted_stress.h).
#pragma once

#include "engine/integrators/acted_stress.h"
#include "engine/integrators/implicit.h"

namespace peclet::engine {

class NoisyMidpoint final : public Implicit {
 public:
  NoisyMidpoint(const Physics& physics, const ParticleState& particles, double timestep, double tolerance,
                std::uint64_t seed, int threads, InstructionSet set = chosen_instruction_set());

 private:
  NoisyMidpoint(const Physics& physics, const ParticleState& particles, double timestep, double tolerance,
                std::uint64_t seed, int threads, InstructionSet set, bool inertial);

  std::optional<StepReport> find_velocities(System& system) override;
  void show_step(const System& system) override;
  // The matrix of a system of equations, and the loads that it is the derivative of; returns their sums.
  PairSums assemble(System& system, ForceField& field, Loads& loads);
  void leave_half_of_the_drag(const System& system);
  SymmetricTensor motion(const System& system, std::size_t particle) const;
  // Down to `factor` times the tolerance.
  [[nodiscard]] bool solve(System& system, double factor, StepReport& report);

  ForceField with_noise_;    // the noise, and R_o / 2
  ForceField at_beginning_;  // contact and repulsion half a step ahead
  ForceField ahead_;
  Loads noise_;
  bool inertial_;
  ActedStress stress_;
};

}  // namespace peclet::engine
