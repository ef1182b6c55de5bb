// Cells along the lattice vectors of a sheared box, for finding what is near.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/state/sheared_box.h"
#include "engine/state/vector_field.h"

namespace peclet::engine {

// Where particles stand in the cell of the box: position as given = place along the lattice vectors + offset.
struct LatticePlaces {
  std::vector<Vector3> fractional;  // in [0, 1)^3
  std::vector<LatticeShift> offset;
};

LatticePlaces lattice_places(const VectorField& position, const ShearedBox& box);

// Some of the particles, sorted into cells.
class CellGrid {
 public:
  // `members` in the order in which they are visited. Cells at least `range` wide, or as many layers of
  // neighbours as it takes where the box is smaller than that.
  CellGrid(const LatticePlaces& places, std::span<const std::uint32_t> members, const ShearedBox& box,
           double range);

  // Calls visit(member, wrap, separation) for every member in every image whose cell is within reach of the
  // point at `fractional` coordinates: `separation` leads from there to the image by `wrap` of the member's
  // place in the cell. Nothing closer than `range` is missed; most visits are of members further away.
  template <class Visit>
  void visit_near(const Vector3& fractional, Visit&& visit) const {
    const LatticeShift home = cell_at(fractional);
    const Vector3 point = box_.point_at(fractional);
    for (std::int32_t dz = -reach_.z; dz <= reach_.z; ++dz) {
      const Wrapped z = wrapped(home.z + dz, cells_.z);
      for (std::int32_t dy = -reach_.y; dy <= reach_.y; ++dy) {
        const Wrapped y = wrapped(home.y + dy, cells_.y);
        const std::size_t row = (static_cast<std::size_t>(z.cell) * static_cast<std::size_t>(cells_.y) +
                                 static_cast<std::size_t>(y.cell)) *
                                static_cast<std::size_t>(cells_.x);
        // Cells that follow each other along x are visited in one go.
        for (std::int32_t x = home.x - reach_.x, end = home.x + reach_.x + 1; x < end;) {
          const Wrapped first = wrapped(x, cells_.x);
          const std::int32_t count = std::min(end - x, cells_.x - first.cell);
          const std::size_t begin = row + static_cast<std::size_t>(first.cell);
          const LatticeShift wrap = {first.wrap, y.wrap, z.wrap};
          const Vector3 shift = box_.displacement(wrap) - point;
          for (std::uint32_t k = first_[begin]; k < first_[begin + static_cast<std::size_t>(count)]; ++k) {
            visit(content_[k].particle, wrap, content_[k].point + shift);
          }
          x += count;
        }
      }
    }
  }

 private:
  struct Wrapped {
    std::int32_t cell, wrap;
  };
  static Wrapped wrapped(std::int32_t cell, std::int32_t cells) {
    const std::int32_t wrap = cell >= 0 ? cell / cells : -((cells - 1 - cell) / cells);
    return {cell - wrap * cells, wrap};
  }
  struct Member {
    Vector3 point;
    std::uint32_t particle;
  };

  LatticeShift cell_at(const Vector3& fractional) const;
  std::size_t linear(LatticeShift c) const {
    return (static_cast<std::size_t>(c.z) * static_cast<std::size_t>(cells_.y) +
            static_cast<std::size_t>(c.y)) *
               static_cast<std::size_t>(cells_.x) +
           static_cast<std::size_t>(c.x);
  }

  ShearedBox box_;
  LatticeShift cells_, reach_;
  std::vector<std::uint32_t> first_;  // counting sort by cell
  std::vector<Member> content_;
};

}  // namespace peclet::engine
