// Brownian forces and torques of a lubricated pair.
#pragma once

#include <cmath>

#include "engine/terms/pair_resistance.h"

namespace peclet::engine {

// With theta, chi standard normal vectors and c = sqrt(2 kT / dt), T = 1 - n n:
//   F_i = c (sqrt(X_A) n n + sqrt(Y_A) T).theta
//   T_i = c [Y_B11 / sqrt(Y_A) theta x n + sqrt(Y_C11 - Y_B11^2 / Y_A) T.chi]
//   T_j = c [Y_B21 / sqrt(Y_A) theta x n - sqrt(Y_C22 - Y_B21^2 / Y_A) T.chi]
// Li, Royer & Ness (2023) eqs. 22-24 and 28. The minus in the last line, where eq. 24 prints a plus, is what
// makes the covariance of the six components equal to 2 kT R / dt.
inline PairLoad pair_noise_load(double amplitude, const PairResistance& R, const PairGeometry& pair,
                                const Vector3& theta, const Vector3& chi) {
  const Vector3& n = pair.normal;
  const double along = dot(theta, n);
  const Vector3 turned = cross(theta, n);
  const Vector3 spun = across(chi, n);
  const double root_shear = std::sqrt(R.shear);
  const double pump_first = R.pump_first / root_shear, pump_second = R.pump_second / root_shear;
  // Both roots are real for every size ratio (their square is 6 pi eta a_i^3 beta^3 L q^2 / ((1 + beta)(2 +
  // beta + 2 beta^2))).
  const double spin_first = std::sqrt(R.twist_first - pump_first * pump_first);
  const double spin_second = std::sqrt(R.twist_second - pump_second * pump_second);
  return {amplitude * ((std::sqrt(R.squeeze) * along) * n + root_shear * (theta - along * n)),
          amplitude * (pump_first * turned + spin_first * spun),
          amplitude * (pump_second * turned - spin_second * spun)};
}

}  // namespace peclet::engine
