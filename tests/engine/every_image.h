// Finds all pairs in all images by brute force, the reference for lists and kernels.
#pragma once

#include <functional>
#include <vector>

#include "engine/state/system.h"

namespace peclet::engine {

struct SeenPair {
  std::uint32_t first, second;  // first < second
  LatticeShift image;           // added to the given position of `second`
  Vector3 separation;

  friend bool operator==(const SeenPair& a, const SeenPair& b) {
    return a.first == b.first && a.second == b.second && a.image == b.image;
  }
};

// Returns every pair and image closer than range(first, second), sorted by (first, second, image). The
// lattice is (Lx, 0, 0), (tilt, Ly, 0), (0, 0, Lz), computed here.
std::vector<SeenPair> every_image(const VectorField& position, const Vector3& lengths, double tilt,
                                  const std::function<double(std::uint32_t, std::uint32_t)>& range);

// Returns the number of pairs nearer than `factor` times the sum of their radii.
std::size_t count_near(const System& system, double factor);

}  // namespace peclet::engine
