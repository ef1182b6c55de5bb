// Spheres at random places, their near pairs, and the pairs of a list.
#pragma once

#include <algorithm>
#include <tuple>
#include <vector>

#include "engine/state/neighbour_list.h"
#include "tests/engine/draws.h"
#include "tests/engine/every_image.h"

namespace peclet::engine {

constexpr double outer = 1.025;  // range over contact distance: lubrication gap 0.05

inline RangeTable ranges_of(const std::vector<double>& radius) {
  const std::vector<double> sizes = distinct_radii(radius);
  RangeTable ranges(sizes.size());
  for (std::size_t a = 0; a < sizes.size(); ++a) {
    for (std::size_t b = 0; b < sizes.size(); ++b) ranges.at(a, b) = outer * (sizes[a] + sizes[b]);
  }
  return ranges;
}

// Returns spheres of these sizes at random places, most outside the cell, with overlaps.
inline ParticleState scattered(std::size_t count, const std::vector<double>& sizes, const PeriodicCell& box,
                               Draws& draws) {
  std::vector<double> radius;
  for (std::size_t i = 0; i < count; ++i) radius.push_back(sizes[i % sizes.size()]);
  ParticleState particles = make_particles(radius, 1);
  for (std::size_t i = 0; i < count; ++i) {
    const LatticeShift shift = {draws.whole(-3, 3), draws.whole(-3, 3), draws.whole(-3, 3)};
    const Vector3& edge = box.lengths();
    const Vector3 place = {draws.uniform(0, edge.x), draws.uniform(0, edge.y), draws.uniform(0, edge.z)};
    particles.position.set(i, place + box.displacement(shift));
  }
  return particles;
}

// Returns a list built with this skin.
inline NeighbourList list_of(const ParticleState& particles, const PeriodicCell& box, double skin) {
  NeighbourList list(ranges_of(particles.radius), skin);
  list.build(particles, box);
  return list;
}

inline std::vector<SeenPair> near(const ParticleState& particles, const PeriodicCell& box, double factor) {
  return every_image(particles.position, box.lengths(), box.tilt(), [&](std::uint32_t i, std::uint32_t j) {
    return factor * (particles.radius[i] + particles.radius[j]);
  });
}

// Returns pairs nearer than outer (a_i + a_j) plus the skin: `skin` times the smallest range of all plus a
// tenth of the excess of the pair's range.
inline std::vector<SeenPair> near_with_skin(const ParticleState& particles, const PeriodicCell& box,
                                            double skin) {
  const double least = 2 * *std::min_element(particles.radius.begin(), particles.radius.end());
  return every_image(particles.position, box.lengths(), box.tilt(), [&](std::uint32_t i, std::uint32_t j) {
    const double sum = particles.radius[i] + particles.radius[j];
    return outer * (sum + skin * (0.9 * least + 0.1 * sum));
  });
}

inline bool by_name(const SeenPair& a, const SeenPair& b) {
  return std::tie(a.first, a.second, a.image) < std::tie(b.first, b.second, b.image);
}

inline std::vector<SeenPair> listed(const NeighbourList& list) {
  std::vector<SeenPair> pairs;
  for (const Pair& pair : list.pairs())
    pairs.push_back({pair.first, pair.second, list.images()[pair.image], {}});
  std::sort(pairs.begin(), pairs.end(), by_name);
  return pairs;
}

}  // namespace peclet::engine
