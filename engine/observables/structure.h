// Finds near and touching pairs of a configuration, and computes stresses and temperatures that are sampled.
#pragma once

#include <cstdint>
#include <numeric>
#include <vector>

#include "engine/kernels/pair_access.h"
#include "engine/kernels/pair_kinds.h"
#include "engine/state/cell_grid.h"
#include "engine/state/system.h"
#include "engine/terms/spring_laws.h"

namespace peclet::engine {

// Calls visit(i, j, separation) for every sphere i and each image of another sphere j that is closer than
// `range`, and for some further away: every pair from both ends. `separation` leads from i to j. The order
// depends only on the configuration.
template <class Visit>
void for_each_near_pair(const System& system, double range, const Visit& visit) {
  const LatticePlaces places = lattice_places(system.particles.position, system.box);
  std::vector<std::uint32_t> everyone(system.particles.count());
  std::iota(everyone.begin(), everyone.end(), 0U);
  const CellGrid grid(places, everyone, system.box, range);
  for (std::uint32_t i = 0; i < everyone.size(); ++i) {
    grid.visit_near(places.fractional[i], range,
                    [&](std::uint32_t j, LatticeShift, const Vector3& separation) {
                      if (j != i) visit(i, j, separation);
                    });
  }
}

// Returns the place in memory of each id.
std::vector<std::uint32_t> places_of_ids(const ParticleState& particles);

// Returns the cells from the one around the origin, -1/2 <= fractional < 1/2, to the one of a point.
LatticeShift cells_from_origin(const CellFrame& cell, const Vector3& point);

// The mobilisation above which a contact slides: below 1, as a step changes the spring after it was cut.
constexpr double sliding_from = 0.99;

struct TouchingPair {
  const Pair& pair;
  double distance, overlap;  // centre distance; delta = a_i + a_j - distance > 0
  double tangential_force;   // |F_t| of spring and dashpot
  bool rough;                // true if it has friction: k_n delta is above the critical load
  double mobilised;          // |F_t| / (mu frictional_load()), 0 without friction
  bool slides;               // remembered by the contact, or mobilised > sliding_from
};

// Calls visit(TouchingPair) for each contact, in the order of the list.
template <class Visit>
void for_each_touching_pair(const System& system, const std::vector<PairKind>& kinds,
                            const ContactParameters& contact, const Visit& visit) {
  const std::vector<ImageFrame> frames = image_frames(system.list, system.box);
  const std::vector<Pair>& pairs = system.list.pairs();
  for (std::size_t p = 0; p < pairs.size(); ++p) {
    const Pair& pair = pairs[p];
    const ImageFrame& frame = frames[pair.image];
    const PairGeometry shape = geometry(separation(system.particles, pair, frame), kinds[pair.kind]);
    const double overlap = shape.overlap();
    if (!(overlap > 0)) continue;
    const double load = frictional_load(contact, overlap);
    const bool rough = contact.friction > 0 && load > 0;
    const bool remembers = system.springs.remembers_sliding();
    ContactSprings springs = system.springs[p];
    const ContactOf<double> touch = contact_of(contact, kinds[pair.kind], shape);
    double length = norm(springs.tangential);
    const Vector3 pushing = damped_spring<SlidingFriction>(
        touch, motion(system.particles, pair, frame),
        spring_limits<SlidingFriction>(touch, remembers, springs.slides), springs.tangential, length);
    const double force = rough ? contact.tangential_stiffness * norm(pushing) : 0;
    const double mobilised = rough ? force / (contact.friction * load) : 0;
    const bool slides = remembers ? rough && springs.slides != 0 : mobilised > sliding_from;
    visit({pair, shape.distance, overlap, force, rough, mobilised, slides});
  }
}

// Returns the structural Brownian stress (Li, Royer & Ness (2023) eqs. 25, 26), zero without temperature:
//   Sigma^B = -(kT / V) sum_i (a_i / Delta_i) sum_{j: h < Delta_i} n n,   Delta_i = 0.05 a_i
// Every pair counts from both sides, overlapping ones included.
SymmetricTensor structural_brownian_stress(const System& system, const std::vector<PairKind>& kinds,
                                           double thermal_energy);

// The means over particles of m |U - streaming flow|^2 / 3 and I |Omega - streaming spin|^2 / 3, each kT in
// equilibrium.
struct KineticTemperatures {
  double translational, rotational;
};

KineticTemperatures kinetic_temperatures(const System& system, const ImposedFlow& imposed);

// Returns what the non-uniform flow, of strain rate E', adds to the stresslets of isolated spheres over V:
//   (1 / V) sum of 20/3 pi eta a^3 (1 + a^2/10 lap) E'
SymmetricTensor varying_stresslet(const ParticleState& particles, const PeriodicCell& box,
                                  const Physics& physics);

}  // namespace peclet::engine
