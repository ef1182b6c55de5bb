#include "engine/integrators/acted_flux.h"

#include "engine/state/field_array.h"
#include "engine/terms/drag.h"

namespace peclet::engine {
namespace {

SymmetricTensor whole(const PairSums& sums) {
  SymmetricTensor sum;
  for (const SymmetricTensor& part : sums.stress) sum += part;
  return sum;
}

// What forces of pairs add to sum sym(r F_i) where all particles stand elsewhere, by a time at velocities of
// which `velocity(i)` is one.
template <class Velocity>
SymmetricTensor flux_by_places(double time, const VectorField& force, Velocity&& velocity) {
  SymmetricTensor flux;
  for (std::size_t i = 0; i < force.size(); ++i) {
    flux += -time * symmetric_dyad(velocity(i), force[i]);
  }
  return flux;
}

}  // namespace

SymmetricTensor flux_by_motion(const System& system, const VectorField& mean_velocity) {
  const ParticleState& particles = system.particles;
  SymmetricTensor flux;
  for (std::size_t i = 0; i < particles.count(); ++i) {
    const Vector3 flow = system.box.velocity_gradient() * particles.position[i];
    flux += -particles.mass[i] * symmetric_dyad(particles.velocity[i] - flow, mean_velocity[i] - flow);
  }
  return flux;
}

void ActedFlux::begin(const System& system, const PairSums& drawn, const PairSums& counted,
                      const Loads& loads, const ForceField& field) {
  stress_ = whole(drawn) + -1.0 * whole(counted);
  const std::size_t count = system.particles.count();
  VectorField of_drag(count), torque(count);
  field.add_drag_noise(system, 0, count, of_drag, torque);
  force_at_beginning_ = loads.force;
  array(force_at_beginning_) -= array(of_drag);
}

void ActedFlux::predict(const System& system, const PairSums& ahead, const Loads& loads,
                        const Physics& physics) {
  const ParticleState& particles = system.particles;
  stress_ += whole(ahead);
  force_ahead_ = loads.force;
  for (std::size_t i = 0; i < particles.count(); ++i) {
    force_ahead_.add(i, translational_drag(physics.viscosity, particles.radius[i]) * particles.velocity[i]);
  }
  predicted_velocity_ = particles.velocity;
}

SymmetricTensor ActedFlux::end(const System& system, VelocitySolver& solver, double timestep) {
  const VectorField& velocity = system.particles.velocity;
  stress_ += solver.add_corrected_forces(system, force_ahead_);
  const auto peculiar = [&](std::size_t i) {
    return velocity[i] - system.box.velocity_gradient() * system.particles.position[i];
  };
  stress_ += flux_by_places(0.5 * timestep, force_at_beginning_, peculiar);
  stress_ += flux_by_places(0.5 * timestep, force_ahead_,
                            [&](std::size_t i) { return velocity[i] - predicted_velocity_[i]; });
  return stress_;
}

}  // namespace peclet::engine
