// Vectors of all particles as one array of Eigen's, for expressions over them.
//
// Apart from vector_field.h, because the kernels must not reach Eigen (tests/engine/isolation.py).
#pragma once

#include <Eigen/Core>

#include "engine/state/vector_field.h"

namespace peclet::engine {

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
