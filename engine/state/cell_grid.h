// Sorts particles into cells along the lattice vectors of the periodic cell, to find near ones.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/state/periodic_cell.h"
#include "engine/state/vector_field.h"

namespace peclet::engine {

// Coordinates of particles along the lattice vectors H: position = H (fractional + offset).
struct LatticePlaces {
  std::vector<Vector3> fractional;  // in [0, 1)^3
  std::vector<LatticeShift> offset;
};

LatticePlaces lattice_places(const VectorField& position, const PeriodicCell& box);

// A subset of the particles, sorted into cells.
class CellGrid {
 public:
  // Sorts `members` into cells at least `range` wide, or as wide as the box if it is narrower. Members of a
  // cell are visited in the given order.
  CellGrid(const LatticePlaces& places, std::span<const std::uint32_t> members, const PeriodicCell& box,
           double range);

  // Calls visit(member, wrap, separation) for all images of members in cells within `range` of a point, given
  // by its `fractional` coordinates. These are all images closer than `range` and many further away.
  // `separation` leads from the point to the image, which lies `wrap` lattice vectors from the member's place
  // in the cell.
  template <class Visit>
  void visit_near(const Vector3& fractional, double range, Visit&& visit) const {
    const Layers along_x = layers(fractional.x, cells_.x, range * per_length_.x),
                 along_y = layers(fractional.y, cells_.y, range * per_length_.y),
                 along_z = layers(fractional.z, cells_.z, range * per_length_.z);
    const Vector3 point = box_.point_at(fractional);
    const auto& [edge_x, edge_y, edge_z] = box_.edges().column;
    for (std::int32_t layer_z = along_z.begin; layer_z < along_z.end; ++layer_z) {
      const Wrapped z = wrapped(layer_z, cells_.z);
      const Vector3 shift_z = static_cast<double>(z.wrap) * edge_z;
      for (std::int32_t layer_y = along_y.begin; layer_y < along_y.end; ++layer_y) {
        const Wrapped y = wrapped(layer_y, cells_.y);
        const Vector3 shift_yz = static_cast<double>(y.wrap) * edge_y + shift_z;
        const std::size_t row = (static_cast<std::size_t>(z.cell) * static_cast<std::size_t>(cells_.y) +
                                 static_cast<std::size_t>(y.cell)) *
                                static_cast<std::size_t>(cells_.x);
        // Members of neighbouring cells along x are consecutive in memory.
        for (std::int32_t x = along_x.begin; x < along_x.end;) {
          const Wrapped first = wrapped(x, cells_.x);
          const std::int32_t count = std::min(along_x.end - x, cells_.x - first.cell);
          const std::size_t begin = row + static_cast<std::size_t>(first.cell);
          const LatticeShift wrap = {first.wrap, y.wrap, z.wrap};
          const Vector3 shift = static_cast<double>(first.wrap) * edge_x + shift_yz - point;
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
    if (cell >= 0 && cell < cells) {
      return {cell, 0};
    }
    const std::int32_t wrap = cell >= 0 ? cell / cells : -((cells - 1 - cell) / cells);
    return {cell - wrap * cells, wrap};
  }
  struct Layers {
    std::int32_t begin, end;
  };
  // Returns the layers of cells within `range` [cells] of a point, padded by 1e-9 against rounding.
  static Layers layers(double fractional, std::int32_t cells, double range) {
    const double place = fractional * cells, wider = range * (1 + 1e-9);
    return {static_cast<std::int32_t>(std::floor(place - wider)),
            static_cast<std::int32_t>(std::floor(place + wider)) + 1};
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

  PeriodicCell box_;
  LatticeShift cells_;
  Vector3 per_length_;                // cells per unit of distance between opposite faces
  std::vector<std::uint32_t> first_;  // first member of each cell, and the end of the last cell
  std::vector<Member> content_;
};

}  // namespace peclet::engine
