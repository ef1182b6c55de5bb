// Exponential repulsion of surfaces.
#pragma once

#include "engine/terms/pair.h"

namespace peclet::engine {

// F_i = -(A / kappa) exp(-h / kappa) n, of the potential A exp(-h / kappa), h the surface distance (it keeps
// growing in overlap). Li, Royer & Ness (2023) eq. 34, which prints the force on j.
inline Vector3 repulsion_force(double strength, double length, const PairGeometry& pair) {
  return (-(strength / length) * std::exp(-pair.surface_distance() / length)) * pair.normal;
}

}  // namespace peclet::engine
