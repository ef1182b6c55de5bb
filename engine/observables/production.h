// Adds up stress, motion and contacts over the production window, in 32 consecutive blocks.
#pragma once

#include <array>
#include <span>

#include "engine/kernels/pair_pass.h"
#include "engine/observables/accumulators.h"
#include "engine/observables/structure.h"
#include "engine/state/archive.h"

namespace peclet::engine {

struct BlockSums {
  std::uint64_t planned = 0;  // steps of the complete block
  std::uint64_t steps = 0;    // every step adds to the stress: thinning would destroy the Brownian part
  std::array<SymmetricTensor, count_of_stress_terms> stress{};  // sum over pairs of sym(r F)
  SymmetricTensor motion{};                                     // -sum m sym(v v), relative to the flow
  double shear_rate = 0;                                        // rate of the cell, x along y
  double contacts = 0;
  double overlaps = 0;        // sum over contacts of the overlap over the smaller radius
  std::uint64_t samples = 0;  // number of samples of the members below
  SymmetricTensor structural_brownian{};
  SymmetricTensor varying_stresslet{};
  KineticTemperatures temperature{};

  BlockSums& operator+=(const BlockSums& block);
  // Returns the mean over contacts, or 0 without contacts.
  double mean_overlap() const { return contacts > 0 ? overlaps / contacts : 0; }
};

inline BlockSums sum_of(std::span<const BlockSums> blocks) {
  BlockSums all;
  for (const BlockSums& block : blocks) all += block;
  return all;
}

class Production {
 public:
  // `steps` is the length of the window, at least one for each block.
  explicit Production(std::uint64_t steps);

  // `index` counts the steps of the window from 0.
  void add_step(std::uint64_t index, const PairSums& sums, const SymmetricTensor& motion, double shear_rate) {
    block_of(index) += {.steps = 1,
                        .stress = std::to_array(sums.stress),
                        .motion = motion,
                        .shear_rate = shear_rate,
                        .contacts = sums.contacts,
                        .overlaps = sums.overlaps};
  }
  void add_sample(std::uint64_t index, const SymmetricTensor& structural_brownian,
                  const SymmetricTensor& varying_stresslet, const KineticTemperatures& temperature) {
    block_of(index) += {.samples = 1,
                        .structural_brownian = structural_brownian,
                        .varying_stresslet = varying_stresslet,
                        .temperature = temperature};
  }

  const std::array<BlockSums, count_of_blocks>& blocks() const { return blocks_; }
  void set_blocks(const std::array<BlockSums, count_of_blocks>& blocks) { blocks_ = blocks; }
  // Returns the block that a step of the window belongs to.
  std::size_t block_at(std::uint64_t index) const {
    return static_cast<std::size_t>(index * count_of_blocks / steps_);
  }

  void save(ArchiveWriter& archive) const { archive.put(blocks_); }
  void load(ArchiveReader& archive) { blocks_ = archive.get<std::array<BlockSums, count_of_blocks>>(); }

 private:
  BlockSums& block_of(std::uint64_t index) { return blocks_[block_at(index)]; }

  std::uint64_t steps_;
  std::array<BlockSums, count_of_blocks> blocks_{};
};

// Returns the number of entries of a series per independent value: 1 + 2 sum of its autocorrelation up to the
// first value that is not positive. It is at least 1, and 1 for a series that is constant up to rounding.
double statistical_inefficiency(const std::vector<double>& series);

}  // namespace peclet::engine
