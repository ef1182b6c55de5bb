// KeyedRandom gives random numbers that are keyed by their use, never drawn from a stream.
//
// A number is a pure function of (seed, purpose, step, identity), see normal_block.h. Results therefore do
// not depend on the order of particles or pairs, on threads or on checkpoints, and seeds share no numbers.
#pragma once

#include <cstdint>

#include "engine/state/periodic_cell.h"
#include "engine/state/vector3.h"
#include "engine/terms/normal_block.h"

namespace peclet::engine {

enum class Purpose : std::uint64_t {
  packing = 1,
  initial_velocity = 2,
  one_body_noise = 3,
  pair_noise = 4,
  strain_noise = 5
};

// Two independent vectors of standard normal components.
struct NormalPair {
  Vector3 first, second;
};

// Returns a shift as a number, with 20 bits for each component. Shifts between neighbours are small.
inline std::uint64_t image_identity(LatticeShift image) {
  constexpr std::uint64_t mask = (1U << 20) - 1;
  return (static_cast<std::uint64_t>(image.x) & mask) | (static_cast<std::uint64_t>(image.y) & mask) << 20 |
         (static_cast<std::uint64_t>(image.z) & mask) << 40;
}

class KeyedRandom {
 public:
  KeyedRandom() = default;
  KeyedRandom(std::uint64_t seed, Purpose purpose)
      : seed_(seed), purpose_(static_cast<std::uint64_t>(purpose)) {}

  NoiseKey key(std::uint64_t step, std::uint64_t part = 1) const { return {seed_, purpose_, step, part}; }

  // Returns the normals of a particle at a step. They come from 21-bit uniforms: the largest value is 5.5,
  // the variance exact to 1e-6 (tests/engine/kernels/keyed_random_test.cpp).
  NormalPair normals(std::uint64_t step, std::uint32_t particle) const;

  // Returns the normals of a pair at a step.
  NormalPair normals(std::uint64_t step, std::uint32_t first, std::uint32_t second, LatticeShift image) const;

  // Returns three uniform numbers in (0, 1), multiples of 2^-43.
  Vector3 uniforms(std::uint64_t step, std::uint32_t particle) const;

 private:
  std::uint64_t seed_ = 0;
  std::uint64_t purpose_ = 0;
};

}  // namespace peclet::engine
