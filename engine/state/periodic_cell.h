// The periodic cell and its images.
//
// Lattice vectors A1, A2, A3 are the columns of H. The cell deforms with the uniform part of the flow, of
// velocity gradient L:
//   dH/dt = L H,   H = (1 + D) H0 B
// after a displacement gradient D = F - 1 since the start, with a change of basis B that keeps the cell from
// growing long and thin. The image by k = (kx, ky, kz) lies H k further and moves faster by L H k. In simple
// shear (rate y, 0, 0) of a box with edges Lx, Ly, Lz:
//   A2 = (tilt, Ly, 0),   d tilt/dt = rate Ly,   velocity of images (rate Ly ky, 0, 0)
// Particles are carried by drag, never displaced with the cell.
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

// A change of basis H' = H B with integers B of determinant 1 or -1. Column c of B is the new lattice vector
// c in the old basis. Both bases span the same lattice.
struct BasisChange {
  std::array<LatticeShift, 3> column = {LatticeShift{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

  friend bool operator==(const BasisChange&, const BasisChange&) = default;

  // Converts a shift from the new basis to the old one: B k.
  LatticeShift before(LatticeShift k) const { return k.x * column[0] + k.y * column[1] + k.z * column[2]; }
  // Converts a shift from the old basis to the new one: B^-1 k.
  LatticeShift after(LatticeShift k) const;

  // Returns the change by a and then by b.
  friend BasisChange operator*(const BasisChange& a, const BasisChange& b) {
    return {a.before(b.column[0]), a.before(b.column[1]), a.before(b.column[2])};
  }
};

// Returns the change A2 -> A2 - count A1, which reduces the tilt of simple shear.
inline BasisChange flips(std::int32_t count) {
  BasisChange change;
  change.column[1].x = -count;
  return change;
}

// The decomposition H = Q R into orthogonal axes and a cell with A1 along x and A2 in the xy plane. Q is 1 in
// simple shear.
struct CellFrame {
  Matrix3 axes;            // Q, right- or left-handed as the lattice vectors are
  Vector3 lengths;         // the diagonal of R, all positive
  double tilt_xy, xz, yz;  // above the diagonal of R

  // Returns the coordinates of a point along the lattice vectors; the cell is [0, 1)^3.
  Vector3 fractional(const Vector3& point) const {
    const double z = dot(axes.column[2], point) / lengths.z;
    const double y = (dot(axes.column[1], point) - yz * z) / lengths.y;
    return {(dot(axes.column[0], point) - tilt_xy * y - xz * z) / lengths.x, y, z};
  }
  // Returns the distances between opposite faces of the cell.
  Vector3 widths() const;
};

class PeriodicCell {
 public:
  PeriodicCell() = default;
  // Makes a box with edges along x, y and z, of which the second is tilted along x by `tilt` [length].
  PeriodicCell(const Vector3& lengths, const Matrix3& velocity_gradient, double tilt = 0)
      : start_{Vector3{lengths.x, 0, 0}, Vector3{tilt, lengths.y, 0}, Vector3{0, 0, lengths.z}},
        velocity_gradient_(velocity_gradient) {
    place();
  }
  // Makes a cell with these columns as lattice vectors, which must be linearly independent.
  static PeriodicCell with_edges(const Matrix3& edges, const Matrix3& velocity_gradient) {
    PeriodicCell cell;
    cell.start_ = edges;
    cell.set_velocity_gradient(velocity_gradient);
    return cell;
  }

  const Matrix3& edges() const { return edges_; }
  const Matrix3& velocity_gradient() const { return velocity_gradient_; }
  const Matrix3& displacement_gradient() const { return displacement_gradient_; }
  const BasisChange& basis() const { return basis_; }  // all changes since the start

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
  // Returns the strain D_xy of simple shear since the start.
  double strain() const { return displacement_gradient_.column[1].x; }
  // Returns the net strain since the start: D_xy of simple shear, or the Hencky strain ln(1 + D_xx) of
  // extension along x. Either is 0 in the other flow.
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

  // Returns the change that makes the cell compact. Each tilt is brought into [-1/2, 1/2) of the edge along
  // it, which is enough in simple shear of a cube. A cell that stays thin, as in extension, is reduced after
  // Lenstra, Lenstra and Lovasz (1982), Math. Ann. 261, 515.
  BasisChange due_change() const;
  void change_basis(const BasisChange& change) { set_basis(basis_ * change); }
  void set_basis(const BasisChange& basis) {
    basis_ = basis;
    place();
  }

  Vector3 displacement(LatticeShift k) const {
    return edges_ * Vector3{double(k.x), double(k.y), double(k.z)};
  }
  // Returns the velocity of the image by k relative to the particle itself: L H k.
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
