// pair_resistance() gives the resistance of two near spheres: the one source of lubrication forces, pairwise
// noise and implicit matrices.
//
// Its modes are squeeze (X_A), shear (Y_A), pump (Y_B) and twist (Y_C). Li, Royer & Ness (2023), eqs. 9-12
// and 15-18, take them from Kim & Karrila; the viscosity is inside the coefficients. With L = ln(1/xi) and
// beta = a_j / a_i:
//   X_A   = 6 pi eta a_i [2 beta^2/(1+beta)^3 / xi + beta (1 + 7 beta + beta^2)/(5 (1+beta)^3) L]
//   Y_A   = 6 pi eta a_i 4 beta (2 + beta + 2 beta^2)/(15 (1+beta)^3) L
//   Y_B11 = -4 pi eta a_i^2 beta (4 + beta)/(5 (1+beta)^2) L           Y_B21: i and j exchanged
//   Y_C11 = 8 pi eta a_i^3 2 beta/(5 (1+beta)) L                        Y_C22: i and j exchanged
//   Y_C12 = 8 pi eta a_i^3 beta^2/(10 (1+beta)) L
// Corrected against the print: Y_B is multiplied by q = r/(a_i + a_j) and Y_C by q^2. Only then is a rigid
// rotation of the pair free at any gap; the matrix stays symmetric, positive semidefinite, of rank five.
// Below the inner gap, also in overlap, the coefficients keep their value there (q does not). Beyond the
// outer gap there is no lubrication: the coefficients jump to zero. The form mari has these modes, X_A
// without L, at another gap and with q = 1.
#pragma once

#include <cmath>
#include <numbers>

#include "engine/terms/pair.h"

namespace peclet::engine {

// LubricationParameters say at which distances two spheres are lubricated, and at which gap x their
// resistance is taken. With xi = 2 (r - a_i - a_j) / (a_i + a_j):
//   form         x         at least x_min  up to                             lever q
//   kim-karrila  xi        inner gap       xi = outer gap                    r / (a_i + a_j)
//   mari         xi + eps  eps             r = a_i + a_j + outer distance    1
// kim-karrila is the form of Li, Royer & Ness (2023). mari is that of Monti, Rathee, Shen & Rosti (2021),
// Phys. Fluids 33, 103314, eqs. A.6 and A.7. Their d = xi + eps is max(xi, 0) + eps here, because it vanishes
// in overlap as printed. Its X_A has no logarithm; its velocities are relative to the flow
// (strained_lubrication.h).
struct LubricationParameters {
  enum class Form { kim_karrila, mari };

  double inner_gap = 1e-3;  // mari: the regularisation eps
  double outer_gap = 0.05;  // kim-karrila
  Form form = Form::kim_karrila;
  double outer_distance = 0;  // mari: surface distance [length]

  bool is_relative_to_flow() const { return form == Form::mari; }
};

// Returns the surface distance at which lubrication ends [length].
inline double outer_distance(const LubricationParameters& lubrication, double sum_of_radii) {
  return lubrication.form == LubricationParameters::Form::mari ? lubrication.outer_distance
                                                               : 0.5 * lubrication.outer_gap * sum_of_radii;
}

// Returns the centre distance at which lubrication ends [length].
inline double lubrication_range(const LubricationParameters& lubrication, double sum_of_radii) {
  return lubrication.form == LubricationParameters::Form::mari
             ? sum_of_radii + lubrication.outer_distance
             : sum_of_radii * (1 + 0.5 * lubrication.outer_gap);
}

// LubricatedGap gives the gap x and the lever q of all pairs of two radii.
struct LubricatedGap {
  double per_distance, shift;                      // x = per_distance (r - a_i - a_j) + shift
  double inner, outer;                             // bounds of x
  double inner_logarithm, outer_logarithm;         // L = ln(1/x) at these
  double lever_per_distance, lever_at_distance_0;  // q = lever_per_distance r + lever_at_distance_0
  double outer_distance;                           // surface distance at `outer`
};

inline LubricatedGap lubricated_gap(const LubricationParameters& lubrication, double sum_of_radii) {
  const bool is_mari = lubrication.form == LubricationParameters::Form::mari;
  const double per_distance = 2 / sum_of_radii, inner = lubrication.inner_gap;
  const double outer = is_mari ? per_distance * lubrication.outer_distance + inner : lubrication.outer_gap;
  return {.per_distance = per_distance,
          .shift = is_mari ? inner : 0,
          .inner = inner,
          .outer = outer,
          .inner_logarithm = -std::log(inner),
          .outer_logarithm = -std::log(outer),
          .lever_per_distance = is_mari ? 0 : 1 / sum_of_radii,
          .lever_at_distance_0 = is_mari ? 1.0 : 0.0,
          .outer_distance = outer_distance(lubrication, sum_of_radii)};
}

// ResistanceConstants are the coefficients of 1/x and of L, which depend on the two radii alone.
struct ResistanceConstants {
  double squeeze_inverse, squeeze_logarithm;      // X_A
  double shear;                                   // Y_A
  double pump_first, pump_second;                 // Y_B11, Y_B21
  double twist_first, twist_cross, twist_second;  // Y_C11, Y_C12, Y_C22
};

inline ResistanceConstants resistance_constants(
    double viscosity, double radius_first, double radius_second,
    LubricationParameters::Form form = LubricationParameters::Form::kim_karrila) {
  const double b = radius_second / radius_first, c = 1 / b;
  const double one = 1 + b, cube = one * one * one;
  const double pi_eta = std::numbers::pi * viscosity;
  const double six = 6 * pi_eta * radius_first;
  const double eight = 8 * pi_eta * radius_first * radius_first * radius_first;
  return {
      .squeeze_inverse = six * 2 * b * b / cube,
      .squeeze_logarithm =
          form == LubricationParameters::Form::mari ? 0 : six * b * (1 + 7 * b + b * b) / (5 * cube),
      .shear = six * 4 * b * (2 + b + 2 * b * b) / (15 * cube),
      .pump_first = -4 * pi_eta * radius_first * radius_first * b * (4 + b) / (5 * one * one),
      .pump_second = -4 * pi_eta * radius_second * radius_second * c * (4 + c) / (5 * (1 + c) * (1 + c)),
      .twist_first = eight * 2 * b / (5 * one),
      .twist_cross = eight * b * b / (10 * one),
      .twist_second = 8 * pi_eta * radius_second * radius_second * radius_second * 2 * c / (5 * (1 + c)),
  };
}

// ResistanceModesOf are the functions of the distance that pair_resistance() and resistance_roots() share.
template <class Real>
struct ResistanceModesOf {
  Real inverse;    // 1/x
  Real logarithm;  // L
  Real lever;      // q
};

// Returns the lever q. Requires the form kim-karrila, which has no shifts, if `shifted` is false.
template <bool shifted = true, class Real>
PECLET_ALWAYS_INLINE Real lever_of(const LubricatedGap& gap, const PairGeometryOf<Real>& pair) {
  const Real lever = gap.lever_per_distance * pair.distance;
  if constexpr (shifted) return lever + gap.lever_at_distance_0;
  return lever;
}

// Returns the gap x, before it is bounded by x_min. `shifted` is as above.
template <bool shifted = true, class Real>
PECLET_ALWAYS_INLINE Real gap_of(const LubricatedGap& gap, const PairGeometryOf<Real>& pair) {
  const Real here = gap.per_distance * pair.surface_distance();
  if constexpr (shifted) return here + gap.shift;
  return here;
}

// Returns the modes of a pair. 1/x and L are zero beyond `range`, a centre distance.
template <bool shifted = true, class Real>
PECLET_ALWAYS_INLINE ResistanceModesOf<Real> resistance_modes(const LubricatedGap& gap, double range,
                                                              const PairGeometryOf<Real>& pair) {
  const Real here = larger(gap_of<shifted>(gap, pair), Real{gap.inner});
  const Real inverse = 1.0 / here;
  const auto lubricated = pair.distance <= range;
  return {select(lubricated, inverse, Real{0.0}), select(lubricated, logarithm(inverse), Real{0.0}),
          lever_of<shifted>(gap, pair)};
}

template <class Real>
struct PairResistanceOf {
  Real squeeze;
  Real shear;
  Real pump_first, pump_second;
  Real twist_first, twist_cross, twist_second;
};

template <class Real>
PECLET_ALWAYS_INLINE PairResistanceOf<Real> pair_resistance(const ResistanceConstants& k,
                                                            const ResistanceModesOf<Real>& mode) {
  const Real pump = mode.lever * mode.logarithm, twist = mode.lever * pump;
  return {
      .squeeze = k.squeeze_inverse * mode.inverse + k.squeeze_logarithm * mode.logarithm,
      .shear = k.shear * mode.logarithm,
      .pump_first = k.pump_first * pump,
      .pump_second = k.pump_second * pump,
      .twist_first = k.twist_first * twist,
      .twist_cross = k.twist_cross * twist,
      .twist_second = k.twist_second * twist,
  };
}

template <class Real>
PECLET_ALWAYS_INLINE PairResistanceOf<Real> scaled(const Real& weight, const PairResistanceOf<Real>& part) {
  return {weight * part.squeeze,     weight * part.shear,       weight * part.pump_first,
          weight * part.pump_second, weight * part.twist_first, weight * part.twist_cross,
          weight * part.twist_second};
}

template <class Real>
PECLET_ALWAYS_INLINE void add_scaled(PairResistanceOf<Real>& sum, const Real& weight,
                                     const PairResistanceOf<Real>& part) {
  sum.squeeze += weight * part.squeeze;
  sum.shear += weight * part.shear;
  sum.pump_first += weight * part.pump_first;
  sum.pump_second += weight * part.pump_second;
  sum.twist_first += weight * part.twist_first;
  sum.twist_cross += weight * part.twist_cross;
  sum.twist_second += weight * part.twist_second;
}

// Returns the resistance of a pair. Requires it to be within the range.
inline PairResistanceOf<double> pair_resistance(const ResistanceConstants& k, const LubricatedGap& gap,
                                                const PairGeometry& pair) {
  return pair_resistance(k, resistance_modes(gap, pair.distance, pair));
}

// ResistanceRootsOf is a square root of the resistance, from which the noise of a pair is made:
//   sqrt(X_A), sqrt(Y_A), Y_B11 / sqrt(Y_A), Y_B21 / sqrt(Y_A),
//   sqrt(Y_C11 - Y_B11^2 / Y_A), sqrt(Y_C22 - Y_B21^2 / Y_A).
// All but the first are sqrt(L) times powers of q and constants, so a pair needs two roots.
template <class Real>
struct ResistanceRootsOf {
  Real squeeze;
  Real shear;
  Real pump_first, pump_second;
  Real spin_first, spin_second;
};

// The constants of the roots. The last two are real for every size ratio: their square is
// 6 pi eta a_i^3 beta^3 / ((1 + beta)(2 + beta + 2 beta^2)).
struct RootConstants {
  double shear;
  double pump_first, pump_second;
  double spin_first, spin_second;
};

inline RootConstants root_constants(const ResistanceConstants& k) {
  return {.shear = std::sqrt(k.shear),
          .pump_first = k.pump_first / std::sqrt(k.shear),
          .pump_second = k.pump_second / std::sqrt(k.shear),
          .spin_first = std::sqrt(k.twist_first - k.pump_first * k.pump_first / k.shear),
          .spin_second = std::sqrt(k.twist_second - k.pump_second * k.pump_second / k.shear)};
}

template <class Real>
PECLET_ALWAYS_INLINE ResistanceRootsOf<Real> resistance_roots(const RootConstants& k, const Real& squeeze,
                                                              const ResistanceModesOf<Real>& mode) {
  const Real root = square_root(mode.logarithm), turning = mode.lever * root;
  return {.squeeze = square_root(squeeze),
          .shear = k.shear * root,
          .pump_first = k.pump_first * turning,
          .pump_second = k.pump_second * turning,
          .spin_first = k.spin_first * turning,
          .spin_second = k.spin_second * turning};
}

using ResistanceModes = ResistanceModesOf<double>;
using PairResistance = PairResistanceOf<double>;
using ResistanceRoots = ResistanceRootsOf<double>;

// Returns the Brownian force and torques of a lubricated pair. theta and chi are standard normal vectors, the
// amplitude is c = sqrt(2 kT / dt), and T = 1 - n n:
//   F_i = c (sqrt(X_A) n n + sqrt(Y_A) T).theta
//   T_i = c [Y_B11 / sqrt(Y_A) theta x n + sqrt(Y_C11 - Y_B11^2 / Y_A) T.chi]
//   T_j = c [Y_B21 / sqrt(Y_A) theta x n - sqrt(Y_C22 - Y_B21^2 / Y_A) T.chi]
// Li, Royer & Ness (2023) eqs. 22-24 and 28. Eq. 24 prints a plus in the last line; only the minus makes the
// covariance of the six components equal to 2 kT R / dt.
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
