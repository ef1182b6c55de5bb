// Systems of spheres at rest, and their integrators.
#pragma once

#include <memory>

#include "engine/integrators/implicit.h"
#include "engine/integrators/velocity_verlet.h"

namespace peclet::engine {

// Returns spheres at rest at the origin, in a box sheared by the flow, with an unbuilt list of the ranges of
// the forces.
inline System spheres_in(const Vector3& lengths, const Physics& physics, const std::vector<double>& radius,
                         double density = 0.1) {
  System system;
  system.particles = make_particles(radius, density);
  system.box = PeriodicCell(lengths, physics.flow.deformation().velocity_gradient(0));
  const std::vector<double> sizes = distinct_radii(radius);
  system.list = NeighbourList(range_table(make_pair_kinds(physics, sizes), sizes.size()), 0.1);
  return system;
}

inline VelocityVerlet explicit_steps(const Physics& physics, const System& system, double timestep,
                                     std::uint64_t of_seed = 1) {
  return {ForceField(physics, system.particles, timestep, of_seed, 1), system.particles, timestep};
}

inline std::unique_ptr<Integrator> steps_of_method(bool implicit, const Physics& physics,
                                                   const System& system, double timestep, double tolerance,
                                                   std::uint64_t of_seed = 1) {
  if (implicit) return implicit_steps(physics, system.particles, timestep, tolerance, of_seed, 1);
  return std::make_unique<VelocityVerlet>(explicit_steps(physics, system, timestep, of_seed));
}

inline void start_and_advance(Integrator& integrator, System& system, int steps) {
  integrator.start(system);
  for (int step = 0; step < steps; ++step) integrator.advance(system);
}

}  // namespace peclet::engine
