// A mean over the production window and over its blocks.
//
// Values are sums over weights. A scalar keeps its 32 blocks, a list of up to 64 elements the four quarters
// of the window (which is what a look for transients compares), a longer one the window alone.
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

// Blocks that a list of so many elements keeps; a number has all 32.
constexpr std::size_t blocks_kept(std::size_t elements) {
  if (elements > most_elements_with_blocks) return 0;
  return count_of_quarters;
}

// Five significant digits: far below the scatter of a block, and less than half the room of all seventeen.
// Anything else than a number stays as it is.
Json rounded(const Json& number);

class BlockedMean {
 public:
  // Of a number, or of a list.
  BlockedMean() : BlockedMean(1, count_of_blocks, false) {}
  explicit BlockedMean(std::size_t elements) : BlockedMean(elements, blocks_kept(elements), true) {}
  // The mean of a number whose window is divided into this many equal blocks, fewer than 32.
  static BlockedMean number_with_blocks(std::size_t blocks) { return {1, blocks, false}; }

  // `block` counts from 0 to 31.
  void add(std::size_t block, std::size_t element, double value);
  // Every element's sum is divided by the sum of these.
  void weigh(std::size_t block, double weight);

  // Over the window: a number or a list; null where nothing was weighed.
  Json value() const;
  // A list with the same for each block in five digits; null where none are kept.
  Json blocks() const;

  void save(ArchiveWriter& archive) const;
  void load(ArchiveReader& archive);

 private:
  BlockedMean(std::size_t elements, std::size_t kept, bool is_list);
  Json ratio(std::span<const double> sums, double weight) const;

  bool is_list_;
  std::size_t kept_;
  std::vector<double> sums_;    // of the window
  std::vector<double> blocks_;  // rows of as many
  double weight_ = 0;
  std::vector<double> block_weights_;
};

// Of several lists: a list of their values; and for each block a list of theirs. Requires that blocks are
// kept.
Json values_of(std::span<const BlockedMean> means);
Json blocks_of(std::span<const BlockedMean> means);

// The bin of a periodic box, of which there are `count`, that bin `k` of the plane is.
inline std::size_t periodic_bin(std::int64_t k, std::size_t count) {
  const auto bins = static_cast<std::int64_t>(count);
  return static_cast<std::size_t>((k % bins + bins) % bins);
}

}  // namespace peclet::engine
