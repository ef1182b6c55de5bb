// What the solver of implicit steps takes for a system, and what it would have to: its roofline.
#pragma once

#include <string>
#include <vector>

#include "engine/scene/scene.h"
#include "engine/state/system.h"
#include "tests/bench/engine/machine.h"
#include "tests/bench/engine/operation_counts.h"
#include "tests/bench/engine/spread.h"

namespace peclet::engine {

// Of one thread; times in seconds.
struct SolverCost {
  double rows, links;  // a row for each particle
  std::size_t levels;
  Spread iteration;
  double rows_alone;                         // of an iteration without links
  double assembly, factorisation, residual;  // of a system, before its iterations
  Operations of_rows, of_links;              // in an iteration; links that fill up groups of eight included
  Operations of_factorisation;
  double bytes;      // that an iteration moves at least
  std::size_t room;  // that it walks through, in bytes
  double stream;     // bytes per second of a = b + s c in as much room
};

// At the system's places and velocities.
SolverCost solver_cost(const Scene& scene, const System& system, double timestep);

// A line for each case.
void print_solvers(const std::vector<std::string>& names, const std::vector<SolverCost>& costs,
                   const Machine& machine);

}  // namespace peclet::engine
