// The resistance of a pair, from the formulas of Jeffrey & Onishi instead of those of the engine: what
// sampled noise and dissipated power are measured against.
#pragma once

#include "tests/engine/linear_algebra.h"

namespace peclet::engine {

// (F_i, F_j, T_i, T_j) = -R (U_i, U_j, Omega_i, Omega_j) with the divergent terms of Jeffrey & Onishi, J.
// Fluid Mech. 139, 261 (1984), as Kim & Karrila, Microhydrodynamics (1991), ch. 11, print them. `separation`
// points from i to j. The program's own: spins count q = r / (a_i + a_j) times; below `inner_gap` all but q
// keep their value there.
Matrix12 reference_resistance(double viscosity, double radius_i, double radius_j, const Vector3& separation,
                              double inner_gap);

// The same as Monti et al. (2021) take them, Phys. Fluids 33, 103314, A.6 and A.7: at the gap max(xi, 0) +
// `regularisation`, without the logarithm of X_A, spins once. The motion is that relative to the flow.
Matrix12 reference_relative_resistance(double viscosity, double radius_i, double radius_j,
                                       const Vector3& separation, double regularisation);

}  // namespace peclet::engine
