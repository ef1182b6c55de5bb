// Steps that are not bound by the rate of lubrication: their velocities solve an equation.
//
// Without noise, the implicit midpoint rule:
//   x' = x_n + dt/2 V,   M (V - V_n) = dt F(x', V),   x_n+1 = x_n + dt V.
// Springs of friction are those that V has stretched for the whole step and Coulomb's law has cut. Newton's
// iterations start from the velocities that the last change would lead to. Each solves a symmetric positive
// definite system by conjugate gradients: friction that slides enters with its secant stiffness, the
// resistance with what the approach changes of its squeezing part. They go on until the residual, relative to
// the motion relative to the streaming flow and in the energy norm of the system, is below `tolerance`, or
// for three iterations: where pairs enter or leave the range of lubrication, whose resistance jumps there,
// the equations may have no solution at all.
//
// With noise, two systems (Fixman 1978), because the noise belongs to the resistance R(x_n) while the
// displacement must feel how R changes on the way:
//   M (V' - V_n) = dt [F(x_n, V') + F_B],   x' = x_n + dt/2 V',
//   M (V - V_n) = dt [F(x', V) + F_B],      x_n+1 = x_n + dt V
// with contact and repulsion at the distance that the velocities lead to in half a step. One iteration of
// each, no more: with x' from V itself the spheres would gather where R is large.
//
// The stress is that of V at x_n + dt/2 V; of the noise, at x_n.
#pragma once

#include <optional>

#include "engine/integrators/integrator.h"
#include "engine/kernels/force_field.h"

namespace peclet::engine {

class Implicit final : public Integrator {
 public:
  Implicit(const Physics& physics, const ParticleState& particles, double timestep, double tolerance,
           std::uint64_t seed, int threads, InstructionSet set = chosen_instruction_set());

  double timestep() const override { return timestep_; }
  Intervals intervals() const override;
  void start(System& system) override;
  StepReport advance_open(System& system) override;
  void complete(System& /*system*/) override {}
  double stability_share(const System& /*system*/) const override { return 0; }
  std::optional<double> spurious_energy(const System& /*system*/) const override { return std::nullopt; }
  HalfSteps compare_half_steps(const System& system, int steps) const override;
  void save(ArchiveWriter& archive) const override;
  void load(const System& system, ArchiveReader& archive) override;

 private:
  // What a step starts from.
  struct Origin {
    VectorField position, velocity, spin;
    SpringField springs;
  };
  struct Residual {
    double squared;         // r.C r with the inverse C of the particles' own blocks
    double squared_motion;  // of what a step changes, in the same norm
  };

  // Finds the velocities; nothing where the list of pairs does not hold half a step ahead.
  std::optional<StepReport> find_velocities(System& system);
  std::optional<StepReport> find_noisy_velocities(System& system);

  void remember(const System& system);
  void restart(System& system);
  void restore_springs(System& system) const;
  bool move_half_a_step(System& system);
  void move(System& system, double time);
  double displacement(const System& system) const;

  void assemble(System& system, ForceField& field);
  Residual set_residual(const System& system, bool with_noise);
  [[nodiscard]] bool correct(System& system, double target, StepReport& report);
  LinkSystem links(const System& system) const;

  Physics physics_;
  double timestep_, tolerance_;
  ForceField field_;  // without noise, at the distances as they are
  struct NoisyFields {
    ForceField with, without;  // contact and repulsion half a step ahead
  };
  std::optional<NoisyFields> noisy_;

  LinkKernels link_;
  std::vector<OneBodyFactors> inertia_;  // of each size class
  std::vector<MotionRow> diagonal_;
  std::vector<LinkGroup> groups_;
  std::size_t count_of_groups_ = 0;
  std::vector<MotionRow> inverse_blocks_, scratch_, solution_, residual_, direction_, product_;

  Origin origin_;
  VectorField force_, torque_, noise_force_, noise_torque_;
  VectorField velocity_change_, spin_change_;  // of the last step, for each id; without noise
  double displacement_bound_ = 0;              // of all particles since the list was built
};

}  // namespace peclet::engine
