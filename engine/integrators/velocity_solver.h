// VelocitySolver solves the equations of an implicit step at given forces, M (V - V_n) = dt F, by corrections
// of V. It couples near pairs ("links") and uses conjugate gradients with an incomplete factorisation.
//
// The matrix is symmetric and positive definite. Sliding friction enters with its secant stiffness, the
// resistance with its change by the approach (terms/step_resistance.h).
#pragma once

#include "engine/integrators/integrator.h"
#include "engine/kernels/force_field.h"

namespace peclet::engine {

struct Loads {
  Loads() = default;
  Loads(std::size_t particles, int threads) : force(particles, threads), torque(particles, threads) {}

  VectorField force, torque;
};

class VelocitySolver {
 public:
  // `tolerance` bounds the residual, relative to the motion. The matrix has the share `drag_share` of the
  // drag; the caller adds the rest to the loads.
  VelocitySolver(const Physics& physics, const ParticleState& particles, double timestep, double tolerance,
                 int threads, InstructionSet set, double drag_share = 1);

  double tolerance() const { return tolerance_; }

  // Assembles the matrix at the positions and velocities of the system, whose springs must be those of the
  // origin. Sets `loads` to the loads of the field there, unless it is null; requires
  // field.leaves_loads_with_links() for that.
  void assemble(System& system, ForceField& field, Loads* loads = nullptr);

  // Returns the factors of resistances and stiffnesses in the matrix.
  LinkWeights weights() const { return {.timestep = timestep_, .normal_time = 0.5 * timestep_}; }

  struct Residual {
    double squared;         // r.C^-1 r with the preconditioner C, nearly r.A^-1 r
    double squared_motion;  // v.A v of the part of the motion that a step changes
  };
  // Computes the residual of M (V - V_n) = dt (loads + noise) and keeps it for correct(). `noise` may be
  // null. The motion is relative to the flow.
  Residual set_residual(const System& system, const StepOrigin& origin, const Loads& loads,
                        const Loads* noise);

  // Corrects the velocities until the squared residual is at most `target`, and adds iterations and residual
  // to the report. Returns true if the result is finite.
  [[nodiscard]] bool correct(System& system, double target, StepReport& report);

  // Returns the assembled matrix.
  LinkSystem links(const System& system);

 private:
  SolverRows rows();

  double timestep_, tolerance_;
  int threads_;
  LinkKernels link_;
  std::vector<OneBodyFactors> inertia_;  // mass and moment of inertia, by size class
  std::vector<MotionRow> diagonal_;
  LinkOrder order_;
  std::optional<std::uint64_t> ordered_;  // the number of list builds when the order was made
  std::vector<LinkGroup> groups_;
  std::vector<Pivot> pivots_;
  std::vector<MotionRow> solution_, residual_, weighted_, direction_, ahead_, moved_, loads_;
  std::vector<MotionRow> aside_;
  std::vector<LinkSums> sums_;
  std::optional<double> begun_;  // result of begin() for the present matrix and residual
  ImposedFlow flow_;
  VectorField varying_velocity_, varying_spin_;  // have a row for each particle if the flow varies
};

}  // namespace peclet::engine
