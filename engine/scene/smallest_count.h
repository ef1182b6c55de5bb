// How many spheres it takes for one of each size.
#pragma once

#include <cstddef>

#include "engine/scene/composition.h"

namespace peclet::engine {

// The largest count that a scene may have.
constexpr std::size_t most_particles = 10'000'000;

// Whether each radius has a sphere among the `count` of these particles.
bool has_every_size(const Particles& particles);

// Returns a count of at most `most_particles` at which each radius has a sphere and one sphere less would
// leave some without, found by bisection; 0 if there is none.
std::size_t smallest_count(Particles particles);

}  // namespace peclet::engine
