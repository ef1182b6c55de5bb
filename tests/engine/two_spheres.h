// A pair of spheres as the terms see it, and its grand resistance matrix by unit motions.
#pragma once

#include "engine/terms/lubrication.h"
#include "tests/engine/draws.h"
#include "tests/engine/symmetric_eigenvalues.h"

namespace peclet::engine {

constexpr double inner_gap = 1e-3;
// beta = a_j / a_i and gaps in which every claim about pairs is tried; overlap and clamped gaps among them.
constexpr double size_ratios[] = {1.0 / 7, 1 / 1.4, 1, 1.4, 3, 7};
constexpr double gaps[] = {-0.01, 0, 5e-4, 1e-3, 0.01, 0.05, 0.2, 0.5};

inline PairGeometry pair_at(double first, double second, double gap, const Vector3& normal) {
  const double distance = (first + second) * (1 + 0.5 * gap);
  return {distance * normal, normal, distance, first + second};
}

inline PairResistance resistance_of(double viscosity, double first, double second, const PairGeometry& pair) {
  return pair_resistance(resistance_constants(viscosity, first, second), inner_gap, pair);
}

inline ResistanceRoots roots_of(double viscosity, double first, double second, const PairGeometry& pair) {
  const ResistanceConstants constants = resistance_constants(viscosity, first, second);
  const ResistanceModes modes = resistance_modes(inner_gap, pair.distance, pair);
  return resistance_roots(root_constants(constants), pair_resistance(constants, modes).squeeze, modes);
}

inline PairMotion random_motion(Draws& draws) { return {draws.vector(), draws.vector(), draws.vector()}; }

// -power of a load: F_i.U_i + F_j.U_j + T_i.Omega_i + T_j.Omega_j with F_j = -F_i.
inline double dissipated(const PairLoad& load, const PairMotion& motion) {
  return dot(load.force, motion.velocity) - dot(load.torque_first, motion.spin_first) -
         dot(load.torque_second, motion.spin_second);
}

// Components of (F_i, F_j, T_i, T_j).
inline std::array<double, 12> components(const PairLoad& load) {
  const Vector3 &f = load.force, &t = load.torque_first, &u = load.torque_second;
  return {f.x, f.y, f.z, -f.x, -f.y, -f.z, t.x, t.y, t.z, u.x, u.y, u.z};
}

// R of (F_i, F_j, T_i, T_j) = -R (U_i, U_j, Omega_i, Omega_j), column by column.
inline Matrix<12> grand_resistance(const PairResistance& resistance, const PairGeometry& pair) {
  Matrix<12> matrix{};
  for (std::size_t k = 0; k < 12; ++k) {
    std::array<Vector3, 4> unit{};
    Vector3& part = unit[k / 3];
    (k % 3 == 0 ? part.x : k % 3 == 1 ? part.y : part.z) = 1;
    const PairLoad load = lubrication_load(resistance, pair, {unit[1] - unit[0], unit[2], unit[3]});
    for (std::size_t row = 0; row < 12; ++row) {
      matrix[row][k] = -components(load)[row];
    }
  }
  return matrix;
}

inline double largest_entry(const Matrix<12>& matrix) {
  double largest = 0;
  for (const auto& row : matrix) {
    for (const double value : row) largest = std::max(largest, std::abs(value));
  }
  return largest;
}

}  // namespace peclet::engine
