// Eigen's vectors and matrices in the sizes of the tests.
#pragma once

#include "engine/state/eigen_arrays.h"

namespace peclet::engine {

// Motions or loads of a pair: three rows each for first sphere, second sphere, first spin, second spin.
using Vector12 = Eigen::Vector<double, 12>;
using Matrix12 = Eigen::Matrix<double, 12, 12>;

// Returns the largest |entry|, or NaN if an entry is NaN.
template <class Matrix>
double largest_entry(const Eigen::MatrixBase<Matrix>& matrix) {
  return matrix.cwiseAbs().template maxCoeff<Eigen::PropagateNaN>();
}

}  // namespace peclet::engine
