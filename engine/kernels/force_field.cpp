#include "engine/kernels/force_field.h"

#include "engine/kernels/for_each_range.h"
#include "engine/terms/drag.h"

namespace peclet::engine {

ForceField::ForceField(const Physics& physics, const ParticleState& particles, double timestep,
                       std::uint64_t seed, int threads)
    : physics_(physics),
      terms_(required_terms(physics)),
      kinds_(make_pair_kinds(physics, distinct_radii(particles.radius))),
      pair_pass_(engine::pair_pass(terms_)),
      parameters_(pair_parameters(physics, timestep)),
      pair_noise_(seed, Purpose::pair_noise),
      one_body_noise_(seed, Purpose::one_body_noise),
      threads_(threads) {
  for (const double radius : particles.radius) {
    drag_.push_back(translational_drag(physics.viscosity, radius));
    rotational_drag_.push_back(engine::rotational_drag(physics.viscosity, radius));
  }
}

PairSums ForceField::evaluate(System& system, VectorField& force, VectorField& torque) {
  const PairPassInput input = {system.particles, system.list, system.box,  kinds_,
                               parameters_,      pair_noise_, system.step, threads_};
  const PairSums sums = pair_pass_(input, work_, system.springs, force, torque);
  add_one_body(system, force, torque);
  return sums;
}

void ForceField::add_one_body(const System& system, VectorField& force, VectorField& torque) const {
  const ParticleState& particles = system.particles;
  const double rate = physics_.shear_rate;
  const bool noisy = physics_.thermal_energy > 0;
  for_each_range(particles.count(), threads_, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Vector3 streaming = streaming_velocity(rate, particles.position.y[i]);
      Vector3 f = drag_force(drag_[i], streaming, particles.velocity[i]);
      Vector3 t = drag_force(rotational_drag_[i], streaming_spin(rate), particles.angular_velocity[i]);
      if (noisy) {
        const NormalPair normals = one_body_noise_.normals(system.step, static_cast<std::uint32_t>(i));
        f += drag_noise(parameters_.noise_amplitude, drag_[i], normals.first);
        t += drag_noise(parameters_.noise_amplitude, rotational_drag_[i], normals.second);
      }
      force.set(i, force[i] + f);
      torque.set(i, torque[i] + t);
    }
  });
}

}  // namespace peclet::engine
