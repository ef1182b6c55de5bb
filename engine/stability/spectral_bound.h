// The largest eigenvalue of a packing's matrix, by Lanczos iterations.
#pragma once

#include "engine/stability/packing_matrix.h"

namespace peclet::engine {

// There is an eigenvalue within `residual` of `value`, which is at most the largest one.
struct SpectralBound {
  double value = 0, residual = 0;
  int iterations = 0;

  // Not below the largest eigenvalue, unless the iterations have taken another one for it: modes of a packing
  // sit on few spheres, and may not have been met yet. Then it is too low by some thousandths
  // (tests/engine/stability/spectral_bound_test.cpp).
  double upper() const { return value + residual; }
};

// Iterates from a fixed random vector until the residual is below `tolerance` times the value. The same
// matrix gives the same bits.
SpectralBound largest_eigenvalue(const PackingMatrix& matrix, double tolerance = 0.01);

}  // namespace peclet::engine
