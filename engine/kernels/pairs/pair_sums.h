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

// Of all terms but the noise, whose stress has mean zero and belongs to no total.
inline SymmetricTensor stress_of_forces(const PairSums& sums) {
  SymmetricTensor sum;
  for (std::size_t t = 0; t < count_of_stress_terms; ++t) {
    if (static_cast<StressTerm>(t) != StressTerm::brownian_lubrication) sum += sums.stress[t];
  }
  return sum;
}

}  // namespace peclet::engine
