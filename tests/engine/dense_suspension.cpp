#include "tests/engine/dense_suspension.h"

#include "engine/kernels/pair_access.h"
#include "engine/kernels/pair_pass.h"
#include "engine/realisation/packing.h"
#include "tests/engine/draws.h"

namespace peclet::engine {
namespace {

constexpr double shear_rate = 0.7;
constexpr double unused = ContactParameters{}.kinetic_friction;

void scatter(System& system, Draws& draws) {
  ParticleState& particles = system.particles;
  for (std::size_t i = 0; i < particles.count(); ++i) {
    const Vector3 place = particles.position[i] + draws.vector(0.02);
    particles.position.set(i, place);
    particles.velocity.set(i, Vector3{shear_rate * place.y, 0, 0} + draws.vector(0.5));
    particles.angular_velocity.set(i, Vector3{0, 0, -0.5 * shear_rate} + draws.vector(0.5));
    if (draws.whole(0, 2) == 0) {
      const LatticeShift shift = {draws.whole(-2, 2), draws.whole(-2, 2), draws.whole(-2, 2)};
      particles.position.set(i, place + system.box.displacement(shift));
      particles.velocity.add(i, system.box.velocity(shift));
    }
  }
}

void stretch_springs(System& system, const Physics& physics, Draws& draws) {
  const std::vector<ImageFrame> frames = image_frames(system.list, system.box);
  system.springs = SpringField(spring_kinds(required_terms(physics)), system.list.pairs().size());
  for (std::size_t p = 0; p < system.springs.size(); ++p) {
    const Pair& pair = system.list.pairs()[p];
    const Vector3 r = separation(system.particles, pair, frames[pair.image]);
    const double overlap =
        system.particles.radius[pair.first] + system.particles.radius[pair.second] - norm(r);
    if (overlap > 0 && physics.contact && physics.contact->friction > 0) {
      const Vector3 normal = (1 / norm(r)) * r;
      ContactSprings springs;
      springs.tangential = across(draws.vector(2 * overlap), normal);
      if (physics.contact->rolling_stiffness > 0) springs.rolling = across(draws.vector(5 * overlap), normal);
      if (remembers_sliding(*physics.contact)) springs.slides = draws.whole(0, 1);
      system.springs.set(p, springs);
    }
  }
}

}  // namespace

Physics physics_with(const Terms& terms) {
  Physics physics;
  physics.viscosity = 0.1;
  physics.flow = steady_shear(shear_rate);
  physics.thermal_energy = terms.noise ? 0.017 : 0;
  if (terms.contact) {
    physics.contact = ContactParameters{.normal_stiffness = 1e4,
                                        .normal_damping = terms.damping ? 1.3 : 0,
                                        .friction = terms.friction ? 0.5 : 0,
                                        .kinetic_friction = terms.kinetic ? 0.3 : unused,
                                        .tangential_stiffness = 2.0 / 7.0 * 1e4,
                                        .tangential_damping = terms.friction && terms.damping ? 0.9 : 0,
                                        .rolling_stiffness = terms.rolling ? 700.0 : 0,
                                        .rolling_friction = 0.2};
  }
  if (terms.lubrication) {
    physics.lubrication = LubricationParameters{.inner_gap = 1e-3, .outer_gap = 0.05};
    if (terms.strained) {
      physics.lubrication->form = LubricationParameters::Form::mari;
      physics.lubrication->outer_distance = 0.1;
    }
  }
  if (terms.conservative) {
    physics.repulsion = RepulsionParameters{.strength = 0.17, .relative_length = 0.01, .cutoff_lengths = 5};
  }
  return physics;
}

System dense_suspension(const Physics& physics, std::size_t count, std::uint64_t seed) {
  Draws draws(seed);
  std::vector<double> radius(count, 1.0);
  for (std::size_t i = 0; i < count; i += 4) radius[i] = 1.4;
  const double edge = cube_edge(radius, 0.52);
  System system;
  system.particles = make_particles(radius, 0.1);
  system.box = PeriodicCell({edge, edge, edge}, simple_shear(physics.flow.rate()), 0.31 * edge);
  place_randomly(system.particles, system.box, seed);
  scatter(system, draws);
  const std::vector<double> sizes = distinct_radii(radius);
  system.list = NeighbourList(range_table(make_pair_kinds(physics, sizes), sizes.size()), 0.05);
  system.list.build(system.particles, system.box);
  stretch_springs(system, physics, draws);
  return system;
}

Configuration configuration_of(const System& system, const Physics& physics) {
  Configuration configuration;
  configuration.physics = physics;
  configuration.particles = system.particles;
  configuration.box = system.box;
  ParticleState unwrapped = system.particles;
  unwrapped.image.assign(unwrapped.count(), {});
  configuration.particles = unwrapped;
  configuration.springs = held_contacts(system.list, unwrapped, system.springs);
  return configuration;
}

}  // namespace peclet::engine
