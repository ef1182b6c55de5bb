// Resistance against rolling: a second spring that gives a couple and no force.
#pragma once

#include "engine/terms/tangential_spring.h"

namespace peclet::engine {

// v_r = a n x (Omega_i - Omega_j), a = 2 a_i a_j / (a_i + a_j). Monti et al. (2021) eq. B.1.
template <class Real>
PECLET_ALWAYS_INLINE Vector3Of<Real> rolling_velocity(double reduced_diameter,
                                                      const PairGeometryOf<Real>& pair,
                                                      const PairMotionOf<Real>& motion) {
  return Real{reduced_diameter} * cross(pair.normal, motion.spin_first - motion.spin_second);
}

// T_i = a n x (k_r s_r), T_j = -T_i; no force and no stress.
template <class Real>
PECLET_ALWAYS_INLINE PairLoadOf<Real> rolling_load(double rolling_stiffness, const Vector3Of<Real>& spring,
                                                   double reduced_diameter,
                                                   const PairGeometryOf<Real>& pair) {
  const Vector3Of<Real> couple = Real{reduced_diameter * rolling_stiffness} * cross(pair.normal, spring);
  return {{}, couple, -couple};
}

}  // namespace peclet::engine
