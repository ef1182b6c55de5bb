// How a neighbour list is found and arranged; part of neighbour_list.cpp.
//
// Every size class has a grid of its own, with cells as wide as the reach of two of its spheres; of more than
// four classes those share a grid, a band, whose ranges are within a factor of 1.3. A particle looks into the
// grids of its own band and of larger ones: small spheres never pay for the reach of large ones, and large
// ones never walk through the fine grids of small ones.
#pragma once

#include <atomic>
#include <optional>

#include "engine/state/cell_grid.h"
#include "engine/state/neighbour_list.h"

namespace peclet::engine {

class ListBuilder {
 public:
  // At the list's moment: blocks, and pairs of the particles, are those of the list.
  ListBuilder(NeighbourList& list, const ParticleState& particles, const PeriodicCell& box, int threads)
      : list_(list), particles_(particles), box_(box), threads_(threads) {}

  // The pairs of each block that at these places are closer than their reach with this skin.
  std::vector<std::vector<FoundPair>> find(const VectorField& position, double skin);
  // Those of the candidates that are closer than their reach at the list's places.
  std::vector<std::vector<FoundPair>> near_ones(const std::vector<std::vector<FoundPair>>& candidates) const;
  void arrange(const std::vector<std::vector<FoundPair>>& found);

 private:
  using Found = FoundPair;
  using Away = FoundPair::Away;

  void search(std::size_t block);
  void search_near(std::uint32_t particle, std::vector<Found>& found);
  void set_bands();
  void set_grids(const VectorField& position);
  Found make(std::uint32_t i, std::uint32_t j, LatticeShift image) const;
  void deliver_strays();
  void number_images(const std::vector<std::vector<Found>>& found);
  void arrange(std::size_t block, const std::vector<Found>& found);
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
  double skin_ = 0;
  LatticePlaces places_;
  std::vector<std::size_t> band_of_;  // of each class
  std::vector<double> reach_,
      widest_reach_;  // of a class with larger ones, and with the larger ones of a band
  std::vector<std::optional<CellGrid>> grids_;  // of each band; none without members
  std::vector<std::vector<Found>> found_;       // of each block
  std::vector<std::vector<PairRun>> runs_;
  std::atomic<bool> meets_itself_ = false;  // exceptions must not leave a thread of the loop
};

}  // namespace peclet::engine
