// What a pass over pairs adds up.
#pragma once

#include "engine/state/vector3.h"
#include "engine/terms/laws.h"

namespace peclet::engine {

// Sums over the pairs of one evaluation. stress is sum of sym(r F_i): divide by the volume for (1/V) sum r F.
struct PairSums {
  SymmetricTensor stress[count_of_stress_terms] = {};
  double contacts = 0;
  double overlaps = 0;         // of all contacts, over the smaller radius of the pair
  double largest_overlap = 0;  // of them
  bool finite = true;          // no separation was NaN or infinite

  SymmetricTensor& of(StressTerm term) { return stress[static_cast<std::size_t>(term)]; }
  const SymmetricTensor& of(StressTerm term) const { return stress[static_cast<std::size_t>(term)]; }
};

// The stress of all terms together.
inline SymmetricTensor total_stress(const PairSums& sums) {
  SymmetricTensor total;
  for (const SymmetricTensor& term : sums.stress) total += term;
  return total;
}

}  // namespace peclet::engine
