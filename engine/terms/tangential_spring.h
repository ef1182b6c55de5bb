// advanced_spring() turns, stretches and cuts a spring in the tangent plane: the memory of a contact.
#pragma once

#include "engine/terms/pair.h"

namespace peclet::engine {

// The largest length of a spring, and the length to which a longer one is cut.
template <class Real>
struct SpringLimitsOf {
  Real longest, left;
};

// Returns the spring s after a step in which its ends moved by `stretch` relative to each other:
//   1. it is turned into the present tangent plane and keeps its length (Luding 2008, eq. 18);
//   2. s <- s + stretch;
//   3. it is cut if it exceeds its limit, so that it never winds up (Monti et al. 2021 eq. 5).
// Requires a tangential `stretch`. A spring along n vanishes. Sets `length` to that before the cut.
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

// Returns the part of a spring that the cut leaves: the secant stiffness of a sliding spring over its
// stiffness.
template <class Real>
PECLET_ALWAYS_INLINE Real held_share(const Vector3Of<Real>& spring, const Vector3Of<Real>& normal,
                                     const Vector3Of<Real>& stretch, const SpringLimitsOf<Real>& limits) {
  const Real unlimited{1e300};
  const Real length = norm(advanced_spring(spring, normal, stretch, unlimited));
  return select(length > limits.longest, limits.left / length, Real{1.0});
}

// Returns true if the force of a spring is below Coulomb's limit, up to rounding.
inline bool sticks(double stiffness, const Vector3& spring, double limit) {
  return stiffness * norm(spring) < limit * (1 - 1e-9);
}

// Returns k s^2 / 2.
inline double spring_energy(double stiffness, const Vector3& spring) {
  return 0.5 * stiffness * dot(spring, spring);
}

}  // namespace peclet::engine
