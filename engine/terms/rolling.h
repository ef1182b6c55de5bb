// Resistance against rolling: a second spring that gives a couple and no force.
#pragma once

#include "engine/terms/tangential_spring.h"

namespace peclet::engine {

// v_r = a n x (Omega_i - Omega_j), a = 2 a_i a_j / (a_i + a_j). Monti et al. (2021) eq. B.1.
inline Vector3 rolling_velocity(double reduced_diameter, const PairGeometry& pair, const PairMotion& motion) {
  return reduced_diameter * cross(pair.normal, motion.spin_first - motion.spin_second);
}

// T_i = a n x (k_r s_r), T_j = -T_i; no force and no stress.
inline PairLoad rolling_load(double rolling_stiffness, const Vector3& spring, double reduced_diameter,
                             const PairGeometry& pair) {
  const Vector3 couple = (reduced_diameter * rolling_stiffness) * cross(pair.normal, spring);
  return {{}, couple, -couple};
}

}  // namespace peclet::engine
