// A suspension put together by hand: any spheres at any places, stepped by the engine's own integrator.
#pragma once

#include <memory>
#include <numbers>
#include <random>

#include "engine/integrators/implicit.h"
#include "engine/integrators/velocity_verlet.h"

namespace peclet::engine {

// Units of these tests unless said otherwise: radius, mass and drag coefficient 6 pi eta a of a unit sphere
// are
// 1. Then the time is that in which its velocity decays, and kT is its diffusion coefficient.
constexpr double natural_viscosity = 1 / (6 * std::numbers::pi);
constexpr double natural_density = 3 / (4 * std::numbers::pi);
// I = 2/5 and a drag coefficient of rotation 8 pi eta a^3 = 4/3: spins decay faster.
constexpr double natural_spin_rate = 10.0 / 3.0;

struct Experiment {
  Physics physics;
  std::vector<double> radius;
  double density = natural_density;
  PeriodicCell box;
  double timestep = 0;
  std::uint64_t seed = 1;
  double skin = 0.1;                            // of the neighbour list, a length
  std::optional<double> solver_tolerance = {};  // of implicit steps; none: explicit ones
};

class Laboratory {
 public:
  // Spheres at rest at the origin; place them, then start().
  explicit Laboratory(const Experiment& experiment);

  // Adds velocities and spins of equilibrium, from a generator that is not the engine's.
  void thermalise(std::mt19937_64& generator);

  void start() { integrator_->start(system_); }
  StepReport step() { return integrator_->advance(system_); }

  System& system() { return system_; }
  const System& system() const { return system_; }
  ParticleState& particles() { return system_.particles; }
  const Physics& physics() const { return physics_; }
  double timestep() const { return integrator_->timestep(); }

  // The place of a particle as if there were no periodic cell.
  Vector3 unwrapped(std::size_t i) const {
    return system_.particles.position[i] + system_.box.displacement(system_.particles.image[i]);
  }

 private:
  Physics physics_;
  System system_;
  std::unique_ptr<Integrator> integrator_;
};

// Spheres of radius 1 at a volume fraction of 5e-4 that feel drag and its noise alone, started from thermal
// velocities.
Laboratory single_spheres(std::size_t count, double thermal_energy, double timestep, double skin,
                          std::optional<double> solver_tolerance = {});

// Of every particle, by id: spheres change their places in memory.
std::vector<Vector3> unwrapped_places(const Laboratory& laboratory);

}  // namespace peclet::engine
