// A mean over the production window and over its blocks.
//
// Values are sums over weights. A number keeps its 32 blocks, lists of up to 64 elements the four quarters of
// the window (which is what the test for transients compares), longer ones the window alone.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "contract/json.h"
#include "engine/state/archive.h"

namespace peclet::engine {

constexpr std::size_t count_of_blocks = 32;
constexpr std::size_t count_of_quarters = 4;
constexpr std::size_t most_elements_with_blocks = 64;

// Returns the number of blocks that a mean of this shape keeps.
inline std::size_t blocks_kept(const std::vector<std::size_t>& shape) {
  if (shape.empty()) return count_of_blocks;
  return shape.back() > most_elements_with_blocks ? 0 : count_of_quarters;
}

// Rounds every number to five significant digits: far below the scatter of a block, and less than half the
// room of all seventeen. Anything else than a number stays as it is.
Json rounded(const Json& number);

class BlockedMean {
 public:
  // A number (no shape), or lists within lists of these lengths, the first one outermost.
  explicit BlockedMean(const std::vector<std::size_t>& shape = {}) : BlockedMean(shape, blocks_kept(shape)) {}
  // The window is divided into `kept` equal blocks, at most 32.
  BlockedMean(const std::vector<std::size_t>& shape, std::size_t kept);

  // Adds to the sum of an element, counted through all lists. `block` counts from 0 to 31.
  void add(std::size_t block, std::size_t element, double value);
  // Every element's sum is divided by the sum of these weights.
  void weigh(std::size_t block, double weight);

  // Returns the mean over the window; null in the place of a number, or of an innermost list, without weight.
  Json value() const;
  // Returns a list with the mean of each block in five digits; null where none are kept.
  Json blocks() const;

  void save(ArchiveWriter& archive) const { archive.put_all(sums_, blocks_, weight_, block_weights_); }
  void load(ArchiveReader& archive) { archive.get_all(sums_, blocks_, weight_, block_weights_); }

 private:
  Json means(std::span<const double> sums, double weight, std::size_t axis = 0) const;

  std::vector<std::size_t> shape_;
  std::size_t kept_;
  std::vector<double> sums_;    // of the window
  std::vector<double> blocks_;  // a row of sums for each block
  double weight_ = 0;
  std::vector<double> block_weights_;
};

}  // namespace peclet::engine
