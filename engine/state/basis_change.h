// Integer changes of the basis of a lattice, and whole numbers of lattice vectors.
#pragma once

#include <array>
#include <cstdint>

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

}  // namespace peclet::engine
