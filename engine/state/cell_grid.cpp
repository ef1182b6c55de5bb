#include "engine/state/cell_grid.h"

namespace peclet::engine {
namespace {

// Returns the cells along an edge, at least `range` wide each. More than 8 per particle slow the search down.
std::int32_t divide(double width, double range, std::size_t particles) {
  const double most = std::max(1.0, std::cbrt(8.0 * static_cast<double>(particles)));
  return static_cast<std::int32_t>(std::max(1.0, std::floor(std::min(width / range, most))));
}

// Returns the whole part of a lattice coordinate and leaves the rest, which is in [0, 1).
std::int32_t whole(double& coordinate) {
  const double down = std::floor(coordinate);
  coordinate -= down;
  return static_cast<std::int32_t>(down);
}

std::int32_t cell_of(double rest, std::int32_t cells) {
  return std::min(static_cast<std::int32_t>(rest * cells), cells - 1);
}

}  // namespace

LatticePlaces lattice_places(const VectorField& position, const PeriodicCell& box) {
  LatticePlaces places;
  places.fractional.reserve(position.size());
  places.offset.reserve(position.size());
  const CellFrame frame = box.frame();
  for (std::size_t i = 0; i < position.size(); ++i) {
    Vector3 place = frame.fractional(position[i]);
    places.offset.push_back({whole(place.x), whole(place.y), whole(place.z)});
    places.fractional.push_back(place);
  }
  return places;
}

CellGrid::CellGrid(const LatticePlaces& places, std::span<const std::uint32_t> members,
                   const PeriodicCell& box, double range)
    : box_(box) {
  const Vector3 widths = box.frame().widths();
  cells_ = {divide(widths.x, range, members.size()), divide(widths.y, range, members.size()),
            divide(widths.z, range, members.size())};
  per_length_ = {cells_.x / widths.x, cells_.y / widths.y, cells_.z / widths.z};
  first_.assign(linear({0, 0, cells_.z}) + 1, 0);
  std::vector<std::size_t> cell;
  cell.reserve(members.size());
  for (const std::uint32_t i : members) {
    cell.push_back(linear(cell_at(places.fractional[i])));
    ++first_[cell.back() + 1];
  }
  for (std::size_t c = 1; c < first_.size(); ++c) first_[c] += first_[c - 1];
  content_.resize(members.size());
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  for (std::size_t k = 0; k < members.size(); ++k) {
    content_[next[cell[k]]++] = {box.point_at(places.fractional[members[k]]), members[k]};
  }
}

LatticeShift CellGrid::cell_at(const Vector3& fractional) const {
  return {cell_of(fractional.x, cells_.x), cell_of(fractional.y, cells_.y), cell_of(fractional.z, cells_.z)};
}

}  // namespace peclet::engine
