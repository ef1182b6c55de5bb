// separation() and relative_velocity(): how a pair of the list is seen through the periodic cell.
#pragma once

#include <vector>

#include "engine/kernels/pair_kinds.h"
#include "engine/state/neighbour_list.h"

namespace peclet::engine {

// Displacement and velocity of every image that the list uses, at one moment.
struct ImageFrame {
  Vector3 displacement, velocity;
};

std::vector<ImageFrame> image_frames(const NeighbourList& list, const PeriodicCell& box);

// r = x_j + image - x_i.
inline Vector3 separation(const ParticleState& particles, const Pair& pair, const ImageFrame& frame) {
  return particles.position[pair.second] - particles.position[pair.first] + frame.displacement;
}

// U_j + image's own velocity - U_i.
inline Vector3 relative_velocity(const ParticleState& particles, const Pair& pair, const ImageFrame& frame) {
  return particles.velocity[pair.second] - particles.velocity[pair.first] + frame.velocity;
}

inline PairGeometry geometry(const Vector3& separation, const PairKind& kind) {
  const double distance = norm(separation);
  return {separation, (1 / distance) * separation, distance, kind.sum_of_radii};
}

inline PairMotion motion(const ParticleState& particles, const Pair& pair, const ImageFrame& frame) {
  return {relative_velocity(particles, pair, frame), particles.angular_velocity[pair.first],
          particles.angular_velocity[pair.second]};
}

}  // namespace peclet::engine
