// Named cases that measure what a particle costs per step.
#pragma once

#include <string>
#include <vector>

namespace peclet::engine {

// Runs the named cases, or all, and prints median and spread of each with processor and commit.
// Throws InputError for a name that is not in the catalogue. Returns the exit code.
int run_benchmarks(const std::vector<std::string>& names);

}  // namespace peclet::engine
