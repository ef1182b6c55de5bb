// strained_lubrication_load() gives the lubrication of the motion relative to the flow, and by the rates of
// strain at both spheres: the form mari.
//
// It follows Monti, Rathee, Shen & Rosti (2021), Phys. Fluids 33, 103314, eqs. 3 and A.1 to A.7, with 6 pi
// eta in the coefficients, Y_C across n and n_perp = 2 n x (E n). u and w are velocities and spins relative
// to the flow at the centres, E_i and E_j its rates of strain there (without trace). Their X_G, Y_G and Y_H
// are the coefficients of the resistance R (pair_resistance.h) times lengths. So the load is that of R at the
// spins w and the velocity
//   u_j - u_i + l_i E_i n + l_j E_j n
// with beta = a_j / a_i and the lengths
//   squeezing     l_i = a_i                                                      l_j: i and j exchanged
//   sliding       l_i = a_i (4 - beta + 7 beta^2) / (2 (2 + beta + 2 beta^2))    l_j: i and j exchanged
//   torque on i   l_i = 2 a_i (2 - beta) / (4 + beta)           l_j = a_j (7 + beta) / (4 + beta)
//   torque on j   l_i = a_i (7 + 1/beta) / (4 + 1/beta)         l_j = 2 a_j (2 - 1/beta) / (4 + 1/beta)
// The lengths of a line add up to a_i + a_j. In a uniform flow, E_i = E_j = E, the velocity is therefore
//   U_j - U_i - Omega_inf x r - (r - a_i - a_j) E n.
#pragma once

#include "engine/terms/lubrication.h"

namespace peclet::engine {

// FlowFrame is the uniform part of the flow. `varies` is true if pairs have a PairVariationOf.
struct FlowFrame {
  bool varies = false;
  Vector3 spin;
  SymmetricTensor strain;
};

// PairVariationOf is the non-uniform part of the flow at the centres of a pair.
template <class Real>
struct PairVariationOf {
  Vector3Of<Real> velocity;  // value at j less that at i
  Vector3Of<Real> spin_first, spin_second;
  SymmetricTensorOf<Real> strain_first, strain_second;
};

// The lengths l_i (first) and l_j (second) by which E n is multiplied.
struct StrainLengths {
  double squeeze_first, squeeze_second;
  double shear_first, shear_second;
  double turn_first[2], turn_second[2];  // {l_i, l_j} of the torques on the first and the second sphere
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

// Returns e n.
template <class Number, class Real>
PECLET_ALWAYS_INLINE Vector3Of<Real> strained(const SymmetricTensorOf<Number>& e, const Vector3Of<Real>& n) {
  return {e.xx * n.x + e.xy * n.y + e.xz * n.z, e.xy * n.x + e.yy * n.y + e.yz * n.z,
          e.xz * n.x + e.yz * n.y + e.zz * n.z};
}

// Returns the load. `motion` is in the laboratory frame; `varying` is read if the flow varies. It is not
// inlined, so that one copy serves all recipes.
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
