// All pairs in all images, the slow way: what lists and kernels are held against.
#pragma once

#include <functional>
#include <vector>

#include "engine/state/periodic_cell.h"
#include "engine/state/vector_field.h"

namespace peclet::engine {

struct SeenPair {
  std::uint32_t first, second;  // first < second
  LatticeShift image;           // added to the position of `second` as given
  Vector3 separation;

  friend bool operator==(const SeenPair& a, const SeenPair& b) {
    return a.first == b.first && a.second == b.second && a.image == b.image;
  }
};

// Every pair and image closer than range(first, second), sorted by (first, second, image). The lattice is
// (Lx, 0, 0), (tilt, Ly, 0), (0, 0, Lz), worked out here.
std::vector<SeenPair> every_image(const VectorField& position, const Vector3& lengths, double tilt,
                                  const std::function<double(std::uint32_t, std::uint32_t)>& range);

}  // namespace peclet::engine
