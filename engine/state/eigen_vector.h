// Between the engine's vectors and Eigen's. Not for the kernels (tests/engine/isolation.py).
#pragma once

#include <Eigen/Core>

#include "engine/state/matrix3.h"

namespace peclet::engine {

inline Eigen::Vector3d to_eigen(const Vector3& v) { return {v.x, v.y, v.z}; }
inline Eigen::Matrix3d to_eigen(const Matrix3& m) {
  Eigen::Matrix3d result;
  result << to_eigen(m.column[0]), to_eigen(m.column[1]), to_eigen(m.column[2]);
  return result;
}
inline Vector3 from_eigen(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

}  // namespace peclet::engine
