// Returns separation and relative velocity of listed pairs through the periodic cell.
#pragma once

#include <vector>

#include "engine/kernels/pair_kinds.h"
#include "engine/state/neighbour_list.h"

namespace peclet::engine {

// The displacement and velocity of an image, relative to the particle itself.
struct ImageFrame {
  Vector3 displacement, velocity;
};

// Returns the frame of each image that the list uses.
std::vector<ImageFrame> image_frames(const NeighbourList& list, const PeriodicCell& box);

// Returns r = x_j + image - x_i.
inline Vector3 separation(const ParticleState& particles, const Pair& pair, const ImageFrame& frame) {
  return particles.position[pair.second] - particles.position[pair.first] + frame.displacement;
}

// Returns U_j + velocity of the image - U_i.
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
