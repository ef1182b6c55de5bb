#include "engine/state/cell_grid.h"

#include <algorithm>

namespace peclet::engine {
namespace {

struct Axis {
  std::int32_t cells, reach;
};

// More than a few cells per particle would only make the grid slow to walk.
Axis divide(double width, double range, std::size_t particles) {
  const double most = std::max(1.0, std::cbrt(8.0 * static_cast<double>(particles)));
  const double cells = std::max(1.0, std::floor(std::min(width / range, most)));
  return {static_cast<std::int32_t>(cells), static_cast<std::int32_t>(std::ceil(range / (width / cells)))};
}

// Splits a lattice coordinate into whole cells and the rest in [0, 1).
std::int32_t whole(double& coordinate) {
  const double down = std::floor(coordinate);
  coordinate -= down;
  return static_cast<std::int32_t>(down);
}

std::int32_t cell_of(double rest, std::int32_t cells) {
  return std::min(static_cast<std::int32_t>(rest * cells), cells - 1);
}

}  // namespace

CellGrid::CellGrid(const VectorField& position, const ShearedBox& box, double range) {
  const std::size_t count = position.size();
  const Vector3 widths = box.widths();
  const Axis x = divide(widths.x, range, count), y = divide(widths.y, range, count),
             z = divide(widths.z, range, count);
  cells_ = {x.cells, y.cells, z.cells};
  reach_ = {x.reach, y.reach, z.reach};
  cell_.resize(count);
  offset_.resize(count);
  first_.assign(linear({0, 0, cells_.z}) + 1, 0);
  for (std::size_t i = 0; i < count; ++i) {
    Vector3 place = box.fractional(position[i]);
    offset_[i] = {whole(place.x), whole(place.y), whole(place.z)};
    cell_[i] = {cell_of(place.x, cells_.x), cell_of(place.y, cells_.y), cell_of(place.z, cells_.z)};
    ++first_[linear(cell_[i]) + 1];
  }
  for (std::size_t c = 1; c < first_.size(); ++c) {
    first_[c] += first_[c - 1];
  }
  content_.resize(count);
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  for (std::uint32_t i = 0; i < count; ++i) {
    content_[next[linear(cell_[i])]++] = i;
  }
}

}  // namespace peclet::engine
