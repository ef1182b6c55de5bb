// Resistance against rolling: a second spring that gives a couple and no force.
#pragma once

#include "engine/terms/contact.h"
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

// |k_r s_r| <= mu_r frictional_load(), as a length of the spring.
template <class Real>
PECLET_ALWAYS_INLINE Real longest_rolling_spring(const ContactParameters& contact, const Real& overlap) {
  return (contact.rolling_friction / contact.rolling_stiffness) * frictional_load(contact, overlap);
}

// The largest stiffness of a contact's springs, as if centres alone moved. A tangential spring acts on
// centres and, through levers a, on spins with 2/5 m a^2: 1 + 5/2 times as stiff. A rolling spring turns both
// spheres through the reduced diameter, at most the diameter of the smaller one.
inline double largest_contact_stiffness(const ContactParameters& contact, double radius_first,
                                        double radius_second) {
  const double tangential = contact.friction > 0 ? 3.5 * contact.tangential_stiffness : 0;
  const double reduced = 2 * radius_first * radius_second / (radius_first + radius_second);
  const double smaller = radius_first < radius_second ? radius_first : radius_second;
  const double rolling = 2.5 * contact.rolling_stiffness * (reduced / smaller) * (reduced / smaller);
  return larger(larger(contact.normal_stiffness, tangential), rolling);
}

// The stiffness against Omega_i - Omega_j across n: a^2 k_r.
inline double rolling_coupling(double rolling_stiffness, double reduced_diameter) {
  return rolling_stiffness * reduced_diameter * reduced_diameter;
}

}  // namespace peclet::engine
