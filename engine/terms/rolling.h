// RollingFriction is resistance against rolling: a second spring that gives a couple and no force.
#pragma once

#include "engine/terms/contact.h"
#include "engine/terms/laws.h"

namespace peclet::engine {

// A law of springs (spring_laws.h).
struct RollingFriction {
  static constexpr bool Terms::*chosen = &Terms::rolling;
  static constexpr bool has_force = false, may_slide = false;
  static constexpr std::size_t component = 3;
  template <class Each>
  PECLET_ALWAYS_INLINE static auto& of(Each& each) {
    return each.rolling;
  }
  PECLET_ALWAYS_INLINE static double stiffness(const ContactParameters& of) { return of.rolling_stiffness; }
  PECLET_ALWAYS_INLINE static double coefficient(const ContactParameters& of) { return of.rolling_friction; }
  PECLET_ALWAYS_INLINE static double damping(const ContactParameters& /*of*/) { return 0; }

  // Returns v_r = a n x (Omega_i - Omega_j), a = 2 a_i a_j / (a_i + a_j). Monti et al. (2021) eq. B.1.
  template <class Real>
  PECLET_ALWAYS_INLINE static Vector3Of<Real> stretch_rate(const ContactOf<Real>& contact,
                                                           const PairMotionOf<Real>& motion) {
    return Real{contact.reduced_diameter} *
           cross(contact.pair.normal, motion.spin_first - motion.spin_second);
  }

  // Returns T_i = a n x (k_r s_r), T_j = -T_i; there is no force and no stress.
  template <class Real>
  PECLET_ALWAYS_INLINE static PairLoadOf<Real> load(const ContactOf<Real>& contact,
                                                    const Vector3Of<Real>& spring) {
    const Vector3Of<Real> couple =
        Real{contact.reduced_diameter * stiffness(contact.parameters)} * cross(contact.pair.normal, spring);
    return {{}, couple, -couple};
  }

  // Returns the stiffness against Omega_i - Omega_j across n, a^2 k_r.
  PECLET_ALWAYS_INLINE static double coupling(const ContactParameters& of, double reduced_diameter) {
    return of.rolling_stiffness * reduced_diameter * reduced_diameter;
  }
  // Returns 5/2 k_r (a / a_min)^2 with the smaller radius a_min: the lever a turns the moment 2/5 m a_min^2.
  static double largest_stiffness(const ContactParameters& of, double first, double second) {
    const double reduced = 2 * first * second / (first + second);
    const double smaller = first < second ? first : second;
    return 2.5 * of.rolling_stiffness * (reduced / smaller) * (reduced / smaller);
  }
};

}  // namespace peclet::engine
