// Counts the operations of the solver of implicit steps by its own kernels.
#pragma once

#include "tests/bench/engine/operation_counts.h"

namespace peclet::engine {

struct LinkSystem;
struct MotionRow;

struct SolverOperations {
  Operations factorisation, iteration;  // in single precision, including empty lanes
  double squared_residual;              // after the last iteration
};

// Counts the factorisation and the last of `iterations` >= 1 iterations for A x = right, with the baseline
// kernels. The pivots of `system` are computed anew.
SolverOperations count_solver_operations(const LinkSystem& system, const MotionRow* right, int iterations);

}  // namespace peclet::engine
