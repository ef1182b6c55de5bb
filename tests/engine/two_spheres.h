// A pair of spheres as the terms see it, and its grand resistance matrix from unit motions.
#pragma once

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "engine/terms/lubrication.h"
#include "tests/engine/draws.h"
#include "tests/engine/linear_algebra.h"

namespace peclet::engine {

constexpr double inner_gap = 1e-3;
// beta = a_j / a_i and gaps for every claim about pairs, overlap and clamped gaps included.
constexpr double size_ratios[] = {1.0 / 7, 1 / 1.4, 1, 1.4, 3, 7};
constexpr double gaps[] = {-0.01, 0, 5e-4, 1e-3, 0.01, 0.05, 0.2, 0.5};

inline PairGeometry pair_at(double first, double second, double gap, const Vector3& normal) {
  const double distance = (first + second) * (1 + 0.5 * gap);
  return {distance * normal, normal, distance, first + second};
}

inline LubricatedGap plain_gap(const PairGeometry& pair) {
  return lubricated_gap({.inner_gap = inner_gap}, pair.sum_of_radii);
}

// Returns the resistance of the form kim-karrila.
inline PairResistance resistance_of(double viscosity, double first, double second, const PairGeometry& pair) {
  return pair_resistance(resistance_constants(viscosity, first, second), plain_gap(pair), pair);
}

inline ResistanceRoots roots_of(double viscosity, double first, double second, const PairGeometry& pair) {
  const ResistanceConstants constants = resistance_constants(viscosity, first, second);
  const ResistanceModes modes = resistance_modes(plain_gap(pair), pair.distance, pair);
  return resistance_roots(root_constants(constants), pair_resistance(constants, modes).squeeze, modes);
}

inline PairMotion random_motion(Draws& draws) { return {draws.vector(), draws.vector(), draws.vector()}; }

// Returns -power of a load: F_i.U_i + F_j.U_j + T_i.Omega_i + T_j.Omega_j with F_j = -F_i.
inline double dissipated(const PairLoad& load, const PairMotion& motion) {
  return dot(load.force, motion.velocity) - dot(load.torque_first, motion.spin_first) -
         dot(load.torque_second, motion.spin_second);
}

// Returns the components of (F_i, F_j, T_i, T_j).
inline Vector12 components(const PairLoad& load) {
  const Eigen::Vector3d force = to_eigen(load.force);
  Vector12 all;
  all << force, -force, to_eigen(load.torque_first), to_eigen(load.torque_second);
  return all;
}

// Returns R of (F_i, F_j, T_i, T_j) = -R (U_i, U_j, Omega_i, Omega_j), column by column.
inline Matrix12 grand_resistance(const PairResistance& resistance, const PairGeometry& pair) {
  Matrix12 matrix;
  for (Eigen::Index k = 0; k < 12; ++k) {
    const Vector12 unit = Vector12::Unit(k);
    const PairMotion motion = {from_eigen(unit.segment<3>(3) - unit.head<3>()),
                               from_eigen(unit.segment<3>(6)), from_eigen(unit.tail<3>())};
    matrix.col(k) = -components(lubrication_load(resistance, pair, motion));
  }
  return matrix;
}

// Expects a symmetric positive semidefinite matrix of rank five.
inline void expect_rank_five(const Matrix12& R) {
  const double scale = largest_entry(R);
  EXPECT_LE(largest_entry(R - R.transpose()), 1e-14 * scale);
  const Vector12 eigenvalues = Eigen::SelfAdjointEigenSolver<Matrix12>(R).eigenvalues();
  EXPECT_GT(eigenvalues[0], -1e-14 * scale);
  EXPECT_LT(eigenvalues[6], 1e-14 * scale);
  EXPECT_GT(eigenvalues[7], 1e-6 * scale);
}
}  // namespace peclet::engine
