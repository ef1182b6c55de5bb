// Exponential repulsion of surfaces.
#pragma once

#include "engine/terms/pair.h"

namespace peclet::engine {

// F_i = -(A / kappa) exp(-h / kappa) n, of the potential A exp(-h / kappa), h the surface distance (it keeps
// growing in overlap). Li, Royer & Ness (2023) eq. 34, which prints the force on j.
template <class Real>
PECLET_ALWAYS_INLINE Vector3Of<Real> repulsion_force(double strength, double length,
                                                     const PairGeometryOf<Real>& pair) {
  return (-(strength / length) * exponential((-1 / length) * pair.surface_distance())) * pair.normal;
}

}  // namespace peclet::engine
