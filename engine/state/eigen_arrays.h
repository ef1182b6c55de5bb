// Between the engine's vectors and Eigen's. Not for the kernels (tests/engine/isolation.py).
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

// Vectors of all particles as one array of Eigen's, for expressions over them.
//
// A column for each particle: x, y, z and the row's fourth, which is zero and must stay so. Expressions by
// element give the same bits as a loop over rows; sums over particles may be taken in another order.
using FieldArray = Eigen::Map<Eigen::Array4Xd, Eigen::Aligned32>;
using ConstFieldArray = Eigen::Map<const Eigen::Array4Xd, Eigen::Aligned32>;

inline FieldArray array(VectorField& field) {
  return {field.data(), 4, static_cast<Eigen::Index>(field.size())};
}
inline ConstFieldArray array(const VectorField& field) {
  return {field.data(), 4, static_cast<Eigen::Index>(field.size())};
}

}  // namespace peclet::engine
