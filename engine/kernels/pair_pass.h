// One evaluation of all pair terms: forces and torques on particles, stress by term.
//
// The loop over pairs writes one load per pair; the loop over particles adds the loads of each particle's
// pairs in the order of the list. Sums over pairs are taken in fixed chunks. So the result has the same bits
// for any number of threads, and no two threads ever write to one place.
#pragma once

#include <array>

#include "engine/kernels/pair_access.h"
#include "engine/kernels/pair_terms.h"

namespace peclet::engine {

// Sums over the pairs of one evaluation. stress is sum of sym(r F_i): divide by the volume for (1/V) sum r F.
struct PairSums {
  std::array<SymmetricTensor, count_of_stress_terms> stress{};
  std::uint64_t contacts = 0;
  double largest_overlap = 0;  // over the smaller radius of the pair
  bool finite = true;          // no separation was NaN or infinite

  PairSums& operator+=(const PairSums& other);
};

struct PairPassInput {
  const ParticleState& particles;
  const NeighbourList& list;
  const ShearedBox& box;
  const std::vector<PairKind>& kinds;
  PairParameters parameters;
  KeyedRandom random;  // of pair noise
  std::uint64_t step;  // keys the noise
  int threads;
};

// Storage that is kept from step to step.
struct PairPassWork {
  std::vector<PairLoad> loads;  // of each pair of the list
  std::vector<PairSums> chunks;
  std::vector<ImageFrame> frames;
};

// Sets force and torque to the sums over pairs (they are overwritten) and returns the sums of the stress.
// `springs` are those of each pair of the list; they advance with the motion. Without friction they are not
// touched.
using PairPass = PairSums (*)(const PairPassInput& input, PairPassWork& work,
                              std::vector<ContactSprings>& springs, VectorField& force, VectorField& torque);

// The compiled pass for these terms. Every valid combination has one.
PairPass pair_pass(const Terms& terms);

}  // namespace peclet::engine
