// Linear contact of overlapping spheres, with optional damping along the normal.
#pragma once

#include "engine/terms/pair.h"

namespace peclet::engine {

// F_i = -k_n delta n, delta = a_i + a_j - r > 0.
// Li, Royer & Ness (2023) eq. 3, which prints the force on j; sign as in Monti et al. (2021) eq. 4a.
template <class Real>
PECLET_ALWAYS_INLINE Vector3Of<Real> contact_normal_force(double normal_stiffness,
                                                          const PairGeometryOf<Real>& pair) {
  return (-normal_stiffness * pair.overlap()) * pair.normal;
}

// F_i = gamma_n n n.(U_j - U_i). Monti et al. (2021) eq. 4a.
template <class Real>
PECLET_ALWAYS_INLINE Vector3Of<Real> contact_damping_force(double normal_damping,
                                                           const PairGeometryOf<Real>& pair,
                                                           const PairMotionOf<Real>& motion) {
  return (normal_damping * dot(motion.velocity, pair.normal)) * pair.normal;
}

}  // namespace peclet::engine
