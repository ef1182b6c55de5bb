// What the solver of implicit steps does, counted by its own kernels.
#pragma once

#include "engine/benchmark/operation_counts.h"

namespace peclet::engine {

struct LinkSystem;
struct MotionRow;

struct SolverOperations {
  Operations factorisation, iteration;  // of single-precision numbers, empty lanes of rows included
  double squared_residual;              // that the last iteration leaves
};

// Of the kernels that take one processor's instructions as well as any other's, in `iterations` >= 1
// iterations for A x = right. The pivots of `system` are not read.
SolverOperations count_solver_operations(const LinkSystem& system, const MotionRow* right, int iterations);

}  // namespace peclet::engine
