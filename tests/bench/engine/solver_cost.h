// The measured cost of the solver of implicit steps, and its roofline.
#pragma once

#include <string>
#include <vector>

#include "engine/scene/scene.h"
#include "engine/state/system.h"
#include "tests/bench/engine/machine.h"
#include "tests/bench/engine/operation_counts.h"
#include "tests/bench/engine/spread.h"

namespace peclet::engine {

// Costs on one thread; times in seconds.
struct SolverCost {
  double rows, links;  // one row per particle
  std::size_t levels;
  Spread iteration;
  double rows_alone;                         // of an iteration without links
  double assembly, factorisation, residual;  // per system, before its iterations
  Operations of_rows, of_links;              // per iteration, padding links included
  Operations of_factorisation;
  double bytes;      // moved per iteration, at least
  std::size_t room;  // memory range of an iteration [bytes]
  double stream;     // bytes per second of a = b + s c in arrays of that size
};

// Measures at the positions and velocities of `system`.
SolverCost solver_cost(const Scene& scene, const System& system, double timestep);

// Prints a line per case.
void print_solvers(const std::vector<std::string>& names, const std::vector<SolverCost>& costs,
                   const Machine& machine);

}  // namespace peclet::engine
