// Lubrication forces from the resistance of a pair.
#pragma once

#include <algorithm>
#include <cmath>

#include "engine/terms/drag.h"
#include "engine/terms/pair_resistance.h"

namespace peclet::engine {

// With U = U_j - U_i, T = 1 - n n:
//   F_i = (X_A n n + Y_A T).U + Y_B11 Omega_i x n + Y_B21 Omega_j x n
//   T_i = Y_B11 U x n - T.(Y_C11 Omega_i + Y_C12 Omega_j)
//   T_j = Y_B21 U x n - T.(Y_C12 Omega_i + Y_C22 Omega_j)
// Li, Royer & Ness (2023) eqs. 8, 13, 14. Laboratory velocities: the rate of strain is in U already.
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

// What the motion of one sphere of a pair, at velocity U and spin Omega, does to the other one that rests:
// lubrication_load() without all that is zero, and the other sphere's part of it.
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

// The longest step in which inertia holds the spheres of a pair that leaves the range of lubrication.
//
// Of spheres with this radius and mass (of one density the smallest ones bound the step): the least of
// - 2 h_o / (5 sqrt(2 kT / m)), h_o the outer distance of two of them, of kim-karrila xi_o a: thermal
//   velocities close the distance of a sphere and a third one, in five standard deviations, by no more than
//   twice the outer gap, so that none is overlapped unseen;
// - 4 m / zeta: the velocity's sign changes from step to step by no more than a third.
inline double longest_inertial_step(double viscosity, double thermal_energy,
                                    const LubricationParameters& lubrication, double radius, double mass) {
  constexpr double deviations = 5, decay_times = 4;
  const double drag = translational_drag(viscosity, radius);
  return std::min(
      2 * outer_distance(lubrication, 2 * radius) / (deviations * std::sqrt(2 * thermal_energy / mass)),
      decay_times * mass / drag);
}

}  // namespace peclet::engine
