// VelocityVerlet makes explicit steps with half-step velocities, as published. It is the reference method.
//   U' = U + dt/2 a;  x += dt U';  springs advance with U';  a = F(x, U', fresh noise) / m;  U = U' + dt/2 a
// Angular velocities follow with the moment of inertia. The forces are those of the half-step
// velocities. Noise is drawn once a step and serves both halves. For x'' = -w^2 x - l x' the scheme is stable
// if and only if w^2 dt^2 + 2 l dt < 4. The variance of full-step velocities is kT/m at any stable step; that
// of half-step velocities is larger.
#pragma once

#include <utility>

#include "engine/integrators/integrator.h"
#include "engine/kernels/force_field.h"

namespace peclet::engine {

class VelocityVerlet final : public Integrator {
 public:
  VelocityVerlet(ForceField field, const ParticleState& particles, double timestep);

  Intervals intervals() const override;
  void start(System& system) override;
  StepReport advance_open(System& system) override;
  void complete(System& system) override;
  double stability_share(const System& system) const override;
  std::optional<double> spurious_energy(const System& system) const override;
  HalfSteps compare_half_steps(const System& system, int steps) const override;
  void mark(const System& system) override;
  void return_to_mark(System& system) override;
  void save(ArchiveWriter& archive) const override;
  void load(ArchiveReader& archive) override;

 private:
  SymmetricTensor motion(const System& system, std::size_t particle) const;
  void add_due(const System& system, const ParticleBlock& block);
  double move(System& system);
  std::pair<double, PairSums> move_and_evaluate(System& system);
  OneBodyInput kick_input(System& system);
  bool keep_list(System& system, double speed);

  std::vector<OneBodyFactors> kicks_;  // half a step over mass and moment of inertia, by size class
  VectorField force_, torque_;
  bool open_ = false;  // the second kick of the last step and its incoming forces are due
  VectorField marked_force_, marked_torque_;
};

}  // namespace peclet::engine
