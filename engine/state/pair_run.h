// The pairs of a neighbour list in the form that the loop over pairs takes.
#pragma once

#include <cstdint>

#include "engine/state/periodic_cell.h"

namespace peclet::engine {

struct Pair {
  std::uint32_t first, second;  // indices in memory; the id of `first` is the smaller one
  std::uint16_t image;          // index into NeighbourList::images(): the shift of `second`
  std::uint16_t kind;           // size_class(first) * classes + size_class(second)
};

// A pair as it is found, before the list is arranged.
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
  bool imaged;         // the pairs have images other than zero
  bool first_is_away;  // for crossing pairs: the first particle lies in the other block, not the second one
};

}  // namespace peclet::engine
