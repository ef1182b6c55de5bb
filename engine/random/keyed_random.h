// Random numbers keyed by what they are for, never drawn from a stream.
//
// A number is a pure function of (seed, purpose, step, identity): Threefry-4x64-20 of Random123 (Salmon et
// al. 2011), key (seed, purpose, 0, 0), counter (step, identity). So results depend on no order of particles
// or pairs, on no number of threads and on no checkpoint, and two seeds share nothing.
#pragma once

#include <array>
#include <cstdint>

#include "engine/state/sheared_box.h"
#include "engine/state/vector3.h"

namespace peclet::engine {

enum class Purpose : std::uint64_t { packing = 1, initial_velocity = 2, one_body_noise = 3, pair_noise = 4 };

// Two independent vectors of standard normal components.
struct NormalPair {
  Vector3 first, second;
};

class KeyedRandom {
 public:
  KeyedRandom() = default;
  KeyedRandom(std::uint64_t seed, Purpose purpose)
      : seed_(seed), purpose_(static_cast<std::uint64_t>(purpose)) {}

  // Of a particle at a step. Box-Muller from 32-bit uniforms in single precision: steps of 6e-8 relative,
  // largest value 6.8, variance exact to 1e-6 (tests/engine/keyed_random_test.cpp).
  NormalPair normals(std::uint64_t step, std::uint32_t particle) const;

  // Of a pair at a step. `first` < `second` fixes the sign of the pair's forces.
  NormalPair normals(std::uint64_t step, std::uint32_t first, std::uint32_t second, LatticeShift image) const;

  // Three uniform numbers in (0, 1).
  Vector3 uniforms(std::uint64_t step, std::uint32_t particle) const;

 private:
  std::array<std::uint64_t, 4> bits(std::uint64_t step, std::uint64_t identity, std::uint64_t image) const;

  std::uint64_t seed_ = 0;
  std::uint64_t purpose_ = 0;
};

}  // namespace peclet::engine
