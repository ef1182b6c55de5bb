// Three-by-three matrices with sums, products and the inverse. Decompositions use Eigen (eigen_arrays.h).
#pragma once

#include <array>
#include <cmath>

#include "engine/state/vector3.h"

namespace peclet::engine {

struct Matrix3 {
  std::array<Vector3, 3> column;

  friend bool operator==(const Matrix3&, const Matrix3&) = default;
  friend Matrix3 operator+(const Matrix3& a, const Matrix3& b) {
    return {a.column[0] + b.column[0], a.column[1] + b.column[1], a.column[2] + b.column[2]};
  }
  friend Matrix3 operator-(const Matrix3& a, const Matrix3& b) {
    return {a.column[0] - b.column[0], a.column[1] - b.column[1], a.column[2] - b.column[2]};
  }
  friend Matrix3 operator*(double s, const Matrix3& a) {
    return {s * a.column[0], s * a.column[1], s * a.column[2]};
  }
  friend Vector3 operator*(const Matrix3& a, const Vector3& v) {
    return v.x * a.column[0] + v.y * a.column[1] + v.z * a.column[2];
  }
  friend Matrix3 operator*(const Matrix3& a, const Matrix3& b) {
    return {a * b.column[0], a * b.column[1], a * b.column[2]};
  }
};

inline Matrix3 identity() { return {Vector3{1, 0, 0}, Vector3{0, 1, 0}, Vector3{0, 0, 1}}; }
inline double determinant(const Matrix3& a) { return dot(a.column[0], cross(a.column[1], a.column[2])); }

// Requires linearly independent columns.
inline Matrix3 inverse(const Matrix3& a) {
  const double over = 1 / determinant(a);
  const Vector3 x = over * cross(a.column[1], a.column[2]), y = over * cross(a.column[2], a.column[0]),
                z = over * cross(a.column[0], a.column[1]);
  return {Vector3{x.x, y.x, z.x}, Vector3{x.y, y.y, z.y}, Vector3{x.z, y.z, z.z}};
}

// Returns the Frobenius norm, an upper bound of the factor by which a vector is stretched.
inline double norm(const Matrix3& a) {
  return std::sqrt(dot(a.column[0], a.column[0]) + dot(a.column[1], a.column[1]) +
                   dot(a.column[2], a.column[2]));
}

// Returns the matrix with `amount` at xy and 0 elsewhere: the velocity gradient of a flow (rate y, 0, 0), or
// the displacement gradient after a strain.
inline Matrix3 simple_shear(double amount) { return {Vector3{}, Vector3{amount, 0, 0}, Vector3{}}; }

}  // namespace peclet::engine
