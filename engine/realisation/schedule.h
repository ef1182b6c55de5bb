// How many steps a realisation takes, and of which size.
#pragma once

#include <string>

#include "engine/scene/scene.h"

namespace peclet::engine {

// Steps of the two phases; the step size is constant, so they are known before the first one.
struct Schedule {
  double timestep = 0;
  std::uint64_t equilibration = 0, production = 0;

  std::uint64_t total() const { return equilibration + production; }
};

// Throws InputError when the step is too large, the production window shorter than its 32 blocks, or a phase
// longer than can be counted.
Schedule make_schedule(const Scene& scene, const std::string& file);

}  // namespace peclet::engine
