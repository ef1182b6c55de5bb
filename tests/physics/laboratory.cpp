#include "tests/physics/laboratory.h"

#include "engine/realisation/packing.h"

namespace peclet::engine {
namespace {

System empty_system(const Experiment& experiment) {
  System system;
  system.particles = make_particles(experiment.radius, experiment.density);
  system.box = experiment.box;
  const std::vector<double> sizes = distinct_radii(experiment.radius);
  const RangeTable ranges = range_table(make_pair_kinds(experiment.physics, sizes), sizes.size());
  system.list = NeighbourList(ranges, experiment.skin / ranges.smallest());
  return system;
}

std::unique_ptr<Integrator> make_integrator(const Experiment& experiment, const ParticleState& particles) {
  if (experiment.solver_tolerance) {
    return implicit_steps(experiment.physics, particles, experiment.timestep, *experiment.solver_tolerance,
                          experiment.seed, /*threads=*/1);
  }
  return std::make_unique<VelocityVerlet>(
      ForceField(experiment.physics, particles, experiment.timestep, experiment.seed, /*threads=*/1),
      particles, experiment.timestep);
}

}  // namespace

Laboratory::Laboratory(const Experiment& experiment)
    : physics_(experiment.physics),
      system_(empty_system(experiment)),
      integrator_(make_integrator(experiment, system_.particles)) {}

void Laboratory::thermalise(std::mt19937_64& generator) {
  std::normal_distribution<double> normal;
  const auto vector = [&](double inertia) {
    const double scale = std::sqrt(physics_.thermal_energy / inertia);
    const double x = normal(generator), y = normal(generator), z = normal(generator);
    return scale * Vector3{x, y, z};
  };
  ParticleState& all = system_.particles;
  for (std::size_t i = 0; i < all.count(); ++i) {
    all.velocity.set(i, all.velocity[i] + vector(all.mass[i]));
    all.angular_velocity.set(i, all.angular_velocity[i] + vector(all.inertia[i]));
  }
}

double set_cube(Experiment& experiment, double volume_fraction, double tilt_over_edge) {
  const double edge = cube_edge(experiment.radius, volume_fraction);
  experiment.box = PeriodicCell(
      {edge, edge, edge}, experiment.physics.flow.deformation().velocity_gradient(0), tilt_over_edge * edge);
  return edge;
}

Laboratory flowing_suspension(const Experiment& experiment, std::uint64_t packing_seed) {
  Laboratory laboratory(experiment);
  ParticleState& all = laboratory.particles();
  place_randomly(all, experiment.box, packing_seed);
  const BackgroundFlow flow(experiment.box);
  for (std::size_t i = 0; i < all.count(); ++i) {
    all.velocity.set(i, flow.velocity(all.position[i]));
    all.angular_velocity.set(i, flow.spin(all.position[i]));
  }
  laboratory.start();
  return laboratory;
}

Laboratory thermal_suspension(const Experiment& experiment, std::uint64_t packing_seed,
                              std::uint64_t thermal_seed) {
  Laboratory laboratory(experiment);
  place_randomly(laboratory.particles(), experiment.box, packing_seed);
  std::mt19937_64 generator(thermal_seed);
  laboratory.thermalise(generator);
  laboratory.start();
  return laboratory;
}

Laboratory single_spheres(std::size_t count, double thermal_energy, double timestep, double skin,
                          std::optional<double> solver_tolerance) {
  Experiment experiment;
  experiment.physics.viscosity = natural_viscosity;
  experiment.physics.thermal_energy = thermal_energy;
  experiment.radius.assign(count, 1.0);
  set_cube(experiment, 5e-4);
  experiment.timestep = timestep;
  experiment.skin = skin;
  experiment.solver_tolerance = solver_tolerance;
  return thermal_suspension(experiment, 4, 21);
}

std::vector<Vector3> unwrapped_places(const Laboratory& laboratory) {
  const ParticleState& particles = laboratory.system().particles;
  std::vector<Vector3> places(particles.count());
  for (std::size_t i = 0; i < particles.count(); ++i) places[particles.id[i]] = laboratory.unwrapped(i);
  return places;
}

}  // namespace peclet::engine
