// Makes random initial packings without overlap.
#pragma once

#include <functional>
#include <stdexcept>

#include "engine/scene/scene.h"
#include "engine/state/particles.h"
#include "engine/state/system.h"

namespace peclet::engine {

// No packing without overlap was found at the wanted volume fraction.
class PackingError : public std::runtime_error {
 public:
  PackingError(double wanted, double reached);
  double reached() const { return reached_; }  // largest volume fraction without overlap that was found

 private:
  double reached_;
};

// Returns the radii of all spheres, species by species.
std::vector<double> species_radii(const Particles& particles);
// Returns the densities of all spheres, species by species.
std::vector<double> species_densities(const Particles& particles);

// Returns the edge of the cube in which these spheres have this volume fraction.
double cube_edge(const std::vector<double>& radius, double volume_fraction);
// Returns the same edge, equal to the last bit, without a list of all radii.
double cube_edge(const Particles& particles, double volume_fraction);

// Returns the largest overlap of two spheres over the smaller radius; 0 if none overlap.
double largest_overlap(const ParticleState& particles, const PeriodicCell& box);

// Places the spheres at random (keyed by seed) in the box at rest, then removes overlaps by minimising
//
//   sum over pairs with r < sigma_ij of 1/2 (sigma_ij - r)^2,    sigma_ij = 1.001 (a_i + a_j)
//
// with FIRE (Bitzek et al., PRL 97, 170201, 2006), r the distance of the centres. Surfaces are then apart by
// at least 2e-4 (a_i + a_j). For radii 1:1.4 in equal volumes this reaches a volume fraction of 0.63 (0.64
// with two seeds in five). Velocities are zero afterwards. Throws PackingError if overlaps remain,
// std::invalid_argument if a sphere overlaps its own image. Calls `made_step` after every iteration.
void place_randomly(
    ParticleState& particles, const PeriodicCell& box, std::uint64_t seed,
    const std::function<void()>& made_step = [] {});

// Relaxes a packing by repulsion and contacts, without flow, noise and friction. Ends when an automatic
// implicit step moves each sphere by at most 0.05 of the smallest radius, or after 200 steps. A step with a
// larger displacement is undone and made a quarter as long; after a good step the next one is twice as long.
// Relaxation is the same for both methods of integration, so that a seed gives one packing. Changes
// positions, the order of the particles in memory and the neighbour list; the step counter and the clock are
// zero afterwards. Calls `made_step` after every step.
void relax(
    System& system, const Scene& scene, int threads, const std::function<void()>& made_step = [] {});

}  // namespace peclet::engine
