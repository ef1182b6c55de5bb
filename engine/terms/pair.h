// What every pair term is given and what it gives back.
//
// n points from the first particle i to the second j. A term gives the force ON the first particle; the
// second one gets its opposite, always. Torques are given for both. Everything is a template on the number
// (state/real.h): one pair, or several pairs of the same two radii side by side.
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

// Velocity of j (of its image) relative to i, and both angular velocities, in the laboratory frame.
template <class Real>
struct PairMotionOf {
  Vector3Of<Real> velocity;
  Vector3Of<Real> spin_first, spin_second;
};

template <class Real>
struct PairLoadOf {
  Vector3Of<Real> force;  // on the first particle
  Vector3Of<Real> torque_first, torque_second;

  PairLoadOf& operator+=(const PairLoadOf& b) {
    return force += b.force, torque_first += b.torque_first, torque_second += b.torque_second, *this;
  }
};

using PairGeometry = PairGeometryOf<double>;
using PairMotion = PairMotionOf<double>;
using PairLoad = PairLoadOf<double>;

}  // namespace peclet::engine
