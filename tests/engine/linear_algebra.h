// Eigen's vectors and matrices in the sizes of the tests.
#pragma once

#include <Eigen/Core>

#include "engine/state/vector3.h"

namespace peclet::engine {

// Of the motions or loads of a pair: three rows each of first, second sphere, first, second spin.
using Vector12 = Eigen::Vector<double, 12>;
using Matrix12 = Eigen::Matrix<double, 12, 12>;

inline Eigen::Vector3d to_eigen(const Vector3& v) { return {v.x, v.y, v.z}; }
inline Vector3 from_eigen(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

// |entry|; NaN where there is one.
template <class Matrix>
double largest_entry(const Eigen::MatrixBase<Matrix>& matrix) {
  return matrix.cwiseAbs().template maxCoeff<Eigen::PropagateNaN>();
}

}  // namespace peclet::engine
