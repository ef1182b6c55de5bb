// The sums of a pass over pairs while it runs, lane by lane.
//
// Included by files that are compiled for one instruction set.
#pragma once

#include "engine/kernels/lanes/single_access.h"
#include "engine/kernels/pairs/pair_kind.h"
#include "engine/kernels/pairs/pair_sums.h"

namespace peclet::engine {

// Pairs are added in the order of the list.
template <class Real>
struct LaneSumsOf {
  SymmetricTensorOf<Real> stress[count_of_stress_terms];
  Real overlaps{}, largest_overlap{};
  std::uint64_t contacts = 0;
  unsigned not_finite = 0;

  PECLET_ALWAYS_INLINE void add_stress(StressTerm term, const PairGeometryOf<Real>& pair,
                                       const Vector3Of<Real>& force) {
    stress[static_cast<std::size_t>(term)] += symmetric_dyad(pair.separation, force);
  }

  // Counts the pairs that overlap. Returns whether any does.
  PECLET_ALWAYS_INLINE bool count_contacts(const PairKind& kind, const Real& overlap) {
    const unsigned touching = bits(overlap > Real{});
    if (touching == 0) return false;
    contacts += static_cast<std::uint64_t>(__builtin_popcount(touching));
    const Real relative = (1 / kind.smaller_radius) * overlap;
    overlaps += larger(Real{}, relative);
    largest_overlap = larger(largest_overlap, relative);
    return true;
  }

  // Sets `total` to the sums over all lanes.
  PECLET_ALWAYS_INLINE void store(PairSums& total) const {
    for (std::size_t t = 0; t < count_of_stress_terms; ++t) {
      const SymmetricTensorOf<Real>& s = stress[t];
      total.stress[t] = {sum_of_lanes(s.xx), sum_of_lanes(s.yy), sum_of_lanes(s.zz),
                         sum_of_lanes(s.xy), sum_of_lanes(s.xz), sum_of_lanes(s.yz)};
    }
    total.contacts = static_cast<double>(contacts);
    total.overlaps = sum_of_lanes(overlaps);
    total.largest_overlap = largest_lane(largest_overlap);
    total.finite = not_finite == 0;
  }
};

}  // namespace peclet::engine
