// How conservative laws and contacts couple the motions of a pair, in the form of a resistance.
#pragma once

#include "engine/kernels/pairs/pair_kind.h"
#include "engine/terms/contact.h"
#include "engine/terms/friction.h"
#include "engine/terms/rolling.h"

namespace peclet::engine {

// By what the parts are multiplied: resistances, stiffnesses along n, those of tangential and rolling
// springs.
struct CouplingWeights {
  double resistance, normal, tangential;
};

// The part of tangential and rolling springs that holds; the rest slides.
template <class Real>
struct HeldSprings {
  Real tangential, rolling;
};

// Adds the springs of friction where spheres touch, times `weight`.
template <class Real>
PECLET_ALWAYS_INLINE void add_springs(PairResistanceOf<Real>& sum, const Terms& terms,
                                      const ContactParameters& contact, const PairKind& kind,
                                      const PairGeometryOf<Real>& pair, double weight,
                                      const HeldSprings<Real>& part) {
  const double turning = rolling_coupling(contact.rolling_stiffness, kind.reduced_diameter);
  const Real sliding = contact.tangential_stiffness * part.tangential;
  const Real rolling = terms.rolling ? turning * part.rolling : Real{0.0};
  add_scaled(
      sum, select(pair.overlap() > 0.0, Real{weight}, Real{0.0}),
      tangential_coupling(contact_levers(kind.radius_first, kind.radius_second, pair), sliding, rolling));
}

// Adds to `sum`, which has the resistance of lubrication times its weight. The distance is the one that
// forces are evaluated at. `held()` is called where spheres touch and have friction.
template <class Real, class Held>
PECLET_ALWAYS_INLINE void add_stiffness(PairResistanceOf<Real>& sum, const Terms& terms,
                                        const ContactParameters& contact, const PairKind& kind,
                                        const PairGeometryOf<Real>& pair, const CouplingWeights& weights,
                                        Held&& held) {
  if (terms.conservative) {
    sum.squeeze += positive_stiffness(kind.conservative, pair, weights.normal);
  }
  const auto touching = pair.overlap() > 0.0;
  if (!terms.contact || !any(touching)) {
    return;
  }
  sum.squeeze +=
      select(touching, Real{contact_coupling(contact, weights.normal, weights.resistance)}, Real{0.0});
  if (terms.friction) add_springs(sum, terms, contact, kind, pair, weights.tangential, held());
}

}  // namespace peclet::engine
