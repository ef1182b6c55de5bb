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
inline Vector3 advanced_spring(const Vector3& spring, const Vector3& normal, const Vector3& stretch,
                               double longest) {
  Vector3 turned = across(spring, normal);
  const double before = norm(spring), after = norm(turned);
  turned = (after > 1e-14 * before ? before / after : 0.0) * turned;
  turned += stretch;
  const double length = norm(turned);
  return length > longest ? (longest / length) * turned : turned;
}

}  // namespace peclet::engine
