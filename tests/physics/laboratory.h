// A suspension set up by hand, with any spheres at any places, stepped by the engine's own integrators.
#pragma once

#include <memory>
#include <numbers>
#include <random>

#include "engine/integrators/implicit.h"
#include "engine/integrators/velocity_verlet.h"

namespace peclet::engine {

// Natural units: radius, mass and drag coefficient 6 pi eta a of a unit sphere are 1. The unit of time is the
// decay time of its velocity, and kT is its diffusion coefficient.
constexpr double natural_viscosity = 1 / (6 * std::numbers::pi);
constexpr double natural_density = 3 / (4 * std::numbers::pi);
// I = 2/5 and the drag coefficient of rotation is 8 pi eta a^3 = 4/3, so spins decay faster.
constexpr double natural_spin_rate = 10.0 / 3.0;

struct Experiment {
  Physics physics;
  std::vector<double> radius;
  double density = natural_density;
  PeriodicCell box;
  double timestep = 0;
  std::uint64_t seed = 1;
  double skin = 0.1;                            // of the neighbour list [length]
  std::optional<double> solver_tolerance = {};  // of implicit steps; explicit steps if empty
};

class Laboratory {
 public:
  // Places spheres at rest at the origin; move them, then call start().
  explicit Laboratory(const Experiment& experiment);

  // Adds equilibrium velocities and spins, drawn from `generator` and not from the engine's.
  void thermalise(std::mt19937_64& generator);

  void start() { integrator_->start(system_); }
  StepReport step() { return integrator_->advance(system_); }

  System& system() { return system_; }
  const System& system() const { return system_; }
  ParticleState& particles() { return system_.particles; }
  const Physics& physics() const { return physics_; }
  double timestep() const { return integrator_->timestep(); }

  // Returns the position of a particle without periodic wrapping.
  Vector3 unwrapped(std::size_t i) const {
    return system_.particles.position[i] + system_.box.displacement(system_.particles.image[i]);
  }

 private:
  Physics physics_;
  System system_;
  std::unique_ptr<Integrator> integrator_;
};

// Returns the edge of the experiment's cube at this volume fraction, and sets its box, sheared by the flow.
double set_cube(Experiment& experiment, double volume_fraction, double tilt_over_edge = 0);

// Returns the experiment with spheres packed by the seed, moving with the flow.
Laboratory flowing_suspension(const Experiment& experiment, std::uint64_t packing_seed);

// Returns the same with thermal velocities of the seed; the fluid is at rest.
Laboratory thermal_suspension(const Experiment& experiment, std::uint64_t packing_seed,
                              std::uint64_t thermal_seed);

// Returns spheres of radius 1 at volume fraction 5e-4 with thermal velocities, drag and its noise alone.
Laboratory single_spheres(std::size_t count, double thermal_energy, double timestep, double skin,
                          std::optional<double> solver_tolerance = {});

// Returns the unwrapped position of every particle, by id; particles change their index in memory.
std::vector<Vector3> unwrapped_places(const Laboratory& laboratory);

// Calls claim(i, j, r, shift) for every pair and image nearer than range(i, j), without the engine's list.
// `shift` is the displacement of j's image.
template <class Range, class Claim>
void for_every_image(const System& system, const Range& range, const Claim& claim) {
  const VectorField& place = system.particles.position;
  for (std::size_t i = 0; i < place.size(); ++i) {
    for (std::size_t j = i + 1; j < place.size(); ++j) {
      for (int image = 0; image < 125; ++image) {
        const Vector3 shift =
            system.box.edges() * Vector3{image % 5 - 2.0, image / 5 % 5 - 2.0, image / 25 - 2.0};
        const Vector3 r = place[j] - place[i] + shift;
        if (!(norm(r) > range(i, j))) claim(i, j, r, shift);  // also a separation that is not a number
      }
    }
  }
}

}  // namespace peclet::engine
