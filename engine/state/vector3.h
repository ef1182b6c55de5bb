// Three-vectors and symmetric tensors of doubles or of lanes of doubles.
#pragma once

#include "engine/state/real.h"

namespace peclet::engine {

template <class Real>
struct Vector3Of {
  Real x{}, y{}, z{};

  Vector3Of& operator+=(const Vector3Of& b) { return x += b.x, y += b.y, z += b.z, *this; }
  Vector3Of& operator-=(const Vector3Of& b) { return x -= b.x, y -= b.y, z -= b.z, *this; }

  friend bool operator==(const Vector3Of&, const Vector3Of&) = default;
  friend Vector3Of operator+(const Vector3Of& a, const Vector3Of& b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
  }
  friend Vector3Of operator-(const Vector3Of& a, const Vector3Of& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
  }
  friend Vector3Of operator-(const Vector3Of& a) { return {-a.x, -a.y, -a.z}; }
  friend Vector3Of operator*(const Real& s, const Vector3Of& a) { return {s * a.x, s * a.y, s * a.z}; }
};

template <class Real>
Real dot(const Vector3Of<Real>& a, const Vector3Of<Real>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class Real>
Vector3Of<Real> cross(const Vector3Of<Real>& a, const Vector3Of<Real>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class Real>
Real norm(const Vector3Of<Real>& a) {
  return square_root(dot(a, a));
}

// Returns the part of `a` perpendicular to the unit vector `n`.
template <class Real>
Vector3Of<Real> across(const Vector3Of<Real>& a, const Vector3Of<Real>& n) {
  return a - dot(a, n) * n;
}

// Returns `a` where the condition holds, zero elsewhere.
template <class Mask, class Real>
Vector3Of<Real> where(const Mask& condition, const Vector3Of<Real>& a) {
  return {select(condition, a.x, Real{}), select(condition, a.y, Real{}), select(condition, a.z, Real{})};
}

// A symmetric tensor; all files of this program have its components in this order.
template <class Real>
struct SymmetricTensorOf {
  Real xx{}, yy{}, zz{}, xy{}, xz{}, yz{};

  SymmetricTensorOf& operator+=(const SymmetricTensorOf& b) {
    return xx += b.xx, yy += b.yy, zz += b.zz, xy += b.xy, xz += b.xz, yz += b.yz, *this;
  }

  friend SymmetricTensorOf operator+(SymmetricTensorOf a, const SymmetricTensorOf& b) { return a += b; }
  friend SymmetricTensorOf operator*(const Real& s, const SymmetricTensorOf& a) {
    return {s * a.xx, s * a.yy, s * a.zz, s * a.xy, s * a.xz, s * a.yz};
  }
};

// Returns (r F + F r) / 2, the symmetric part of the dyad of a pair's separation and force.
template <class Real>
SymmetricTensorOf<Real> symmetric_dyad(const Vector3Of<Real>& r, const Vector3Of<Real>& f) {
  const Real half{0.5};
  return {r.x * f.x,
          r.y * f.y,
          r.z * f.z,
          half * (r.x * f.y + r.y * f.x),
          half * (r.x * f.z + r.z * f.x),
          half * (r.y * f.z + r.z * f.y)};
}

using Vector3 = Vector3Of<double>;
using SymmetricTensor = SymmetricTensorOf<double>;

}  // namespace peclet::engine
