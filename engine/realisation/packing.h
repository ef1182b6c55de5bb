// Random initial packings without overlap.
#pragma once

#include <functional>
#include <stdexcept>

#include "engine/scene/scene.h"
#include "engine/state/particles.h"
#include "engine/state/system.h"

namespace peclet::engine {

// The spheres cannot be brought apart at this volume fraction.
class PackingError : public std::runtime_error {
 public:
  PackingError(double wanted, double reached);
  double reached() const { return reached_; }  // the densest packing that was found on the way

 private:
  double reached_;
};

// Radii of all spheres, species by species.
std::vector<double> species_radii(const Particles& particles);
// Their densities, in the same order.
std::vector<double> species_densities(const Particles& particles);

// Edge of the cube in which these spheres have this volume fraction.
double cube_edge(const std::vector<double>& radius, double volume_fraction);
// The same, to the last bit, without a list of all radii.
double cube_edge(const Particles& particles, double volume_fraction);

// Gives the spheres random places (keyed by seed) in the box at rest, then minimises the energy sum 1/2
// (sigma_ij - r)^2 of overlaps with FIRE (Bitzek et al. 2006), sigma_ij a thousandth above a_i + a_j, until
// no two spheres overlap: surfaces are then apart by at least 2e-4 of a_i + a_j. Reaches a volume fraction of
// 0.63 for 1:1.4 in equal volumes (0.64 from two seeds in five). Velocities are left at zero. Throws
// PackingError when the overlaps cannot be removed, std::invalid_argument when a sphere overlaps its own
// image. Calls `made_step` after every step of the minimisation.
void place_randomly(
    ParticleState& particles, const PeriodicCell& box, std::uint64_t seed,
    const std::function<void()>& made_step = [] {});

// Lets repulsion and contacts move the spheres, without flow, noise and friction, until an automatic implicit
// step moves none of them by more than a twentieth of the smallest radius. A step that moves one further is
// taken back and made a quarter as long; the step after a good one is twice as long. After two hundred steps
// the packing stays as far as it came. Both methods relax alike, so that a seed is one packing. Changes
// positions, the order of the particles in memory and the list; velocities are zero afterwards. Calls
// `made_step` after every step.
void relax(
    System& system, const Scene& scene, int threads, const std::function<void()>& made_step = [] {});

}  // namespace peclet::engine
