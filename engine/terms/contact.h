// Normal contact of overlapping spheres is a linear spring with optional damping. ContactOf is what the laws
// of springs across the normal (spring_laws.h) see of a contact.
//
// Levers reach the middle of the overlap delta: l_i = a_i - delta/2, l_j = a_j - delta/2, l_i + l_j = r.
// Torques of a pair then balance exactly, and a rigid rotation is no slip. (The published levers a_i, a_j do
// neither.)
#pragma once

#include <limits>

#include "engine/terms/pair.h"

namespace peclet::engine {

// Stiffnesses [force/length], dampings [force/velocity], loads [force], coefficients [1].
struct ContactParameters {
  double normal_stiffness = 0;
  double normal_damping = 0;
  double friction = 0;                                                // coefficient of contacts that stick
  double kinetic_friction = std::numeric_limits<double>::infinity();  // coefficient while they slide
  double critical_load = 0;  // F_CL: below this normal force there is no friction
  double largest_load = std::numeric_limits<double>::infinity();  // F_max: the largest load of friction
  double tangential_stiffness = 0;
  double tangential_damping = 0;
  double rolling_stiffness = 0;
  double rolling_friction = 0;
};

// Returns true if friction is less while contacts slide, so that they must remember whether they do.
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

// ContactOf is a pair as the laws of springs see it.
template <class Real>
struct ContactOf {
  const ContactParameters& parameters;
  const PairGeometryOf<Real>& pair;
  ContactLeversOf<Real> lever;
  double reduced_diameter;  // a = 2 a_i a_j / (a_i + a_j)
};

// Returns the size of the normal force, k_n delta with the overlap delta = a_i + a_j - r.
template <class Real>
PECLET_ALWAYS_INLINE Real contact_push(double normal_stiffness, const Real& overlap) {
  return normal_stiffness * overlap;
}

// Returns the load of friction, min(max(k_n delta - F_CL, 0), F_max). F_CL alone is the critical load model:
// contacts have no friction until a repulsion is overcome (Seto, Mari, Morris & Denn, Phys. Rev. Lett. 111,
// 218301 (2013)).
template <class Real>
PECLET_ALWAYS_INLINE Real frictional_load(const ContactParameters& contact, const Real& overlap) {
  const Real excess = contact_push(contact.normal_stiffness, overlap) - Real{contact.critical_load};
  const Real load = larger(excess, Real{0.0}), largest{contact.largest_load};
  return select(load > largest, largest, load);
}

// Returns F_i = -k_n delta n for delta > 0; the energy is k_n delta^2 / 2. Li, Royer & Ness (2023) eq. 3
// prints the force on j; the sign is that of Monti et al. (2021) eq. 4a.
template <class Real>
PECLET_ALWAYS_INLINE Vector3Of<Real> contact_normal_force(double normal_stiffness,
                                                          const PairGeometryOf<Real>& pair) {
  return -contact_push(normal_stiffness, pair.overlap()) * pair.normal;
}
inline double contact_energy(double normal_stiffness, double overlap) {
  return overlap > 0 ? 0.5 * contact_push(normal_stiffness, overlap) * overlap : 0;
}

// Returns F_i = gamma_n n n.(U_j - U_i). Monti et al. (2021) eq. 4a.
template <class Real>
PECLET_ALWAYS_INLINE Vector3Of<Real> contact_damping_force(double normal_damping,
                                                           const PairGeometryOf<Real>& pair,
                                                           const PairMotionOf<Real>& motion) {
  return (normal_damping * dot(motion.velocity, pair.normal)) * pair.normal;
}

// CouplingWeights are factors of resistances, of stiffnesses along n, and of springs across n.
struct CouplingWeights {
  double resistance = 0, normal = 0, tangential = 0;
};

// Returns the coupling of the normal velocities by a contact: weighted stiffness plus weighted damping.
inline double contact_coupling(const ContactParameters& contact, double stiffness_weight,
                               double damping_weight) {
  return stiffness_weight * contact.normal_stiffness + damping_weight * contact.normal_damping;
}

}  // namespace peclet::engine
