// The equations of an implicit step at given forces, M (V - V_n) = dt F, and the correction of V that takes
// their residual away: couplings of near pairs ("links"), an incomplete factorisation, conjugate gradients.
//
// The matrix is symmetric and positive definite: friction that slides enters with its secant stiffness, the
// resistance with what the approach changes of it (terms/step_resistance.h).
#pragma once

#include "engine/integrators/integrator.h"
#include "engine/kernels/force_field.h"

namespace peclet::engine {

// Forces and torques on all particles.
struct Loads {
  Loads() = default;
  Loads(std::size_t particles, int threads) : force(particles, threads), torque(particles, threads) {}

  VectorField force, torque;
};

class VelocitySolver {
 public:
  // Velocities are found until the residual is below `tolerance`, relative to the motion. They feel that
  // share of the drag; the rest is the caller's.
  VelocitySolver(const Physics& physics, const ParticleState& particles, double timestep, double tolerance,
                 int threads, InstructionSet set, double drag_share = 1);

  double tolerance() const { return tolerance_; }

  // The matrix at the system's places and velocities, whose springs must be those of the origin. Unless
  // `loads` is null, it is set to the field's loads there, which the field must be able to leave.
  void assemble(System& system, ForceField& field, Loads* loads = nullptr);

  // By what the matrix counts resistances and stiffnesses.
  LinkWeights weights() const { return {.timestep = timestep_, .normal_time = 0.5 * timestep_}; }

  struct Residual {
    double squared;         // r.C^-1 r with the preconditioner C, nearly r.A^-1 r
    double squared_motion;  // v.A v of what a step changes
  };
  // Of M (V - V_n) = dt (loads + noise), kept for correct(). The motion is that relative to the flow.
  Residual set_residual(const System& system, const StepOrigin& origin, const Loads& loads,
                        const Loads* noise);

  // Adds to the velocities what takes the residual away, down to the squared residual `target`, and to the
  // report what it took. Returns whether the result is finite.
  [[nodiscard]] bool correct(System& system, double target, StepReport& report);

  // What has been assembled.
  LinkSystem links(const System& system);

 private:
  SolverRows rows();

  double timestep_, tolerance_;
  int threads_;
  LinkKernels link_;
  std::vector<OneBodyFactors> inertia_;  // of each size class
  std::vector<MotionRow> diagonal_;
  LinkOrder order_;
  std::optional<std::uint64_t> ordered_;  // the number of the list's builds when the order was made
  std::vector<LinkGroup> groups_;
  std::vector<Pivot> pivots_;
  std::vector<MotionRow> solution_, residual_, weighted_, direction_, ahead_, moved_, loads_;
  std::vector<MotionRow> aside_;
  std::vector<LinkSums> sums_;
  std::optional<double> begun_;  // what begin() has returned for the present matrix and right-hand side
  ImposedFlow flow_;
  VectorField varying_velocity_, varying_spin_;  // of each particle, where the flow varies
};

}  // namespace peclet::engine
