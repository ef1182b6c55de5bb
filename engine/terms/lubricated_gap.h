// Between which distances two spheres are lubricated, and the gap that their resistance is a function of.
//
// xi = 2 (r - a_i - a_j) / (a_i + a_j). The forms have the resistance of terms/pair_resistance.h at the gap
// x, not below x_min:
//   kim-karrila  x = xi, x_min = inner gap, up to xi = outer gap; Li, Royer & Ness (2023). With the lever
//                q = r / (a_i + a_j), see pair_resistance.h.
//   mari         x = xi + eps, x_min = eps, up to r = a_i + a_j + outer distance; Monti, Rathee, Shen & Rosti
//                (2021), Phys. Fluids 33, 103314, eqs. A.6 and A.7, whose d = xi + eps is max(xi, 0) + eps
//                here: as printed it vanishes in overlap. X_A has no logarithm, the lever is 1: velocities
//                are relative to the flow (terms/strained_lubrication.h).
#pragma once

#include <cmath>

namespace peclet::engine {

struct LubricationParameters {
  enum class Form { kim_karrila, mari };

  double inner_gap = 1e-3;  // of mari: the regularisation eps
  double outer_gap = 0.05;  // of kim-karrila
  Form form = Form::kim_karrila;
  double outer_distance = 0;  // of mari, between the surfaces

  bool is_relative_to_flow() const { return form == Form::mari; }
};

// Between the surfaces, where lubrication ends.
inline double outer_distance(const LubricationParameters& lubrication, double sum_of_radii) {
  return lubrication.form == LubricationParameters::Form::mari ? lubrication.outer_distance
                                                               : 0.5 * lubrication.outer_gap * sum_of_radii;
}

// The same as a distance of the centres.
inline double lubrication_range(const LubricationParameters& lubrication, double sum_of_radii) {
  return lubrication.form == LubricationParameters::Form::mari
             ? sum_of_radii + lubrication.outer_distance
             : sum_of_radii * (1 + 0.5 * lubrication.outer_gap);
}

// Of all pairs of two radii.
struct LubricatedGap {
  double per_distance, shift;                      // x = per_distance (r - a_i - a_j) + shift
  double inner, outer;                             // of x
  double inner_logarithm, outer_logarithm;         // L = ln(1/x) there
  double lever_per_distance, lever_at_distance_0;  // q as a function of r
  double outer_distance;                           // between the surfaces
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

}  // namespace peclet::engine
