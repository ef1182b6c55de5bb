// Pairs of a neighbour list as the loop over pairs takes them.
#pragma once

#include <cstdint>

#include "engine/state/periodic_cell.h"

namespace peclet::engine {

struct Pair {
  std::uint32_t first, second;  // places in memory; the id of `first` is the smaller one
  std::uint16_t image;          // index into NeighbourList::images(): the shift of `second`
  std::uint16_t kind;           // size_class(first) * classes + size_class(second)
};

// A pair before the list is arranged.
struct FoundPair {
  enum class Away : std::uint8_t { none, second, first };  // the particle that lies in an earlier block
  std::uint32_t first, second, block;
  LatticeShift image;
  std::uint16_t kind;
  Away away;
};

constexpr std::uint32_t within_block = 0xffffffff;

// Consecutive pairs of one block and one kind.
struct PairRun {
  std::uint32_t begin, end;  // pairs
  std::uint32_t crossing;    // number of the first pair among the crossing ones, or within_block
  std::uint16_t kind;
  bool imaged;         // some image is not the particle itself
  bool first_is_away;  // of crossing pairs: the first particle lies in the other block, not the second one
};

}  // namespace peclet::engine
