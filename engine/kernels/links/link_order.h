// The order of the rows of a system of links: by levels, so that no pair of the list couples two rows of one
// level. Levels are colours, given one particle after the other: the first that no listed neighbour has. Some
// six to ten serve any suspension, whatever its size.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/kernels/links/link_kernels.h"
#include "engine/state/neighbour_list.h"

namespace peclet::engine {

class LinkOrder {
 public:
  // Of all pairs of the list. Particles keep their order within a level.
  void arrange(const NeighbourList& list, std::size_t particles);

  LinkPlaces places() { return {row_.data(), level_.data(), levels_.data(), levels_.size(), next_.data()}; }
  const std::vector<LinkLevel>& levels() const { return levels_; }
  const std::vector<std::uint32_t>& particle() const { return particle_; }  // of each row
  const std::vector<std::uint32_t>& row() const { return row_; }            // of each particle
  std::size_t most_groups() const { return most_groups_; }

 private:
  std::vector<std::uint16_t> colours(const std::vector<Pair>& pairs, std::size_t particles);

  std::vector<std::uint32_t> row_, particle_, next_;
  std::vector<std::uint16_t> level_;  // of each row
  std::vector<LinkLevel> levels_;
  std::size_t most_groups_ = 0;
  std::vector<std::uint32_t> begin_, earlier_;  // of each particle, its neighbours earlier in memory
};

}  // namespace peclet::engine
