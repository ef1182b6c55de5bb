#include "engine/kernels/force_field.h"

#include "engine/state/for_each_range.h"
#include "engine/terms/drag.h"

namespace peclet::engine {

ForceField::ForceField(const Physics& physics, const ParticleState& particles, double timestep,
                       std::uint64_t seed, int threads, InstructionSet set)
    : physics_(physics),
      terms_(required_terms(physics)),
      kinds_(make_pair_kinds(physics, distinct_radii(particles.radius))),
      pair_pass_(terms_, set),
      parameters_(pair_parameters(physics, timestep)),
      pair_noise_(seed, Purpose::pair_noise),
      one_body_noise_(seed, Purpose::one_body_noise),
      fill_normals_(engine::fill_normals(set)),
      threads_(threads) {
  for (const double radius : distinct_radii(particles.radius)) {
    const double zeta = translational_drag(physics.viscosity, radius);
    const double zeta_r = rotational_drag(physics.viscosity, radius);
    drag_.push_back({zeta, zeta_r, drag_noise_amplitude(parameters_.noise_amplitude, zeta),
                     drag_noise_amplitude(parameters_.noise_amplitude, zeta_r)});
  }
}

PairSums ForceField::evaluate(System& system, VectorField& force, VectorField& torque) {
  const PairPassInput input = {
      .particles = system.particles,
      .list = system.list,
      .box = system.box,
      .kinds = kinds_,
      .parameters = parameters_,
      .noise = pair_noise_.key(system.step),
      .threads = threads_,
  };
  const PairSums sums = pair_pass_.evaluate(input, system.springs, force, torque);
  for_each_range(system.particles.count(), threads_, [&](std::size_t begin, std::size_t end) {
    add_drag(system.particles, begin, end, force, torque);
    if (physics_.thermal_energy > 0) {
      add_drag_noise(system, begin, end, force, torque);
    }
  });
  return sums;
}

void ForceField::add_drag(const ParticleState& particles, std::size_t begin, std::size_t end,
                          VectorField& force, VectorField& torque) const {
  const double rate = physics_.shear_rate;
  const Vector3 w = streaming_spin(rate);
  const Row spin = {w.x, w.y, w.z, 0};
  for (std::size_t i = begin; i < end; ++i) {
    const DragOfClass& drag = drag_[particles.size_class[i]];
    const Row streaming = {rate * particles.position.row(i)[1], 0, 0, 0};
    force.row(i) += drag.translational * (streaming - particles.velocity.row(i));
    torque.row(i) += drag.rotational * (spin - particles.angular_velocity.row(i));
  }
}

void ForceField::add_drag_noise(const System& system, std::size_t begin, std::size_t end, VectorField& force,
                                VectorField& torque) const {
  const NoiseKey key = one_body_noise_.key(system.step);
  std::uint64_t identity[identities_per_block] = {};
  NormalBlock normals;
  for (std::size_t first = begin; first < end; first += identities_per_block) {
    const std::size_t count = std::min<std::size_t>(identities_per_block, end - first);
    for (std::size_t k = 0; k < count; ++k) {
      identity[k] = system.particles.id[first + k];
    }
    fill_normals_(key, identity, nullptr, normals);
    for (std::size_t k = 0; k < count; ++k) {
      const auto normal = [&](int c) { return static_cast<double>(normals.value[c][k]); };
      const DragOfClass& drag = drag_[system.particles.size_class[first + k]];
      force.add(first + k, drag.force_noise * Vector3{normal(0), normal(1), normal(2)});
      torque.add(first + k, drag.torque_noise * Vector3{normal(3), normal(4), normal(5)});
    }
  }
}

}  // namespace peclet::engine
