#include "engine/kernels/pair_access.h"

namespace peclet::engine {

std::vector<ImageFrame> image_frames(const NeighbourList& list, const PeriodicCell& box) {
  std::vector<ImageFrame> frames;
  for (const LatticeShift image : list.images()) {
    frames.push_back({box.displacement(image), box.velocity(image)});
  }
  return frames;
}

}  // namespace peclet::engine
