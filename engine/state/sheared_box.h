// The periodic cell under simple shear u = (rate y, 0, 0), and the only code that knows what an image is.
//
// Lattice vectors A1 = (Lx, 0, 0), A2 = (tilt, Ly, 0), A3 = (0, 0, Lz). The tilt grows as rate Ly t; a flip
// tilt -> tilt - Lx chooses another basis of the same lattice. An image by k = (kx, ky, kz) lies k A further
// and moves faster by rate Ly ky along x, as the streaming flow does at that height. Particles are carried by
// drag, never displaced with the box.
#pragma once

#include <array>
#include <cstdint>

#include "engine/state/vector3.h"

namespace peclet::engine {

// Whole numbers of lattice vectors.
struct LatticeShift {
  std::int32_t x = 0, y = 0, z = 0;

  friend bool operator==(const LatticeShift&, const LatticeShift&) = default;
  friend auto operator<=>(const LatticeShift&, const LatticeShift&) = default;
};

inline LatticeShift operator+(LatticeShift a, LatticeShift b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline LatticeShift operator-(LatticeShift a, LatticeShift b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }

class ShearedBox {
 public:
  ShearedBox() = default;
  ShearedBox(const Vector3& lengths, double shear_rate, double tilt = 0)
      : lengths_(lengths), shear_rate_(shear_rate), initial_tilt_(tilt), tilt_(tilt) {}

  const Vector3& lengths() const { return lengths_; }
  double shear_rate() const { return shear_rate_; }
  double tilt() const { return tilt_; }
  double volume() const { return lengths_.x * lengths_.y * lengths_.z; }
  double strain() const { return strain_; }
  std::int32_t flips() const { return flips_; }

  // Deforms the cell to a total strain, keeping its basis.
  void set_strain(double strain) { place(strain, flips_); }
  void place(double strain, std::int32_t flips) {
    strain_ = strain;
    flips_ = flips;
    tilt_ = initial_tilt_ + strain * lengths_.y - flips * lengths_.x;
  }

  // Number of flips that bring the tilt into [-Lx/2, Lx/2).
  std::int32_t due_flips() const;

  // Changes the basis by `count` flips. A shift k of the old basis is rebased(k, count) in the new one.
  void flip(std::int32_t count) { place(strain_, flips_ + count); }
  static LatticeShift rebased(LatticeShift k, std::int32_t count) { return {k.x + count * k.y, k.y, k.z}; }

  Vector3 displacement(LatticeShift k) const {
    return {k.x * lengths_.x + k.y * tilt_, k.y * lengths_.y, k.z * lengths_.z};
  }
  // Of the image by k relative to the particle itself: rate Ly ky along x.
  double velocity_offset(LatticeShift k) const { return shear_rate_ * lengths_.y * k.y; }

  // Coordinates of a point along the lattice vectors; the cell is [0, 1)^3.
  Vector3 fractional(const Vector3& point) const {
    const double fy = point.y / lengths_.y;
    return {(point.x - tilt_ * fy) / lengths_.x, fy, point.z / lengths_.z};
  }

  Vector3 point_at(const Vector3& fractional) const {
    return {fractional.x * lengths_.x + fractional.y * tilt_, fractional.y * lengths_.y,
            fractional.z * lengths_.z};
  }

  // Distances between opposite faces of the cell.
  Vector3 widths() const;

 private:
  Vector3 lengths_;
  double shear_rate_ = 0;
  double initial_tilt_ = 0;
  double tilt_ = 0;
  double strain_ = 0;
  std::int32_t flips_ = 0;
};

}  // namespace peclet::engine
