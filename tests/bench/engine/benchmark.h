// Named cases that measure what a particle costs per step, beside what the machine could do.
#pragma once

#include <string>
#include <vector>

namespace peclet::engine {

// Runs the named groups or contestants of the catalogue, or all, and prints for each group time per particle
// and step, neighbour statistics and the distance from the machine's limits, with processor and commit.
// Throws InputError for a name that is not in the catalogue.
void run_benchmarks(const std::vector<std::string>& names);

}  // namespace peclet::engine
