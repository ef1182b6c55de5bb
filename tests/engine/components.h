// Comparisons of vectors and tensors, component by component.
#pragma once

#include <gtest/gtest.h>

#include "engine/state/vector3.h"

namespace peclet::engine {

inline constexpr double SymmetricTensor::*every_component[] = {&SymmetricTensor::xx, &SymmetricTensor::yy,
                                                               &SymmetricTensor::zz, &SymmetricTensor::xy,
                                                               &SymmetricTensor::xz, &SymmetricTensor::yz};

inline void expect_near(const Vector3& a, const Vector3& b, double tolerance) {
  for (const auto c : {&Vector3::x, &Vector3::y, &Vector3::z}) EXPECT_NEAR(a.*c, b.*c, tolerance);
}

inline void expect_near(const SymmetricTensor& a, const SymmetricTensor& b, double tolerance) {
  for (const auto c : every_component) EXPECT_NEAR(a.*c, b.*c, tolerance);
}

}  // namespace peclet::engine
