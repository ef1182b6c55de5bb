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

}  // namespace peclet::engine
