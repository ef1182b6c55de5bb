// The compiled loops over pairs: their input and output, and one table of them for each instruction set.
//
// Plain data, because files that are compiled for one processor only include this header.
#pragma once

#include "engine/kernels/pair_recipes.h"
#include "engine/kernels/pair_terms.h"
#include "engine/state/pair_run.h"
#include "engine/state/vector3.h"
#include "engine/terms/laws.h"
#include "engine/terms/normal_block.h"

namespace peclet::engine {

// Sums over the pairs of one evaluation. `stress` is the sum of sym(r F_i), not divided by the volume.
struct PairSums {
  SymmetricTensor stress[count_of_stress_terms] = {};
  double contacts = 0;
  double overlaps = 0;         // sum over contacts of the overlap over the smaller radius
  double largest_overlap = 0;  // over the smaller radius
  bool finite = true;          // no separation was NaN or infinite

  SymmetricTensor& of(StressTerm term) { return stress[static_cast<std::size_t>(term)]; }
  const SymmetricTensor& of(StressTerm term) const { return stress[static_cast<std::size_t>(term)]; }
};

// Returns the stress of all terms together.
inline SymmetricTensor total_stress(const PairSums& sums) {
  SymmetricTensor total;
  for (const SymmetricTensor& term : sums.stress) total += term;
  return total;
}

// The non-uniform part of the flow at the centres of the particles: rows of velocity and spin, and of the
// rate of strain (xx, yy, zz and xy, xz, yz).
struct FlowRows {
  const double *velocity, *spin, *strain_along, *strain_across;
};

// The input for the pairs of all blocks, with rows of VectorFields.
struct PairKernelInput {
  const double *position, *velocity, *spin;
  const Pair* pairs;
  const double *image_displacement, *image_velocity;  // rows of each image
  const PairKind* kinds;
  PairParameters parameters;
  double* springs[6];  // components, see SpringField; advanced in place
  double* slides;      // for each pair, with kinetic friction

  NoiseKey noise;
  FillNormals fill_normals;
  const std::uint32_t* id;          // for each particle
  const std::uint64_t* image_keys;  // for each image
  const double* given_normals;      // six of each pair, instead of drawn ones; or null
  FlowRows varying;                 // null unless parameters.flow varies
};

// The output for the pairs of one block: rows of loads on its own particles, and for each crossing pair two
// rows (force and torque on its particle in the other block).
struct PairKernelOutput {
  std::uint32_t first_particle;
  double *force, *torque;
  double* crossing;
  PairSums* sums;  // two: of the pairs whose first particle lies in the block, and of the others
};

using PairKernel = void (*)(const PairKernelInput& input, const PairRun* runs, std::size_t count,
                            const PairKernelOutput& output);

// Kernels by the code of their terms (pair_recipes.h), null if these are not compiled.
struct PairKernelTable {
  PairKernel kernel[count_of_codes];
};

extern const PairKernelTable baseline_pair_kernels;  // one pair at a time; the reference for the others
extern const PairKernelTable avx2_pair_kernels;
extern const PairKernelTable avx512_pair_kernels;

}  // namespace peclet::engine
