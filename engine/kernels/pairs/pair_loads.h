// Where the loads of pairs go: into the rows of their particles.
//
// Included by files that are compiled for one instruction set.
#pragma once

#include "engine/kernels/lanes/rows.h"
#include "engine/kernels/pairs/pair_kernels.h"
#include "engine/terms/pair.h"

namespace peclet::engine {

// NOLINTNEXTLINE(readability-non-const-parameter): who receives the row writes to it
PECLET_ALWAYS_INLINE Row& row_of(double* rows, std::size_t number) {
  return *reinterpret_cast<Row*>(rows + 4 * number);
}

// Adds the loads of the pairs [begin, begin + count) of a run to the rows of the particles, pair after pair;
// what acts on particles of other blocks goes to the rows of crossing pairs. `mirrored`: the first particles
// are away.
template <bool mirrored, class Real>
PECLET_ALWAYS_INLINE void leave_load(const PairLoadOf<Real>& load, const PairRun& run, std::uint32_t begin,
                                     int count, const std::uint32_t* first, const std::uint32_t* second,
                                     const PairKernelOutput& out) {
  const RowsOf<Real> force = scattered(load.force), torque_first = scattered(load.torque_first),
                     torque_second = scattered(load.torque_second);
  for (int k = 0; k < width_of<Real>; ++k) {
    if (k == count) {
      break;
    }
    if constexpr (mirrored) {
      const std::size_t j = second[k] - out.first_particle;
      row_of(out.force, j) -= force.row[k];
      row_of(out.torque, j) += torque_second.row[k];
      const std::size_t c = run.crossing + (begin - run.begin) + static_cast<std::uint32_t>(k);
      row_of(out.crossing, 2 * c) = force.row[k];
      row_of(out.crossing, 2 * c + 1) = torque_first.row[k];
      continue;
    }
    const std::size_t i = first[k] - out.first_particle;
    row_of(out.force, i) += force.row[k];
    row_of(out.torque, i) += torque_first.row[k];
    if (run.crossing == within_block) {
      const std::size_t j = second[k] - out.first_particle;
      row_of(out.force, j) -= force.row[k];
      row_of(out.torque, j) += torque_second.row[k];
    } else {
      const std::size_t c = run.crossing + (begin - run.begin) + static_cast<std::uint32_t>(k);
      row_of(out.crossing, 2 * c) = -force.row[k];
      row_of(out.crossing, 2 * c + 1) = torque_second.row[k];
    }
  }
}

}  // namespace peclet::engine
