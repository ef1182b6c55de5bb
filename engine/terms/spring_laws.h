// Laws of springs give the loads of a contact whose surfaces have moved since they touched.
//
// A law is a struct of static members, listed in for_each_spring_law():
//   chosen                       the member of Terms that compiles it
//   has_force                    whether it gives a force, which has a stress, or a couple alone
//   may_slide                    whether kinetic friction cuts its spring
//   component                    the first of the spring's three components in a SpringField
//   of(each)                     the law's member of `each`
//   stretch_rate()               the velocity at which the spring grows, across n
//   stiffness(), coefficient()   k and mu: the spring is cut to |k s| = mu frictional_load()
//   damping()                    gamma of a dashpot beside the spring, or 0
//   load()                       force and couples of a spring s
//   coupling()                   the slope of the load, an argument of tangential_coupling()
//   largest_stiffness()          the largest slope as if only centres moved, which bounds the step
// tangential_spring.h and this header have what all laws share.
#pragma once

#include "engine/terms/friction.h"
#include "engine/terms/laws.h"
#include "engine/terms/pair_resistance.h"
#include "engine/terms/rolling.h"
#include "engine/terms/tangential_spring.h"

namespace peclet::engine {

// Calls body(law) for every law.
template <class Body>
PECLET_ALWAYS_INLINE void for_each_spring_law(Body&& body) {
  body(SlidingFriction{});
  body(RollingFriction{});
}
// Calls body(law) for the laws that the terms have.
template <class Body>
PECLET_ALWAYS_INLINE void for_each_spring_law(const Terms& terms, Body&& body) {
  for_each_spring_law([&](auto law) PECLET_INLINE_LAMBDA {
    if (terms.*decltype(law)::chosen) body(law);
  });
}
// Calls body(law) for the laws that the terms have, and compiles it for no others.
template <Terms terms, class Body>
PECLET_ALWAYS_INLINE void for_each_spring_law(Body&& body) {
  for_each_spring_law([&](auto law) PECLET_INLINE_LAMBDA {
    if constexpr (terms.*decltype(law)::chosen) body(law);
  });
}

// OfEachSpring has a member for each spring.
template <class Each>
struct OfEachSpring {
  Each tangential{}, rolling{};
};

template <class Real>
struct PairSpringsOf {
  Vector3Of<Real> tangential, rolling;
  Real slides{};  // 1 or 0
};

// Returns Coulomb's law, |F| <= mu frictional_load(), as lengths of the spring. With kinetic friction a
// contact slides beyond mu_s frictional_load(), and its spring is cut to mu_k frictional_load(). It sticks
// again if its uncut spring is not longer than that (Luding, Granular Matter 10, 235 (2008), sect. 3.2).
// `slides` is 1 if the contact slid in the last step, else 0.
template <class Law, class Real>
PECLET_ALWAYS_INLINE SpringLimitsOf<Real> spring_limits(const ContactOf<Real>& contact, bool kinetic,
                                                        const Real& slides) {
  const ContactParameters& parameters = contact.parameters;
  const Real load = frictional_load(parameters, contact.pair.overlap());
  const Real longest = (Law::coefficient(parameters) / Law::stiffness(parameters)) * load;
  if (!kinetic || !Law::may_slide) return {longest, longest};
  const Real left = (parameters.kinetic_friction / Law::stiffness(parameters)) * load;
  return {select(slides > 0.5, left, longest), left};
}

// Returns 1 if a contact slides after a step in which its uncut spring had this length, else 0. A contact
// without load has no friction and does not slide.
template <class Real>
PECLET_ALWAYS_INLINE Real slides_after(const ContactOf<Real>& contact, const Real& length,
                                       const SpringLimitsOf<Real>& limits) {
  const Real load = frictional_load(contact.parameters, contact.pair.overlap());
  return select((length > limits.longest) & (load > 0.0), Real{1.0}, Real{0.0});
}

// Returns the time by which a dashpot pushes ahead of its spring, gamma / k: k s + gamma v = k (s + lead v).
template <class Law>
PECLET_ALWAYS_INLINE double lead_of(const ContactParameters& parameters) {
  const double damping = Law::damping(parameters);
  return damping > 0 ? damping / Law::stiffness(parameters) : 0;
}

template <class Real>
PECLET_ALWAYS_INLINE Vector3Of<Real> cut_to(const Vector3Of<Real>& vector, const Real& longest) {
  const Real length = norm(vector);
  return select(length > longest, longest / length, Real{1.0}) * vector;
}

// Returns the force of a spring and its dashpot as a length of spring. Coulomb's law limits both together.
// They dissipate energy in any motion (proof in PHYSICS.md). `length` is that of the uncut spring; if spring
// and dashpot together are longer, it becomes their length, and the spring is cut.
template <class Law, class Real>
PECLET_ALWAYS_INLINE Vector3Of<Real> damped_spring(const ContactOf<Real>& contact,
                                                   const PairMotionOf<Real>& motion,
                                                   const SpringLimitsOf<Real>& limits,
                                                   Vector3Of<Real>& spring, Real& length) {
  const double lead = lead_of<Law>(contact.parameters);
  if (!(lead > 0)) return spring;
  const Vector3Of<Real> ahead = Real{lead} * Law::stretch_rate(contact, motion);
  length = larger(length, norm(spring + ahead));
  const Real limit = select(length > limits.longest, limits.left, limits.longest);
  spring = cut_to(spring, limit);
  return cut_to(spring + ahead, limit);
}

// Advances the spring by `time` if spheres touch, else sets it to zero. Returns the load of the dashpot and
// of the spring after `felt_share` of the advance.
template <class Law, bool kinetic, class Real>
PECLET_ALWAYS_INLINE PairLoadOf<Real> advanced_load(const ContactOf<Real>& contact,
                                                    const PairMotionOf<Real>& motion, double time,
                                                    double felt_share, PairSpringsOf<Real>& springs) {
  const auto touching = contact.pair.overlap() > 0.0;
  Vector3Of<Real>& spring = Law::of(springs);
  const Vector3Of<Real> before = spring, normal = contact.pair.normal;
  const Vector3Of<Real> stretch = Real{time} * Law::stretch_rate(contact, motion);
  const SpringLimitsOf<Real> limits = spring_limits<Law>(contact, kinetic, springs.slides);
  Real length;
  spring = where(touching, advanced_spring(before, normal, stretch, limits, length));
  Vector3Of<Real> felt = damped_spring<Law>(contact, motion, limits, spring, length);
  if constexpr (kinetic && Law::may_slide) {
    springs.slides = select(touching, slides_after(contact, length, limits), Real{0.0});
  }
  if (felt_share != 1) {
    Vector3Of<Real> part =
        where(touching, advanced_spring(before, normal, Real{felt_share} * stretch, limits, length));
    felt = damped_spring<Law>(contact, motion, limits, part, length);
  }
  return Law::load(contact, felt);
}

// Returns the shares of their stiffness that springs keep when they are cut after `time`.
template <class Real>
PECLET_ALWAYS_INLINE OfEachSpring<Real> held_shares(const Terms& terms, const ContactOf<Real>& contact,
                                                    const PairMotionOf<Real>& motion, double time,
                                                    const PairSpringsOf<Real>& springs) {
  OfEachSpring<Real> shares;
  for_each_spring_law(terms, [&](auto law) PECLET_INLINE_LAMBDA {
    using Law = decltype(law);
    const double ahead = time + lead_of<Law>(contact.parameters);
    Law::of(shares) =
        held_share(Law::of(springs), contact.pair.normal, Real{ahead} * Law::stretch_rate(contact, motion),
                   spring_limits<Law>(contact, terms.kinetic, springs.slides));
  });
  return shares;
}

// Returns how springs of a contact couple velocities and spins. T = 1 - n n. The stiffness `sliding` acts on
// slips T.(U_j - U_i) - (l_i Omega_i + l_j Omega_j) x n, and `rolling`, which contains a^2, on T.(Omega_i -
// Omega_j).
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

// Adds the stiffness of the springs of touching spheres and the resistance of their dashpots, times weight
// and share `held`.
template <class Real>
PECLET_ALWAYS_INLINE void add_springs(PairResistanceOf<Real>& sum, const Terms& terms,
                                      const ContactOf<Real>& contact, const CouplingWeights& weights,
                                      const OfEachSpring<Real>& held) {
  OfEachSpring<Real> stiffness, resistance;
  bool damped = false;
  for_each_spring_law(terms, [&](auto law) PECLET_INLINE_LAMBDA {
    using Law = decltype(law);
    const double lead = lead_of<Law>(contact.parameters);
    Law::of(stiffness) = Law::coupling(contact.parameters, contact.reduced_diameter) * Law::of(held);
    Law::of(resistance) = lead * Law::of(stiffness);
    damped = damped || lead > 0;
  });
  const auto add = [&](double weight, const OfEachSpring<Real>& each) PECLET_INLINE_LAMBDA {
    add_scaled(sum, select(contact.pair.overlap() > 0.0, Real{weight}, Real{0.0}),
               tangential_coupling(contact.lever, each.tangential, each.rolling));
  };
  add(weights.tangential, stiffness);
  if (damped) add(weights.resistance, resistance);
}

// Return the largest stiffness and the resistance of the dashpots of a contact, as if only centres moved.
inline double largest_contact_stiffness(const ContactParameters& contact, double radius_first,
                                        double radius_second) {
  double largest = contact.normal_stiffness;
  for_each_spring_law([&](auto law) {
    largest = larger(largest, decltype(law)::largest_stiffness(contact, radius_first, radius_second));
  });
  return largest;
}
inline double largest_contact_damping(const ContactParameters& contact, double radius_first,
                                      double radius_second) {
  double sum = 0;
  for_each_spring_law([&](auto law) {
    using Law = decltype(law);
    sum += lead_of<Law>(contact) * Law::largest_stiffness(contact, radius_first, radius_second);
  });
  return sum;
}

}  // namespace peclet::engine
