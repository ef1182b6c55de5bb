// Conservative radial laws: energies V of the surface distance h.
//
// A law has parameters, which a scene gives, and of_pair() makes of them what is the same for all pairs of
// two radii: numbers and, where the law has several forms, which one. So a form is chosen once for a run of
// pairs, and kernels are compiled for any number of forms at once. What of_pair() returns has
//   range                 the centre distance beyond which there is none
//   energy(h)             V
//   slope(h)              V', for one pair or several; F_i = V' n
//   stiffness(h)          V'', likewise
//   largest_stiffness(h)  of |V''| from h >= 0 on
#pragma once

#include "engine/terms/laws.h"

namespace peclet::engine {

template <class Parameters>
using OfPair = decltype(of_pair(Parameters{}, 1.0, 1.0));

// Of the pairs of two radii. A law that the scene lacks has the range 0.
using ConservativeLaws = EachConservativeLaw<OfPair>;

// `laws` has an optional of each law's parameters.
template <class Optionals>
ConservativeLaws of_pair(const Optionals& laws, double radius_first, double radius_second) {
  ConservativeLaws result;
  for_each_conservative_law(
      [&](StressTerm /*part*/, const auto& law, auto& of_radii) {
        if (law) of_radii = of_pair(*law, radius_first, radius_second);
      },
      laws, result);
  return result;
}

// F_i = V' n.
template <class Law, class Real>
PECLET_ALWAYS_INLINE Vector3Of<Real> conservative_force(const Law& law, const PairGeometryOf<Real>& pair) {
  return law.slope(pair.surface_distance()) * pair.normal;
}

// weight V'' of all laws together, or zero where that is negative: for what has to stay positive
// semidefinite.
template <class Real>
PECLET_ALWAYS_INLINE Real positive_stiffness(const ConservativeLaws& laws, const PairGeometryOf<Real>& pair,
                                             double weight) {
  Real sum{0.0};
  for_each_conservative_law(
      [&](StressTerm /*part*/, const auto& law) PECLET_INLINE_LAMBDA {
        const auto within = pair.distance < law.range;
        if (law.range > 0 && any(within))
          sum += select(within, weight * law.stiffness(pair.surface_distance()), Real{0.0});
      },
      laws);
  return larger(sum, Real{0.0});
}

// V, V' and V'' of all laws together.
struct Potential {
  double energy = 0, slope = 0, stiffness = 0;
};
inline Potential potential(const ConservativeLaws& laws, double distance, double sum_of_radii) {
  Potential sum;
  for_each_conservative_law(
      [&](StressTerm /*part*/, const auto& law) {
        if (!(distance < law.range)) return;
        sum.energy += law.energy(distance - sum_of_radii);
        sum.slope += law.slope(distance - sum_of_radii);
        sum.stiffness += law.stiffness(distance - sum_of_radii);
      },
      laws);
  return sum;
}

// Of |V''| of all laws, at surface distances from `distance` - a_i - a_j >= 0 on.
inline double largest_stiffness(const ConservativeLaws& laws, double h, double sum_of_radii) {
  double sum = 0;
  for_each_conservative_law(
      [&](StressTerm /*part*/, const auto& law) {
        if (sum_of_radii + h < law.range) sum += law.largest_stiffness(h);
      },
      laws);
  return sum;
}

}  // namespace peclet::engine
