#include "engine/observables/structure.h"

#include <cmath>

#include "engine/flow/deformation.h"
#include "engine/terms/drag.h"

namespace peclet::engine {

std::vector<std::uint32_t> places_of_ids(const ParticleState& particles) {
  std::vector<std::uint32_t> place(particles.count());
  for (std::uint32_t i = 0; i < place.size(); ++i) place[particles.id[i]] = i;
  return place;
}

LatticeShift cells_from_origin(const CellFrame& cell, const Vector3& point) {
  const Vector3 place = cell.fractional(point);
  const auto whole = [](double x) { return static_cast<std::int32_t>(std::floor(x + 0.5)); };
  return {whole(place.x), whole(place.y), whole(place.z)};
}

SymmetricTensor structural_brownian_stress(const System& system, const std::vector<PairKind>& kinds,
                                           double thermal_energy) {
  SymmetricTensor sum;
  if (!(thermal_energy > 0)) return sum;
  const std::vector<ImageFrame> frames = image_frames(system.list, system.box);
  for (const Pair& pair : system.list.pairs()) {
    const PairKind& kind = kinds[pair.kind];
    const Vector3 r = separation(system.particles, pair, frames[pair.image]);
    const double squared = dot(r, r);
    const auto within = [&](double radius) {
      const double reach = kind.sum_of_radii + structural_shell * radius;
      return squared < reach * reach ? 1 : 0;
    };
    if (const int sides = within(kind.radius_first) + within(kind.radius_second); sides > 0) {
      sum += (sides / squared) * symmetric_dyad(r, r);
    }
  }
  return (-thermal_energy / (structural_shell * system.box.volume())) * sum;
}

KineticTemperatures kinetic_temperatures(const System& system, const ImposedFlow& imposed) {
  const ParticleState& particles = system.particles;
  const BackgroundFlow flow = imposed.at(system.box);
  double translational = 0, rotational = 0;
  for (std::size_t i = 0; i < particles.count(); ++i) {
    const Vector3 u = particles.velocity[i] - flow.velocity(particles.position[i], particles.radius[i]);
    const Vector3 w = particles.angular_velocity[i] - flow.spin(particles.position[i]);
    translational += particles.mass[i] * dot(u, u);
    rotational += particles.inertia[i] * dot(w, w);
  }
  const double degrees = 3 * static_cast<double>(particles.count());
  return {translational / degrees, rotational / degrees};
}

SymmetricTensor varying_stresslet(const ParticleState& particles, const PeriodicCell& box,
                                  const Physics& physics) {
  SymmetricTensor sum;
  if (!physics.flow.varies()) return sum;
  const BackgroundFlow flow = physics.flow.at(box);
  for (std::size_t i = 0; i < particles.count(); ++i) {
    const double a = particles.radius[i];
    sum += stresslet_of_sphere(physics.viscosity, a, flow.varying_strain(particles.position[i], a));
  }
  return (1 / box.volume()) * sum;
}

}  // namespace peclet::engine
