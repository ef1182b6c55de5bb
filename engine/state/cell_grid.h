// Cells along the lattice vectors of a sheared box, for finding what is near.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/state/sheared_box.h"

namespace peclet::engine {

class CellGrid {
 public:
  struct Neighbour {
    std::uint32_t particle;
    LatticeShift image;  // added to the particle's position as given
    friend auto operator<=>(const Neighbour&, const Neighbour&) = default;
  };

  // Cells at least `range` wide, or as many layers of neighbours as it takes where the box is smaller than
  // that.
  CellGrid(const VectorField& position, const ShearedBox& box, double range);

  // Calls visit(Neighbour) for every particle, in every image, whose cell is within reach of `particle`'s,
  // itself in the cell where it stands excepted. Nothing closer than `range` is missed; the caller measures
  // the distance.
  template <class Visit>
  void visit_neighbours(std::uint32_t particle, Visit&& visit) const {
    const LatticeShift home = cell_[particle];
    for (std::int32_t dz = -reach_.z; dz <= reach_.z; ++dz) {
      for (std::int32_t dy = -reach_.y; dy <= reach_.y; ++dy) {
        for (std::int32_t dx = -reach_.x; dx <= reach_.x; ++dx) {
          const LatticeShift cell = home + LatticeShift{dx, dy, dz};
          const LatticeShift wrap = {floor_divide(cell.x, cells_.x), floor_divide(cell.y, cells_.y),
                                     floor_divide(cell.z, cells_.z)};
          const std::size_t index =
              linear({cell.x - wrap.x * cells_.x, cell.y - wrap.y * cells_.y, cell.z - wrap.z * cells_.z});
          for (std::uint32_t k = first_[index]; k < first_[index + 1]; ++k) {
            // Positions as given may lie outside the cell: the image is relative to where they stand.
            const std::uint32_t other = content_[k];
            const LatticeShift image = wrap + offset_[particle] - offset_[other];
            if (other != particle || image != LatticeShift{}) {
              visit(Neighbour{other, image});
            }
          }
        }
      }
    }
  }

 private:
  static std::int32_t floor_divide(std::int32_t a, std::int32_t b) {
    return a >= 0 ? a / b : -((b - 1 - a) / b);
  }
  std::size_t linear(LatticeShift c) const {
    return (static_cast<std::size_t>(c.z) * static_cast<std::size_t>(cells_.y) +
            static_cast<std::size_t>(c.y)) *
               static_cast<std::size_t>(cells_.x) +
           static_cast<std::size_t>(c.x);
  }

  LatticeShift cells_, reach_;
  std::vector<LatticeShift> cell_, offset_;     // of each particle
  std::vector<std::uint32_t> first_, content_;  // counting sort by cell
};

}  // namespace peclet::engine
