// How much of the sky the balls around a place leave free: the soft shade in gaps.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/pictures/stage.h"

namespace peclet::engine {

// The neighbours of each ball, so near that they take some of its sky.
class Occlusion {
 public:
  explicit Occlusion(const std::vector<Ball>& balls);

  // The free share of the sky over a place with that normal on the surface of a ball: the product over its
  // neighbours of 1 less the share of the sphere's cap, weighted with the cosine, (n . d) a^2 / r^2 for those
  // that the horizon does not cut.
  double free_sky(std::uint32_t ball, const Vector3& place, const Vector3& normal) const;

 private:
  struct Neighbour {
    Vector3 centre;
    double square;  // of its radius
  };
  std::vector<std::uint32_t> begin_;  // of each ball's neighbours, and the end
  std::vector<Neighbour> neighbours_;
};

}  // namespace peclet::engine
