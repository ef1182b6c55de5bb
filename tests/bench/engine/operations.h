// Counted operations and bytes of a force evaluation.
#pragma once

#include <optional>

#include "engine/kernels/force_field.h"
#include "tests/bench/engine/counted.h"

namespace peclet::engine {

// Returns the operations of one kernel pass over the pairs of `system`. Random numbers and the sums into
// particle rows are left out. Returns nothing for terms that are not compiled for counting.
std::optional<Operations> count_operations(const Physics& physics, System system, double timestep);

// Returns the bytes per particle that one step moves if caches keep nothing between loops. Rows, classes,
// identities, pairs, springs and crossing loads are read once per loop over them; written memory is fetched.
double bytes_per_particle(const Physics& physics, const System& system, int threads);

}  // namespace peclet::engine
