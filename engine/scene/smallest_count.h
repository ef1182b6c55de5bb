// How many spheres it takes for one of each size.
#pragma once

#include <cstddef>

#include "engine/scene/composition.h"

namespace peclet::engine {

// Whether each radius has a sphere among the `count` of these particles.
bool has_every_size(const Particles& particles);

// Returns the number of spheres from which on the shares give each radius a whole one; 0 if it is larger than
// `most_particles`. Rounding may give all of them one at fewer, but not at every larger count.
std::size_t smallest_count(Particles particles);

}  // namespace peclet::engine
