// What an evaluation of the forces takes from the machine, counted and not measured.
#pragma once

#include <optional>

#include "engine/kernels/force_field.h"
#include "tests/bench/engine/counted.h"

namespace peclet::engine {

// Operations of the kernel in one pass over the pairs of `system`, its random numbers and the sums into the
// particles' rows left out. Nothing for terms that are not compiled for counting.
std::optional<Operations> count_operations(const Physics& physics, System system, double timestep);

// Bytes per particle that one step moves between the processor and a memory whose caches hold nothing from
// one step to the next: rows, classes, identities, pairs, springs and crossing loads, each read once per walk
// through them; what is overwritten is fetched first.
double bytes_per_particle(const Physics& physics, const System& system, int threads);

}  // namespace peclet::engine
