// Brownian forces and torques of a lubricated pair.
#pragma once

#include "engine/terms/pair_resistance.h"

namespace peclet::engine {

// With theta, chi standard normal vectors and c = sqrt(2 kT / dt), T = 1 - n n:
//   F_i = c (sqrt(X_A) n n + sqrt(Y_A) T).theta
//   T_i = c [Y_B11 / sqrt(Y_A) theta x n + sqrt(Y_C11 - Y_B11^2 / Y_A) T.chi]
//   T_j = c [Y_B21 / sqrt(Y_A) theta x n - sqrt(Y_C22 - Y_B21^2 / Y_A) T.chi]
// Li, Royer & Ness (2023) eqs. 22-24 and 28. The minus in the last line, where eq. 24 prints a plus, is what
// makes the covariance of the six components equal to 2 kT R / dt.
template <class Real>
PECLET_ALWAYS_INLINE PairLoadOf<Real> pair_noise_load(double amplitude, const ResistanceRootsOf<Real>& root,
                                                      const PairGeometryOf<Real>& pair,
                                                      const Vector3Of<Real>& theta,
                                                      const Vector3Of<Real>& chi) {
  const Vector3Of<Real>& n = pair.normal;
  const Real along = dot(theta, n);
  const Vector3Of<Real> turned = cross(theta, n);
  const Vector3Of<Real> spun = across(chi, n);
  const Real c{amplitude};
  return {c * ((root.squeeze * along) * n + root.shear * (theta - along * n)),
          c * (root.pump_first * turned + root.spin_first * spun),
          c * (root.pump_second * turned - root.spin_second * spun)};
}

}  // namespace peclet::engine
