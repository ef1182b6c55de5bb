// Calculates the resistance of a pair from the formulas of Jeffrey & Onishi, independently of the engine.
#pragma once

#include "tests/engine/linear_algebra.h"

namespace peclet::engine {

// Returns R of (F_i, F_j, T_i, T_j) = -R (U_i, U_j, Omega_i, Omega_j), with the divergent terms of Jeffrey &
// Onishi, J. Fluid Mech. 139, 261 (1984), as printed by Kim & Karrila, Microhydrodynamics (1991), ch. 11.
// `separation` points from i to j. Two choices are the program's own: spins are multiplied by
// q = r / (a_i + a_j), and below `inner_gap` every factor but q keeps its value at `inner_gap`.
Matrix12 reference_resistance(double viscosity, double radius_i, double radius_j, const Vector3& separation,
                              double inner_gap);

// Returns R in the form of Monti et al. (2021), Phys. Fluids 33, 103314, A.6 and A.7: at the gap max(xi, 0) +
// `regularisation`, without the logarithm of X_A, spins counted once. Velocities are relative to the flow.
Matrix12 reference_relative_resistance(double viscosity, double radius_i, double radius_j,
                                       const Vector3& separation, double regularisation);

}  // namespace peclet::engine
