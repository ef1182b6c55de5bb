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

}  // namespace peclet::engine
