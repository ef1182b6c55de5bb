// How a neighbour list is found and arranged; part of neighbour_list.cpp.
//
// Every size class has a grid of its own, with cells as wide as the reach of two of its spheres. A particle
// looks into the grids of its own class and of larger ones: small spheres never pay for the reach of large
// ones, and large ones never walk through the fine grids of small ones.
#pragma once

#include <atomic>
#include <optional>

#include "engine/state/cell_grid.h"
#include "engine/state/neighbour_list.h"

namespace peclet::engine {

class ListBuilder {
 public:
  ListBuilder(NeighbourList& list, const ParticleState& particles, const PeriodicCell& box, int threads);

  void run();

 private:
  // A pair before the list is arranged.
  enum class Away : std::uint8_t { none, second, first };  // the particle that lies in an earlier block
  struct Found {
    std::uint32_t first, second, block;
    LatticeShift image;
    std::uint16_t kind;
    Away away;
  };

  void search(std::size_t block);
  void search_near(std::uint32_t particle, std::vector<Found>& found);
  Found make(std::uint32_t i, std::uint32_t j, LatticeShift image) const;
  void deliver_strays();
  void number_images();
  void arrange(std::size_t block);
  void collect_incoming();

  std::size_t bucket(const Found& pair) const {
    const std::size_t kinds = list_.ranges_.classes() * list_.ranges_.classes();
    return (static_cast<std::size_t>(pair.away) * kinds + pair.kind) * 2 +
           (pair.image == LatticeShift{} ? 0 : 1);
  }
  std::uint32_t block_of(std::uint32_t particle) const;
  std::uint16_t image_number(LatticeShift image) const;

  NeighbourList& list_;
  const ParticleState& particles_;
  const PeriodicCell& box_;
  int threads_;
  LatticePlaces places_;
  std::vector<std::optional<CellGrid>> grids_;  // of each class; none without members
  std::vector<std::vector<Found>> found_;       // of each block
  std::vector<std::vector<PairRun>> runs_;
  std::atomic<bool> meets_itself_ = false;  // exceptions must not leave a thread of the loop
};

}  // namespace peclet::engine
