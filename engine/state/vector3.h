// Three-vectors and symmetric tensors, by value.
#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

namespace peclet::engine {

struct Vector3 {
  double x = 0, y = 0, z = 0;

  Vector3& operator+=(const Vector3& b) { return x += b.x, y += b.y, z += b.z, *this; }
  Vector3& operator-=(const Vector3& b) { return x -= b.x, y -= b.y, z -= b.z, *this; }
};

inline Vector3 operator+(const Vector3& a, const Vector3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vector3 operator-(const Vector3& a, const Vector3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Vector3 operator-(const Vector3& a) { return {-a.x, -a.y, -a.z}; }
inline Vector3 operator*(double s, const Vector3& a) { return {s * a.x, s * a.y, s * a.z}; }
inline double dot(const Vector3& a, const Vector3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Vector3 cross(const Vector3& a, const Vector3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline double norm(const Vector3& a) { return std::sqrt(dot(a, a)); }

// The part of `a` across the unit vector `n`.
inline Vector3 across(const Vector3& a, const Vector3& n) { return a - dot(a, n) * n; }

// Components in the order in which every tensor of this program is written: xx, yy, zz, xy, xz, yz.
struct SymmetricTensor {
  double xx = 0, yy = 0, zz = 0, xy = 0, xz = 0, yz = 0;

  SymmetricTensor& operator+=(const SymmetricTensor& b) {
    return xx += b.xx, yy += b.yy, zz += b.zz, xy += b.xy, xz += b.xz, yz += b.yz, *this;
  }
};

inline SymmetricTensor operator+(SymmetricTensor a, const SymmetricTensor& b) { return a += b; }
inline SymmetricTensor operator*(double s, const SymmetricTensor& a) {
  return {s * a.xx, s * a.yy, s * a.zz, s * a.xy, s * a.xz, s * a.yz};
}

// (r F + F r) / 2, the symmetric part of the dyad of a pair's separation and force.
inline SymmetricTensor symmetric_dyad(const Vector3& r, const Vector3& f) {
  return {r.x * f.x,
          r.y * f.y,
          r.z * f.z,
          0.5 * (r.x * f.y + r.y * f.x),
          0.5 * (r.x * f.z + r.z * f.x),
          0.5 * (r.y * f.z + r.z * f.y)};
}

// One vector per particle, a structure of arrays: loops over particles run along each component.
struct VectorField {
  std::vector<double> x, y, z;

  VectorField() = default;
  explicit VectorField(std::size_t count) : x(count), y(count), z(count) {}

  std::size_t size() const { return x.size(); }
  Vector3 operator[](std::size_t i) const { return {x[i], y[i], z[i]}; }
  void set(std::size_t i, const Vector3& v) { x[i] = v.x, y[i] = v.y, z[i] = v.z; }
};

}  // namespace peclet::engine
