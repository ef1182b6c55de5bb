// What every pair term is given and what it gives back.
//
// n points from the first particle i to the second j. A term gives the force ON the first particle; the
// second one gets its opposite, always. Torques are given for both.
#pragma once

#include "engine/state/vector3.h"

namespace peclet::engine {

struct PairGeometry {
  Vector3 separation;  // r, from the centre of i to that of the nearest image of j
  Vector3 normal;      // r / |r|
  double distance;     // |r|
  double sum_of_radii;

  double surface_distance() const { return distance - sum_of_radii; }
  double overlap() const { return sum_of_radii - distance; }  // positive in contact
};

// Velocity of j (of its image) relative to i, and both angular velocities, in the laboratory frame.
struct PairMotion {
  Vector3 velocity;
  Vector3 spin_first, spin_second;
};

struct PairLoad {
  Vector3 force;  // on the first particle
  Vector3 torque_first, torque_second;

  PairLoad& operator+=(const PairLoad& b) {
    return force += b.force, torque_first += b.torque_first, torque_second += b.torque_second, *this;
  }
};

}  // namespace peclet::engine
