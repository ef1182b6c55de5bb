// Repulsion of surfaces.
#pragma once

#include "engine/terms/pair.h"

namespace peclet::engine {

struct RepulsionParameters {
  double strength = 0;  // A, an energy
  double relative_length = 0.01;
  double cutoff_lengths = 20;
};

// Exponential repulsion of two radii, by the surface distance h:
//   V = A exp(-h / kappa),  F_i = V' n = -(A / kappa) exp(-h / kappa) n,  kappa = relative_length (a_i +
//   a_j),
// for h < cutoff_lengths kappa. Li, Royer & Ness (2023) eq. 34, which prints the force on j. It keeps growing
// in overlap.
struct RepulsionOfPair {
  double range = 0;  // centre distance beyond which there is none
  double energy_at_contact = 0, slope_at_contact = 0, stiffness_at_contact = 0;
  double decay = 0;  // 1 / kappa

  double energy(double h) const { return energy_at_contact * exponential(-decay * h); }
  // V'
  template <class Real>
  PECLET_ALWAYS_INLINE Real slope(const Real& h) const {
    return slope_at_contact * exponential(-decay * h);
  }
  // V''
  template <class Real>
  PECLET_ALWAYS_INLINE Real stiffness(const Real& h) const {
    return stiffness_at_contact * exponential(-decay * h);
  }
  // Of |V''| at surface distances from h >= 0 on.
  double largest_stiffness(double h) const { return stiffness(h); }
};

inline RepulsionOfPair of_pair(const RepulsionParameters& repulsion, double radius_first,
                               double radius_second) {
  const double sum = radius_first + radius_second, length = repulsion.relative_length * sum;
  return {.range = sum + repulsion.cutoff_lengths * length,
          .energy_at_contact = repulsion.strength,
          .slope_at_contact = -(repulsion.strength / length),
          .stiffness_at_contact = repulsion.strength / (length * length),
          .decay = 1 / length};
}

}  // namespace peclet::engine
