// Eigen's vectors and matrices in the sizes of the tests.
#pragma once

#include "engine/state/eigen_arrays.h"

namespace peclet::engine {

// Of the motions or loads of a pair: three rows each of first, second sphere, first, second spin.
using Vector12 = Eigen::Vector<double, 12>;
using Matrix12 = Eigen::Matrix<double, 12, 12>;

// |entry|; NaN where there is one.
template <class Matrix>
double largest_entry(const Eigen::MatrixBase<Matrix>& matrix) {
  return matrix.cwiseAbs().template maxCoeff<Eigen::PropagateNaN>();
}

}  // namespace peclet::engine
