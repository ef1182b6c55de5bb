// Contact of overlapping spheres: a linear spring along the normal, with optional damping, and what the laws
// of springs across the normal (spring_laws.h) see of a contact.
//
// Levers reach the middle of the overlap, l_i = a_i - delta/2, l_j = a_j - delta/2, so l_i + l_j = r: then a
// pair's torques balance exactly and a rigid rotation of both spheres is no slip. (The published levers a_i,
// a_j do neither.)
#pragma once

#include <limits>

#include "engine/terms/pair.h"

namespace peclet::engine {

// Stiffnesses in force per length, damping in force per velocity.
struct ContactParameters {
  double normal_stiffness = 0;
  double normal_damping = 0;
  double friction = 0;                                                // of contacts that stick
  double kinetic_friction = std::numeric_limits<double>::infinity();  // of those that slide, where it is less
  double critical_load = 0;  // F_CL: below this normal force there is no friction
  double largest_load = std::numeric_limits<double>::infinity();  // above it friction grows no more
  double tangential_stiffness = 0;                                // 2/7 of the normal one unless given
  double tangential_damping = 0;
  double rolling_stiffness = 0;
  double rolling_friction = 0;  // that of sliding unless given
};

// Whether friction is less while contacts slide: they must remember whether they do.
inline bool remembers_sliding(const ContactParameters& contact) {
  return contact.kinetic_friction < contact.friction;
}

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
using ContactLevers = ContactLeversOf<double>;

// A pair as the laws of springs see it.
template <class Real>
struct ContactOf {
  const ContactParameters& parameters;
  const PairGeometryOf<Real>& pair;
  ContactLeversOf<Real> lever;
  double reduced_diameter;  // a = 2 a_i a_j / (a_i + a_j)
};

// k_n delta, delta = a_i + a_j - r, the size of the force in overlap.
template <class Real>
PECLET_ALWAYS_INLINE Real contact_push(double normal_stiffness, const Real& overlap) {
  return normal_stiffness * overlap;
}

// The part of the normal force that friction goes by: min(max(k_n delta - F_CL, 0), F_max). With F_CL alone
// contacts have no friction until something that repels is overcome: the critical load model of Seto, Mari,
// Morris & Denn, Phys. Rev. Lett. 111, 218301 (2013).
template <class Real>
PECLET_ALWAYS_INLINE Real frictional_load(const ContactParameters& contact, const Real& overlap) {
  const Real excess = contact_push(contact.normal_stiffness, overlap) - Real{contact.critical_load};
  const Real load = larger(excess, Real{0.0}), largest{contact.largest_load};
  return select(load > largest, largest, load);
}

// F_i = -k_n delta n for delta > 0, of the energy k_n delta^2 / 2.
// Li, Royer & Ness (2023) eq. 3, which prints the force on j; sign as in Monti et al. (2021) eq. 4a.
template <class Real>
PECLET_ALWAYS_INLINE Vector3Of<Real> contact_normal_force(double normal_stiffness,
                                                          const PairGeometryOf<Real>& pair) {
  return -contact_push(normal_stiffness, pair.overlap()) * pair.normal;
}
inline double contact_energy(double normal_stiffness, double overlap) {
  return overlap > 0 ? 0.5 * contact_push(normal_stiffness, overlap) * overlap : 0;
}

// F_i = gamma_n n n.(U_j - U_i). Monti et al. (2021) eq. 4a.
template <class Real>
PECLET_ALWAYS_INLINE Vector3Of<Real> contact_damping_force(double normal_damping,
                                                           const PairGeometryOf<Real>& pair,
                                                           const PairMotionOf<Real>& motion) {
  return (normal_damping * dot(motion.velocity, pair.normal)) * pair.normal;
}

// Factors of a coupling: of resistances, of stiffnesses along n, and of those of springs across n.
struct CouplingWeights {
  double resistance = 0, normal = 0, tangential = 0;
};

// How a contact couples the normal velocities of its spheres: its stiffness and its damping by their weights.
inline double contact_coupling(const ContactParameters& contact, double stiffness_weight,
                               double damping_weight) {
  return stiffness_weight * contact.normal_stiffness + damping_weight * contact.normal_damping;
}

}  // namespace peclet::engine
