// Sliding friction with history.
//
// Levers reach the middle of the overlap, l_i = a_i - delta/2, l_j = a_j - delta/2, so l_i + l_j = r: then a
// pair's torques balance exactly and a rigid rotation of both spheres is no slip. (The published levers a_i,
// a_j do neither.)
#pragma once

#include "engine/terms/contact.h"
#include "engine/terms/pair_resistance.h"
#include "engine/terms/tangential_spring.h"

namespace peclet::engine {

template <class Real>
struct ContactLeversOf {
  Real first, second;
};

template <class Real>
PECLET_ALWAYS_INLINE ContactLeversOf<Real> contact_levers(double radius_first, double radius_second,
                                                          const PairGeometryOf<Real>& pair) {
  const Real half_overlap = 0.5 * pair.overlap();
  return {radius_first - half_overlap, radius_second - half_overlap};
}

// v_t = (1 - n n).(U_j - U_i) - (l_i Omega_i + l_j Omega_j) x n, of j's surface relative to i's.
// Li, Royer & Ness (2023) eq. 4; Monti et al. (2021) eq. 4b.
template <class Real>
PECLET_ALWAYS_INLINE Vector3Of<Real> slip_velocity(const ContactLeversOf<Real>& lever,
                                                   const PairGeometryOf<Real>& pair,
                                                   const PairMotionOf<Real>& motion) {
  const Vector3Of<Real> spin = lever.first * motion.spin_first + lever.second * motion.spin_second;
  return across(motion.velocity, pair.normal) - cross(spin, pair.normal);
}

// F_i = k_t s, T_i = l_i n x F_i, T_j = l_j n x F_i. The sign of s is that of the displacement of j relative
// to i. Monti et al. (2021) eqs. 4c-e.
template <class Real>
PECLET_ALWAYS_INLINE PairLoadOf<Real> friction_load(double tangential_stiffness,
                                                    const Vector3Of<Real>& spring,
                                                    const ContactLeversOf<Real>& lever,
                                                    const PairGeometryOf<Real>& pair) {
  const Vector3Of<Real> force = Real{tangential_stiffness} * spring;
  const Vector3Of<Real> moment = cross(pair.normal, force);
  return {force, lever.first * moment, lever.second * moment};
}

// Coulomb's law: |F_i| <= mu frictional_load(), as a length of the spring.
template <class Real>
PECLET_ALWAYS_INLINE Real longest_spring(const ContactParameters& contact, const Real& overlap) {
  return (contact.friction / contact.tangential_stiffness) * frictional_load(contact, overlap);
}

// Static and kinetic friction: beyond mu_s frictional_load() a contact slides, and its spring is cut to mu_k
// frictional_load(); it sticks again when its spring is not longer than that before it is cut. Luding,
// Granular Matter 10, 235 (2008), sect. 3.2. `slides`: 1 if it did in the step before, or 0.
template <class Real>
PECLET_ALWAYS_INLINE SpringLimitsOf<Real> sliding_limits(const ContactParameters& contact,
                                                         const Real& overlap, const Real& slides) {
  const Real load = frictional_load(contact, overlap);
  const Real kinetic = (contact.kinetic_friction / contact.tangential_stiffness) * load;
  return {select(slides > 0.5, kinetic, longest_spring(contact, overlap)), kinetic};
}

// Whether a contact slides after a step in which its spring had this length before it was cut. One without
// load has no friction and remembers nothing.
template <class Real>
PECLET_ALWAYS_INLINE Real slides_after(const ContactParameters& contact, const Real& overlap,
                                       const Real& length, const SpringLimitsOf<Real>& limits) {
  const auto slides = (length > limits.longest) & (frictional_load(contact, overlap) > 0.0);
  return select(slides, Real{1.0}, Real{0.0});
}

// Springs of a contact, as they couple velocities and spins: for slips T.(U_j - U_i) - (l_i Omega_i + l_j
// Omega_j) x n and couples a^2 T.(Omega_i - Omega_j).
template <class Real>
PECLET_ALWAYS_INLINE PairResistanceOf<Real> tangential_coupling(const ContactLeversOf<Real>& lever,
                                                                const Real& sliding, const Real& rolling) {
  return {.squeeze = Real{0.0},
          .shear = sliding,
          .pump_first = -sliding * lever.first,
          .pump_second = -sliding * lever.second,
          .twist_first = sliding * lever.first * lever.first + rolling,
          .twist_cross = sliding * lever.first * lever.second - rolling,
          .twist_second = sliding * lever.second * lever.second + rolling};
}

using ContactLevers = ContactLeversOf<double>;

}  // namespace peclet::engine
