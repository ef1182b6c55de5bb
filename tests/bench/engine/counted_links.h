// What the solver of implicit steps does, counted by its own kernels.
#pragma once

#include "tests/bench/engine/operation_counts.h"

namespace peclet::engine {

struct LinkSystem;
struct MotionRow;

struct SolverOperations {
  Operations factorisation, iteration;  // of single-precision numbers, empty lanes of rows included
  double squared_residual;              // that the last iteration leaves
};

// Of the kernels without any processor's own instructions, in the last of `iterations` >= 1 iterations for
// A x = right. The pivots of `system` are made anew.
SolverOperations count_solver_operations(const LinkSystem& system, const MotionRow* right, int iterations);

}  // namespace peclet::engine
