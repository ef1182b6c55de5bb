// Benchmarks the engine: named cases of the cost per particle and step, compared with the machine's limits.
#pragma once

#include <string>
#include <vector>

namespace peclet::engine {

// Runs the named groups or contestants of the catalogue, or all if `names` is empty. Prints for each group
// the time per particle and step, neighbour statistics and the distance from the machine's limits, with
// processor and commit. Throws InputError for a name that is not in the catalogue.
void run_benchmarks(const std::vector<std::string>& names);

}  // namespace peclet::engine
