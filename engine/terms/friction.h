// SlidingFriction is sliding friction with history: a spring across the normal.
#pragma once

#include "engine/terms/contact.h"
#include "engine/terms/laws.h"

namespace peclet::engine {

// A law of springs (spring_laws.h).
struct SlidingFriction {
  static constexpr bool Terms::*chosen = &Terms::friction;
  static constexpr bool has_force = true, may_slide = true;
  static constexpr std::size_t component = 0;
  template <class Each>
  PECLET_ALWAYS_INLINE static auto& of(Each& each) {
    return each.tangential;
  }
  PECLET_ALWAYS_INLINE static double stiffness(const ContactParameters& of) {
    return of.tangential_stiffness;
  }
  PECLET_ALWAYS_INLINE static double coefficient(const ContactParameters& of) { return of.friction; }
  PECLET_ALWAYS_INLINE static double damping(const ContactParameters& of) { return of.tangential_damping; }

  // Returns v_t = (1 - n n).(U_j - U_i) - (l_i Omega_i + l_j Omega_j) x n, the velocity of j's surface
  // relative to i's. Li, Royer & Ness (2023) eq. 4; Monti et al. (2021) eq. 4b.
  template <class Real>
  PECLET_ALWAYS_INLINE static Vector3Of<Real> stretch_rate(const ContactOf<Real>& contact,
                                                           const PairMotionOf<Real>& motion) {
    const Vector3Of<Real> spin =
        contact.lever.first * motion.spin_first + contact.lever.second * motion.spin_second;
    return across(motion.velocity, contact.pair.normal) - cross(spin, contact.pair.normal);
  }

  // Returns F_i = k_t s, T_i = l_i n x F_i, T_j = l_j n x F_i. The spring s has the sign of the displacement
  // of j relative to i. Monti et al. (2021) eqs. 4c-e.
  template <class Real>
  PECLET_ALWAYS_INLINE static PairLoadOf<Real> load(const ContactOf<Real>& contact,
                                                    const Vector3Of<Real>& spring) {
    const Vector3Of<Real> force = Real{stiffness(contact.parameters)} * spring;
    const Vector3Of<Real> moment = cross(contact.pair.normal, force);
    return {force, contact.lever.first * moment, contact.lever.second * moment};
  }

  PECLET_ALWAYS_INLINE static double coupling(const ContactParameters& of, double /*reduced_diameter*/) {
    return stiffness(of);
  }
  // Returns (1 + 5/2) k_t: the spring acts on centres and, by levers a, on spins with the moment 2/5 m a^2.
  static double largest_stiffness(const ContactParameters& of, double /*first*/, double /*second*/) {
    return of.friction > 0 ? 3.5 * of.tangential_stiffness : 0;
  }
};

}  // namespace peclet::engine
