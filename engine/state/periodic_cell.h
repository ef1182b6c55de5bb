// The periodic cell, and the only code that knows what an image is.
//
// Lattice vectors A1, A2, A3 are the columns of H. The cell deforms as the uniform part of the flow does,
// dH/dt = L H with the velocity gradient L: after a displacement gradient D = F - 1 since the start it is
//   H = (1 + D) H0 B,
// B a change of basis that keeps the cell from growing long and thin. An image by k = (kx, ky, kz) lies H k
// further and moves faster by L H k. In simple shear (rate y, 0, 0) of a box with edges Lx, Ly, Lz this is
// A2 = (tilt, Ly, 0), the tilt grows as rate Ly t, and images move by rate Ly ky along x. Particles are
// carried by drag, never displaced with the cell.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>

#include "engine/state/matrix3.h"

namespace peclet::engine {

// Whole numbers of lattice vectors.
struct LatticeShift {
  std::int32_t x = 0, y = 0, z = 0;

  friend bool operator==(const LatticeShift&, const LatticeShift&) = default;
  friend auto operator<=>(const LatticeShift&, const LatticeShift&) = default;
};

inline LatticeShift operator+(LatticeShift a, LatticeShift b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline LatticeShift operator-(LatticeShift a, LatticeShift b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline LatticeShift operator*(std::int32_t s, LatticeShift a) { return {s * a.x, s * a.y, s * a.z}; }

// H' = H B with whole numbers B of determinant 1 or -1: column c holds the new lattice vector c in the old
// basis. Both bases make the same lattice.
struct BasisChange {
  std::array<LatticeShift, 3> column = {LatticeShift{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

  friend bool operator==(const BasisChange&, const BasisChange&) = default;

  // The shift k of the new basis, in the old one: B k.
  LatticeShift before(LatticeShift k) const { return k.x * column[0] + k.y * column[1] + k.z * column[2]; }
  // The shift k of the old basis, in the new one: B^-1 k.
  LatticeShift after(LatticeShift k) const;

  // First a, then b.
  friend BasisChange operator*(const BasisChange& a, const BasisChange& b) {
    return {a.before(b.column[0]), a.before(b.column[1]), a.before(b.column[2])};
  }
};

// A2 -> A2 - count A1: what takes back the tilt that simple shear has made.
inline BasisChange flips(std::int32_t count) {
  BasisChange change;
  change.column[1].x = -count;
  return change;
}

// H = Q R: the cell turned so that A1 lies along x and A2 in the plane of x and y, which needs no turning
// in simple shear.
struct CellFrame {
  Matrix3 axes;            // Q; turned against each other like the lattice vectors, right- or left-handed
  Vector3 lengths;         // the diagonal of R, all positive
  double tilt_xy, xz, yz;  // the rest of R

  // Coordinates of a point along the lattice vectors; the cell is [0, 1)^3.
  Vector3 fractional(const Vector3& point) const {
    const double z = dot(axes.column[2], point) / lengths.z;
    const double y = (dot(axes.column[1], point) - yz * z) / lengths.y;
    return {(dot(axes.column[0], point) - tilt_xy * y - xz * z) / lengths.x, y, z};
  }
  // Distances between opposite faces of the cell.
  Vector3 widths() const;
};

class PeriodicCell {
 public:
  PeriodicCell() = default;
  // A box with these edges along x, y and z, except for the tilt of the second one along x.
  PeriodicCell(const Vector3& lengths, const Matrix3& velocity_gradient, double tilt = 0)
      : start_{Vector3{lengths.x, 0, 0}, Vector3{tilt, lengths.y, 0}, Vector3{0, 0, lengths.z}},
        velocity_gradient_(velocity_gradient) {
    place();
  }
  // Lattice vectors as columns, linearly independent.
  static PeriodicCell with_edges(const Matrix3& edges, const Matrix3& velocity_gradient) {
    PeriodicCell cell;
    cell.start_ = edges;
    cell.set_velocity_gradient(velocity_gradient);
    return cell;
  }

  const Matrix3& edges() const { return edges_; }
  const Matrix3& velocity_gradient() const { return velocity_gradient_; }
  const Matrix3& displacement_gradient() const { return displacement_gradient_; }
  const BasisChange& basis() const { return basis_; }  // of all changes since the start

  // Returns the cell enlarged `times`-fold along each edge, with the same strain.
  PeriodicCell enlarged(double times) const {
    PeriodicCell cell = *this;
    cell.start_ = times * start_;
    cell.place();
    return cell;
  }

  CellFrame frame() const;
  double volume() const;
  Vector3 lengths() const { return frame().lengths; }
  double tilt() const { return frame().tilt_xy; }
  // Of a simple shear, x along y, since the start.
  double strain() const { return displacement_gradient_.column[1].x; }
  // Net strain since the start: D_xy of a simple shear, or the Hencky strain ln(1 + D_xx) of an extension
  // along x, D the displacement gradient. Either is 0 in the other flow.
  double net_strain() const { return strain() + std::log1p(displacement_gradient_.column[0].x); }

  // Deforms the cell, keeping its basis, to this displacement gradient since the start.
  void deform(const Matrix3& displacement_gradient) { deform(displacement_gradient, velocity_gradient_); }
  void deform(const Matrix3& displacement_gradient, const Matrix3& velocity_gradient) {
    displacement_gradient_ = displacement_gradient;
    velocity_gradient_ = velocity_gradient;
    place();
  }
  void set_velocity_gradient(const Matrix3& gradient) {
    velocity_gradient_ = gradient;
    place();
  }

  // The change that makes the cell compact again. Each tilt is taken back into [-1/2, 1/2) of the edge that
  // it goes along, which is all that simple shear of a cube needs; a cell that stays thin, as extension
  // makes it, is reduced after Lenstra, Lenstra and Lovasz (1982), Math. Ann. 261, 515.
  BasisChange due_change() const;
  void change_basis(const BasisChange& change) { set_basis(basis_ * change); }
  void set_basis(const BasisChange& basis) {
    basis_ = basis;
    place();
  }

  Vector3 displacement(LatticeShift k) const {
    return edges_ * Vector3{double(k.x), double(k.y), double(k.z)};
  }
  // Of the image by k relative to the particle itself: L H k.
  Vector3 velocity(LatticeShift k) const {
    return edge_velocities_ * Vector3{double(k.x), double(k.y), double(k.z)};
  }

  Vector3 point_at(const Vector3& fractional) const { return edges_ * fractional; }

 private:
  void place();

  Matrix3 start_, displacement_gradient_, velocity_gradient_;
  BasisChange basis_;
  Matrix3 edges_, edge_velocities_;
};

}  // namespace peclet::engine
