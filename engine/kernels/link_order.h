// Orders the rows of a system of links into levels, such that no link couples two rows of a level.
//
// Each block of the list has its own rows. Rows of the interior, whose particles have listed neighbours in
// their own block only, come first and are eliminated block by block. Rows of the boundary are eliminated
// level by level, after the interior of all blocks. Levels are colours: each particle in turn gets the first
// colour that none of its listed neighbours has. Six to ten colours are enough for suspensions of any size.
// Particles keep their order within a level.
//
// Each crossing link has a place of its own, whether its pair is near or not, so that threads write links
// without waiting for each other.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/kernels/link_kernels.h"
#include "engine/state/neighbour_list.h"

namespace peclet::engine {

class LinkOrder {
 public:
  // Arranges the rows for the pairs of the list.
  void arrange(const NeighbourList& list, std::size_t particles, int threads = 1);

  LinkPlaces places() { return {row_.data(), level_.data(), levels_.data(), next_.data(), crossing_.data()}; }
  const std::vector<LinkBlock>& blocks() const { return blocks_; }
  const std::vector<LinkLevel>& levels() const { return levels_; }
  std::uint32_t boundary_levels() const { return boundary_levels_; }
  const std::vector<IncomingLink>& incoming() const { return incoming_; }
  const std::vector<std::uint32_t>& row() const { return row_; }      // for each particle
  std::uint32_t inner_groups() const { return inner_groups_; }        // room for links within blocks
  std::uint32_t crossing_groups() const { return crossing_groups_; }  // room for crossing links, after those

 private:
  using Colour = std::uint16_t;

  void find_boundary(const NeighbourList& list, std::size_t particles);
  Colour colour(std::span<const Pair> pairs, bool boundary, std::uint32_t begin, std::uint32_t end);
  void number_rows(const NeighbourList& list, const std::vector<Colour>& interior_levels, int threads);
  void number_rows(const LinkBlock& block);
  void make_room(const NeighbourList& list, int threads);
  void place_crossing_links(const NeighbourList& list);

  std::vector<std::uint8_t> in_boundary_;  // for each particle
  std::vector<Colour> colour_;             // within interior or boundary
  std::vector<std::uint32_t> row_, level_, next_;
  std::vector<LinkBlock> blocks_;
  std::vector<LinkLevel> levels_;
  std::uint32_t boundary_levels_ = 0, inner_groups_ = 0, crossing_groups_ = 0;
  std::vector<CrossingLink> crossing_;
  std::vector<IncomingLink> incoming_;
};

}  // namespace peclet::engine
