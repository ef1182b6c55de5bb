// Between the engine's vectors and Eigen's. Not for the kernels (tests/engine/isolation.py).
#pragma once

#include <Eigen/Core>

#include "engine/state/vector3.h"

namespace peclet::engine {

inline Eigen::Vector3d to_eigen(const Vector3& v) { return {v.x, v.y, v.z}; }
inline Vector3 from_eigen(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

}  // namespace peclet::engine
