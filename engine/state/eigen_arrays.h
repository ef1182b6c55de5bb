// Converts between the engine's vectors and Eigen's.
//
// Stands apart from vector3.h, matrix3.h and vector_field.h because kernels must not include Eigen: the
// linker may keep the copy of an Eigen function that was compiled for a newer processor
// (tests/engine/isolation.py).
#pragma once

#include <Eigen/Core>

#include "engine/state/matrix3.h"
#include "engine/state/vector_field.h"

namespace peclet::engine {

inline Eigen::Vector3d to_eigen(const Vector3& v) { return {v.x, v.y, v.z}; }
inline Eigen::Matrix3d to_eigen(const Matrix3& m) {
  Eigen::Matrix3d result;
  result << to_eigen(m.column[0]), to_eigen(m.column[1]), to_eigen(m.column[2]);
  return result;
}
inline Vector3 from_eigen(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

// A view of a VectorField as an Eigen array with a column x, y, z, 0 for each particle. The 0 must stay 0.
// Element-wise expressions give the bits of a loop; sums over particles may be added in another order.
using FieldArray = Eigen::Map<Eigen::Array4Xd, Eigen::Aligned32>;
using ConstFieldArray = Eigen::Map<const Eigen::Array4Xd, Eigen::Aligned32>;

inline FieldArray array(VectorField& field) {
  return {field.data(), 4, static_cast<Eigen::Index>(field.size())};
}
inline ConstFieldArray array(const VectorField& field) {
  return {field.data(), 4, static_cast<Eigen::Index>(field.size())};
}

}  // namespace peclet::engine
