#include "engine/state/periodic_cell.h"

#include <algorithm>

namespace peclet::engine {
namespace {

// Returns v / length, which is exact if only one component is not zero: sqrt(x x) is |x|.
Vector3 over(const Vector3& v, double length) { return {v.x / length, v.y / length, v.z / length}; }

CellFrame frame_of(const Matrix3& edges) {
  const Vector3 &a = edges.column[0], &b = edges.column[1], &c = edges.column[2];
  CellFrame frame{};
  auto& [x, y, z] = frame.axes.column;
  frame.lengths.x = norm(a);
  x = over(a, frame.lengths.x);
  frame.tilt_xy = dot(x, b);
  const Vector3 across_a = b - frame.tilt_xy * x;
  frame.lengths.y = norm(across_a);
  y = over(across_a, frame.lengths.y);
  frame.xz = dot(x, c);
  frame.yz = dot(y, c);
  const Vector3 across_both = c - frame.xz * x - frame.yz * y;
  frame.lengths.z = norm(across_both);
  z = over(across_both, frame.lengths.z);
  return frame;
}

Matrix3 in_basis(const Matrix3& edges, const BasisChange& basis) {
  const auto vector = [&](LatticeShift k) { return edges * Vector3{double(k.x), double(k.y), double(k.z)}; };
  return {vector(basis.column[0]), vector(basis.column[1]), vector(basis.column[2])};
}

std::int32_t nearest(double ratio) { return static_cast<std::int32_t>(std::floor(ratio + 0.5)); }

// Returns the basis with the smallest tilt of the second lattice vector, then of the third.
BasisChange straightened(const Matrix3& edges, BasisChange basis) {
  basis.column[1] = basis.column[1] - [&] {
    const CellFrame frame = frame_of(in_basis(edges, basis));
    return nearest(frame.tilt_xy / frame.lengths.x) * basis.column[0];
  }();
  const CellFrame over_y = frame_of(in_basis(edges, basis));
  basis.column[2] = basis.column[2] - nearest(over_y.yz / over_y.lengths.y) * basis.column[1];
  const CellFrame over_x = frame_of(in_basis(edges, basis));
  basis.column[2] = basis.column[2] - nearest(over_x.xz / over_x.lengths.x) * basis.column[0];
  return basis;
}

bool is_thin(const Matrix3& edges) {
  constexpr double thin = 0.75;  // a cube in simple shear keeps 2 / sqrt(5)
  const Vector3 w = frame_of(edges).widths();
  const double shortest = std::min({norm(edges.column[0]), norm(edges.column[1]), norm(edges.column[2])});
  return std::min({w.x, w.y, w.z}) < thin * shortest;
}

// Swaps two neighbouring lattice vectors and reverses one of them: the basis stays right-handed.
void turn(LatticeShift& first, LatticeShift& second) {
  std::swap(first, second);
  second = -1 * second;
}

// Returns a basis that meets Lovasz's condition: of two neighbouring vectors the second is not much shorter
// than the first, both taken perpendicular to the vectors before the pair.
BasisChange reduced(const Matrix3& edges) {
  constexpr double much = 0.75;
  BasisChange basis;
  for (bool swapped = true; swapped;) {
    basis = straightened(edges, basis);
    const CellFrame frame = frame_of(in_basis(edges, basis));
    const Vector3& r = frame.lengths;
    if (r.y * r.y + frame.tilt_xy * frame.tilt_xy < much * r.x * r.x) {
      turn(basis.column[0], basis.column[1]);
    } else if (r.z * r.z + frame.yz * frame.yz < much * r.y * r.y) {
      turn(basis.column[1], basis.column[2]);
    } else {
      swapped = false;
    }
  }
  return basis;
}

}  // namespace

LatticeShift BasisChange::after(LatticeShift k) const {
  // Cramer's rule; the determinant is its own inverse.
  const auto& [a, b, c] = column;
  const auto volume = [](LatticeShift p, LatticeShift q, LatticeShift r) {
    return p.x * (q.y * r.z - q.z * r.y) + p.y * (q.z * r.x - q.x * r.z) + p.z * (q.x * r.y - q.y * r.x);
  };
  const std::int32_t sign = volume(a, b, c);
  return sign * LatticeShift{volume(k, b, c), volume(a, k, c), volume(a, b, k)};
}

Vector3 CellFrame::widths() const {
  // A width is one over the length of a row of R^-1.
  const double xy = tilt_xy / lengths.y;
  const double along_z = (xy * yz - xz) / lengths.z, yz_slope = yz / lengths.z;
  return {lengths.x / std::sqrt(1 + xy * xy + along_z * along_z),
          lengths.y / std::sqrt(1 + yz_slope * yz_slope), lengths.z};
}

void PeriodicCell::place() {
  edges_ = in_basis(start_ + displacement_gradient_ * start_, basis_);
  edge_velocities_ = velocity_gradient_ * edges_;
}

CellFrame PeriodicCell::frame() const { return frame_of(edges_); }

double PeriodicCell::volume() const {
  const Vector3 lengths = frame().lengths;
  return lengths.x * lengths.y * lengths.z;
}

BasisChange PeriodicCell::due_change() const {
  const BasisChange straight = straightened(edges_, {});
  return is_thin(in_basis(edges_, straight)) ? reduced(edges_) : straight;
}

}  // namespace peclet::engine
