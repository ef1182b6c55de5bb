// lubrication_load() gives the lubrication forces of a pair from its resistance.
#pragma once

#include <algorithm>
#include <cmath>

#include "engine/terms/drag.h"
#include "engine/terms/pair_resistance.h"

namespace peclet::engine {

// Returns the load on both spheres, with U = U_j - U_i and T = 1 - n n:
//   F_i = (X_A n n + Y_A T).U + Y_B11 Omega_i x n + Y_B21 Omega_j x n
//   T_i = Y_B11 U x n - T.(Y_C11 Omega_i + Y_C12 Omega_j)
//   T_j = Y_B21 U x n - T.(Y_C12 Omega_i + Y_C22 Omega_j)
// Li, Royer & Ness (2023) eqs. 8, 13, 14. Velocities are those of the laboratory: U has the rate of strain.
template <class Real>
PECLET_ALWAYS_INLINE PairLoadOf<Real> lubrication_load(const PairResistanceOf<Real>& R,
                                                       const PairGeometryOf<Real>& pair,
                                                       const PairMotionOf<Real>& motion) {
  using Vector = Vector3Of<Real>;
  const Vector& n = pair.normal;
  const Real closing = dot(motion.velocity, n);
  const Vector sliding = motion.velocity - closing * n;
  const Vector pumped = R.pump_first * motion.spin_first + R.pump_second * motion.spin_second;
  const Vector turned = cross(motion.velocity, n);
  const Vector twisted_first = R.twist_first * motion.spin_first + R.twist_cross * motion.spin_second;
  const Vector twisted_second = R.twist_cross * motion.spin_first + R.twist_second * motion.spin_second;
  return {(R.squeeze * closing) * n + R.shear * sliding + cross(pumped, n),
          R.pump_first * turned - across(twisted_first, n),
          R.pump_second * turned - across(twisted_second, n)};
}

// SphereLoadOf is the load on a sphere at rest by the motion of the other sphere, at velocity U and spin
// Omega: lubrication_load() without the terms that are zero.
template <class Real>
struct SphereLoadOf {
  Vector3Of<Real> force, torque;
};

template <class Real>
PECLET_ALWAYS_INLINE SphereLoadOf<Real> load_on_first(const PairResistanceOf<Real>& R,
                                                      const Vector3Of<Real>& n, const Vector3Of<Real>& U,
                                                      const Vector3Of<Real>& Omega) {
  const Vector3Of<Real> along = dot(U, n) * n;
  return {R.squeeze * along + R.shear * (U - along) + R.pump_second * cross(Omega, n),
          R.pump_first * cross(U, n) - R.twist_cross * across(Omega, n)};
}

template <class Real>
PECLET_ALWAYS_INLINE SphereLoadOf<Real> load_on_second(const PairResistanceOf<Real>& R,
                                                       const Vector3Of<Real>& n, const Vector3Of<Real>& U,
                                                       const Vector3Of<Real>& Omega) {
  const Vector3Of<Real> along = dot(U, n) * n, turned = cross(n, Omega);
  return {R.squeeze * along + R.shear * (U - along) + R.pump_first * turned,
          R.pump_second * cross(n, U) - R.twist_cross * across(Omega, n)};
}

// Returns the longest step [time] in which inertia holds spheres of this radius and mass when a pair leaves
// the range of lubrication: the smaller of
// - 2 h_o / (5 sqrt(2 kT / m)) with the outer distance h_o of two such spheres, xi_o a of kim-karrila.
//   Thermal velocities of five standard deviations then bring a third sphere nearer by at most twice the
//   outer gap, so that it is not overlapped unseen;
// - 4 m / zeta. Drag then multiplies a velocity by no less than -1/3 in a step.
inline double longest_inertial_step(double viscosity, double thermal_energy,
                                    const LubricationParameters& lubrication, double radius, double mass) {
  constexpr double deviations = 5, decay_times = 4;
  const double drag = translational_drag(viscosity, radius);
  return std::min(
      2 * outer_distance(lubrication, 2 * radius) / (deviations * std::sqrt(2 * thermal_energy / mass)),
      decay_times * mass / drag);
}

}  // namespace peclet::engine
