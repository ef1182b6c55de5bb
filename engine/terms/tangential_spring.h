// The memory of a contact: a spring in the tangent plane that is turned, stretched and cut.
#pragma once

#include "engine/terms/pair.h"

namespace peclet::engine {

// The spring after a step in which its ends moved by `stretch` relative to each other:
//   1. turned into the present tangent plane, keeping its length (Luding 2008, eq. 18);
//   2. s <- s + stretch;
//   3. shortened to `longest` if it exceeds that: the stored spring itself is cut, so that it never winds up
//      (Monti et al. 2021 eq. 5).
// `stretch` must be tangential. A spring along n vanishes.
template <class Real>
PECLET_ALWAYS_INLINE Vector3Of<Real> advanced_spring(const Vector3Of<Real>& spring,
                                                     const Vector3Of<Real>& normal,
                                                     const Vector3Of<Real>& stretch, const Real& longest) {
  Vector3Of<Real> turned = across(spring, normal);
  const Real before = norm(spring), after = norm(turned);
  // The division by zero of a vanishing spring is not selected.
  turned = select(after > 1e-14 * before, before / after, Real{0.0}) * turned;
  turned += stretch;
  const Real length = norm(turned);
  return select(length > longest, longest / length, Real{1.0}) * turned;
}

// The part of a spring's stretch that is left when it has been cut to `longest`: the secant stiffness of a
// spring that slides is that part of its stiffness.
template <class Real>
PECLET_ALWAYS_INLINE Real held_share(const Vector3Of<Real>& spring, const Vector3Of<Real>& normal,
                                     const Vector3Of<Real>& stretch, const Real& longest) {
  const Real unlimited{1e300};
  const Real length = norm(advanced_spring(spring, normal, stretch, unlimited));
  return select(length > longest, longest / length, Real{1.0});
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
