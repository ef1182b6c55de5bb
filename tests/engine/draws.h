// Reproducible draws for tests, from a generator that the engine does not use.
#pragma once

#include <random>

#include "engine/state/vector3.h"

namespace peclet::engine {

class Draws {
 public:
  explicit Draws(std::uint64_t seed) : generator_(seed) {}

  double uniform(double low, double high) {
    return low + (high - low) * static_cast<double>(generator_() >> 11) * 0x1p-53;
  }
  int whole(int low, int high) {  // inclusive
    return low + static_cast<int>(generator_() % static_cast<std::uint64_t>(high - low + 1));
  }
  // Returns components uniform in [-size, size).
  Vector3 vector(double size = 1) {
    return {uniform(-size, size), uniform(-size, size), uniform(-size, size)};
  }
  Vector3 direction() {
    Vector3 v = vector();
    while (norm(v) > 1 || norm(v) < 0.1) v = vector();
    return (1 / norm(v)) * v;
  }

 private:
  std::mt19937_64 generator_;
};

}  // namespace peclet::engine
