// Lubrication of the motion relative to the flow, and by the rates of strain at both spheres: the form mari.
//
// Monti, Rathee, Shen & Rosti (2021), Phys. Fluids 33, 103314, eq. 3 and A.1 to A.7, with 6 pi eta in the
// coefficients, Y_C across n and n_perp = 2 n x (E n). With u and w the velocities and spins relative to the
// flow at the centres, E_i and E_j its rates of strain there and R of terms/pair_resistance.h, their X_G, Y_G
// and Y_H are those of R times lengths (Y_G / Y_A and so on): the pair feels the load of R at the velocity
//   u_j - u_i + l_i E_i n + l_j E_j n
// and at the spins w, with the lengths, of j i and j exchanged, beta = a_j / a_i,
//   squeezing         l_i = a_i
//   sliding           l_i = a_i (4 - beta + 7 beta^2) / (2 (2 + beta + 2 beta^2))
//   torque on i       l_i = 2 a_i (2 - beta) / (4 + beta)    l_j = a_j (7 + beta) / (4 + beta)
//   torque on j       l_j = 2 a_j (2 - 1/beta) / (4 + 1/beta)    l_i = a_i (7 + 1/beta) / (4 + 1/beta)
// In each line they add up to a_i + a_j. So in a uniform flow, E_i = E_j = E, the velocity is
//   U_j - U_i - Omega_inf x r - (r - a_i - a_j) E n.
// E has no trace.
#pragma once

#include "engine/terms/lubrication.h"

namespace peclet::engine {

// The uniform part of the flow; what varies within the cell comes with each pair.
struct FlowFrame {
  bool varies = false;
  Vector3 spin;
  SymmetricTensor strain;
};

// What varies, at the centres of a pair.
template <class Real>
struct PairVariationOf {
  Vector3Of<Real> velocity;  // that at j less that at i
  Vector3Of<Real> spin_first, spin_second;
  SymmetricTensorOf<Real> strain_first, strain_second;
};

// By which E n is multiplied, of the first and of the second sphere.
struct StrainLengths {
  double squeeze_first, squeeze_second;
  double shear_first, shear_second;
  double turn_first[2], turn_second[2];  // in the torques on the first sphere and on the second one
};

inline StrainLengths strain_lengths(double radius_first, double radius_second) {
  const auto sliding = [](double a, double b) { return a * (4 - b + 7 * b * b) / (2 * (2 + b + 2 * b * b)); };
  const auto own = [](double a, double b) { return 2 * a * (2 - b) / (4 + b); };
  const auto other = [](double a, double b) { return a * (7 + b) / (4 + b); };
  const double i = radius_first, j = radius_second, b = j / i, c = i / j;
  return {.squeeze_first = i,
          .squeeze_second = j,
          .shear_first = sliding(i, b),
          .shear_second = sliding(j, c),
          .turn_first = {own(i, b), other(j, b)},
          .turn_second = {other(i, c), own(j, c)}};
}

template <class Number, class Real>
PECLET_ALWAYS_INLINE Vector3Of<Real> strained(const SymmetricTensorOf<Number>& e, const Vector3Of<Real>& n) {
  return {e.xx * n.x + e.xy * n.y + e.xz * n.z, e.xy * n.x + e.yy * n.y + e.yz * n.z,
          e.xz * n.x + e.yz * n.y + e.zz * n.z};
}

// `motion` in the laboratory frame; `varying` counts where the flow varies. Not inlined: one copy serves all
// recipes.
template <class Real>
[[gnu::noinline]] PairLoadOf<Real> strained_lubrication_load(const PairResistanceOf<Real>& R,
                                                             const FlowFrame& flow,
                                                             const StrainLengths& length,
                                                             const PairGeometryOf<Real>& pair,
                                                             const PairMotionOf<Real>& motion,
                                                             const PairVariationOf<Real>& varying) {
  using Vector = Vector3Of<Real>;
  const Vector& n = pair.normal;
  const Vector spin = {Real{flow.spin.x}, Real{flow.spin.y}, Real{flow.spin.z}};
  PairMotionOf<Real> relative = {
      motion.velocity - cross(spin, pair.separation) - pair.surface_distance() * strained(flow.strain, n),
      motion.spin_first - spin, motion.spin_second - spin};
  if (!flow.varies) return lubrication_load(R, pair, relative);
  relative.velocity -= varying.velocity;
  relative.spin_first -= varying.spin_first;
  relative.spin_second -= varying.spin_second;
  PairLoadOf<Real> load = lubrication_load(R, pair, relative);
  const Vector first = strained(varying.strain_first, n), second = strained(varying.strain_second, n);
  const auto sum = [&](double of_first, double of_second)
                       PECLET_INLINE_LAMBDA { return Real{of_first} * first + Real{of_second} * second; };
  const Real closing = dot(sum(length.squeeze_first, length.squeeze_second), n);
  const Vector sliding = across(sum(length.shear_first, length.shear_second), n);
  load.force += (R.squeeze * closing) * n + R.shear * sliding;
  load.torque_first += R.pump_first * cross(sum(length.turn_first[0], length.turn_first[1]), n);
  load.torque_second += R.pump_second * cross(sum(length.turn_second[0], length.turn_second[1]), n);
  return load;
}

}  // namespace peclet::engine
