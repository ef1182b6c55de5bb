// The resistance of a pair, written down a second time and in another way than in the engine: what sampled
// noise and dissipated power are measured against.
#pragma once

#include <array>

#include "engine/state/vector3.h"

namespace peclet::engine {

using Matrix12 = std::array<std::array<double, 12>, 12>;

// R of Li, Royer & Ness (2023) eq. 29 with the coefficients of eqs. 9-12 and 15-18: (F_i, F_j, T_i, T_j) = -R
// (U_i, U_j, Omega_i, Omega_j). `separation` points from i to j; Y_B is multiplied by q = r / (a_i + a_j),
// Y_C by q^2; below `inner_gap` all but q keep their value there.
Matrix12 reference_resistance(double viscosity, double radius_i, double radius_j, const Vector3& separation,
                              double inner_gap);

// v.R.v
double quadratic_form(const Matrix12& R, const std::array<double, 12>& v);

}  // namespace peclet::engine
