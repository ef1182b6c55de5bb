// The memory of a contact: a spring in the tangent plane that is turned, stretched and cut.
#pragma once

#include "engine/terms/pair.h"

namespace peclet::engine {

// How long a spring may be, and how long the one is that is left of a longer one.
template <class Real>
struct SpringLimitsOf {
  Real longest, left;
};

// The spring after a step in which its ends moved by `stretch` relative to each other:
//   1. turned into the present tangent plane, keeping its length (Luding 2008, eq. 18);
//   2. s <- s + stretch;
//   3. cut if it exceeds its limit: the stored spring itself, so that it never winds up (Monti et al. 2021
//      eq. 5).
// `stretch` must be tangential. A spring along n vanishes. `length` is that before the cut.
template <class Real>
PECLET_ALWAYS_INLINE Vector3Of<Real> advanced_spring(const Vector3Of<Real>& spring,
                                                     const Vector3Of<Real>& normal,
                                                     const Vector3Of<Real>& stretch,
                                                     const SpringLimitsOf<Real>& limits, Real& length) {
  Vector3Of<Real> turned = across(spring, normal);
  const Real before = norm(spring), after = norm(turned);
  // The division by zero of a vanishing spring is not selected.
  turned = select(after > 1e-14 * before, before / after, Real{0.0}) * turned;
  turned += stretch;
  length = norm(turned);
  return select(length > limits.longest, limits.left / length, Real{1.0}) * turned;
}
template <class Real>
PECLET_ALWAYS_INLINE Vector3Of<Real> advanced_spring(const Vector3Of<Real>& spring,
                                                     const Vector3Of<Real>& normal,
                                                     const Vector3Of<Real>& stretch, const Real& longest) {
  Real length;
  return advanced_spring(spring, normal, stretch, {longest, longest}, length);
}

// The part of a spring's stretch that is left when it has been cut: the secant stiffness of a spring that
// slides is that part of its stiffness.
template <class Real>
PECLET_ALWAYS_INLINE Real held_share(const Vector3Of<Real>& spring, const Vector3Of<Real>& normal,
                                     const Vector3Of<Real>& stretch, const SpringLimitsOf<Real>& limits) {
  const Real unlimited{1e300};
  const Real length = norm(advanced_spring(spring, normal, stretch, unlimited));
  return select(length > limits.longest, limits.left / length, Real{1.0});
}

// Whether a spring is shorter than Coulomb's limit, the largest force that it can have.
inline bool sticks(double stiffness, const Vector3& spring, double limit) {
  return stiffness * norm(spring) < limit * (1 - 1e-9);
}

// k s^2 / 2.
inline double spring_energy(double stiffness, const Vector3& spring) {
  return 0.5 * stiffness * dot(spring, spring);
}

}  // namespace peclet::engine
