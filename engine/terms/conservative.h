// Conservative radial laws are energies V of the surface distance h.
//
// A scene gives the parameters of a law. of_pair() turns them into what all pairs of two radii share: numbers
// and, if the law has several forms, its form. So the form is chosen once for a run of pairs, and a kernel
// serves any number of forms. The result of of_pair() has
//   range                 the centre distance beyond which there is no force
//   energy(h)             V
//   slope(h)              V', for one pair or several; F_i = V' n
//   stiffness(h)          V'', for one pair or several
//   largest_stiffness(h)  the largest |V''| from h >= 0 on
#pragma once

#include "engine/terms/laws.h"

namespace peclet::engine {

template <class Parameters>
using OfPair = decltype(of_pair(Parameters{}, 1.0, 1.0));

// ConservativeLaws holds every law of two radii. A law that the scene lacks has the range 0.
using ConservativeLaws = EachConservativeLaw<OfPair>;

// Returns the laws of two radii. `laws` has an optional of the parameters of each law.
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

// Returns F_i = V' n.
template <class Law, class Real>
PECLET_ALWAYS_INLINE Vector3Of<Real> conservative_force(const Law& law, const PairGeometryOf<Real>& pair) {
  return law.slope(pair.surface_distance()) * pair.normal;
}

// Returns weight V'' of all laws together, or zero if that is negative: matrices stay positive semidefinite.
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

// Potential is V, V' and V'' of all laws together.
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

// Returns the sum of the largest |V''| of each law at surface distances from h >= 0 on.
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
