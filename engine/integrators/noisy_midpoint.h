// NoisyMidpoint makes implicit steps with noise by solving two systems (Fixman 1978, J. Chem. Phys. 69,
// 1527):
//   M (V' - V_n) = dt [F(x_n, V') + F_B],   x' = x_n + dt/2 V',
//   M (V - V_n)  = dt [F(x', V) + F_B],     x_n+1 = x_n + dt V.
// The noise F_B belongs to the resistance R(x_n), while the displacement must feel how R changes on the way.
// Contact and repulsion are those at the distances half a step ahead. Each system is solved once: with x'
// from V itself the spheres would gather where R is large. V' need not be exact.
//
// A velocity that R damps as above has the variance kT / (m + dt R / 2), as if the mass were larger where R
// acts. At the outer gap R jumps, and the flux of pairs would make the density jump to 0.9 beyond it.
// Therefore the drag and the part of R that jumps, R_o, act on (V_n + V) / 2 at x_n in both systems. Inertia
// carries a pair half a step to x_n and half a step on. Between these free flights a velocity of variance kT
// / m turns into another one of that variance, whatever R_o is at x_n, and the density has no bias. The rest
// of R is continuous and acts as above, at the gaps of terms/step_resistance.h.
//
// Steps in which a thermal flight is as long as the range of lubrication, or in which velocities are
// forgotten, are too long for that (terms/lubrication.h). In these all of R acts as above.
//
// The stress is that of the forces that act (acted_stress.h).
#pragma once

#include "engine/integrators/acted_stress.h"
#include "engine/integrators/implicit.h"

namespace peclet::engine {

// Returns true if inertia carries all spheres across the outer gap in such a step.
bool carried_by_inertia(const Physics& physics, const ParticleState& particles, double timestep);

class NoisyMidpoint final : public Implicit {
 public:
  NoisyMidpoint(const Physics& physics, const ParticleState& particles, double timestep, double tolerance,
                std::uint64_t seed, int threads, InstructionSet set = chosen_instruction_set());

 private:
  NoisyMidpoint(const Physics& physics, const ParticleState& particles, double timestep, double tolerance,
                std::uint64_t seed, int threads, InstructionSet set, bool inertial);

  std::optional<StepReport> find_velocities(System& system) override;
  void show_step(const System& system) override;
  // Assembles the matrix of a system and sets the loads whose derivative it is. Returns their sums.
  PairSums assemble(System& system, ForceField& field, Loads& loads);
  void leave_half_of_the_drag(const System& system);
  SymmetricTensor motion(const System& system, std::size_t particle) const;
  // Solves a system to `factor` times the tolerance. Returns true if the result is finite.
  [[nodiscard]] bool solve(System& system, double factor, StepReport& report);

  ForceField with_noise_;    // the noise, and R_o / 2 if inertia carries the spheres
  ForceField at_beginning_;  // forces of the first system
  ForceField ahead_;         // forces of the second system
  Loads noise_;
  bool inertial_;
  ActedStress stress_;
};

}  // namespace peclet::engine
