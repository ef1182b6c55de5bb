// PairGeometryOf and PairMotionOf are what a pair term takes, PairLoadOf is what it returns.
//
// n points from the first particle i to the second j. A term gives the force ON the first particle; the
// second one always gets its opposite. Torques are given for both. The template argument is the number
// (state/real.h): of one pair, or of several pairs of the same two radii.
#pragma once

#include "engine/state/vector3.h"

namespace peclet::engine {

template <class Real>
struct PairGeometryOf {
  Vector3Of<Real> separation;  // r, from the centre of i to that of the nearest image of j
  Vector3Of<Real> normal;      // r / |r|
  Real distance;               // |r|
  double sum_of_radii;

  Real surface_distance() const { return distance - sum_of_radii; }
  Real overlap() const { return sum_of_radii - distance; }  // positive in contact
};

// The velocity of j (of its image) relative to i, and both angular velocities, in the laboratory frame.
template <class Real>
struct PairMotionOf {
  Vector3Of<Real> velocity;
  Vector3Of<Real> spin_first, spin_second;
};

template <class Real>
struct PairLoadOf {
  Vector3Of<Real> force;  // acts on the first particle
  Vector3Of<Real> torque_first, torque_second;

  PairLoadOf& operator+=(const PairLoadOf& b) {
    return force += b.force, torque_first += b.torque_first, torque_second += b.torque_second, *this;
  }
};

using PairGeometry = PairGeometryOf<double>;
using PairMotion = PairMotionOf<double>;
using PairLoad = PairLoadOf<double>;

}  // namespace peclet::engine
