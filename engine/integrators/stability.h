// These functions give stable explicit steps of a scene, and implicit steps whose error has been measured.
#pragma once

#include <limits>

#include "engine/scene/scene.h"

namespace peclet::engine {

// Timestep is a step [time] and what keeps it from being longer, in a word.
struct Timestep {
  double value = std::numeric_limits<double>::infinity();
  const char* limit = "";

  void stay_below(double bound, const char* name) {
    if (bound < value) *this = {bound, name};
  }
};

// PairRates holds the fastest modes of the stiffest pair of a scene, at the inner gap and in contact.
struct PairRates {
  // Damping rate l [1/time]: (X_A + gamma_n)(1/m_i + 1/m_j) plus the larger zeta/m; or the rate of spins, if
  // larger.
  double damping;
  // Squared frequency w^2 [1/time^2]: k (1/m_i + 1/m_j), k the largest stiffness of contact springs plus that
  // of the conservative laws at surface distances from 0 on.
  double frequency_squared;
};

PairRates stiffest_pair(const Scene& scene);

// The largest eigenvalue of M^-1 R in the densest packings, over that of one pair (2.1 at volume fraction
// 0.45). Contacts stay below this factor.
constexpr double packing_factor = 2.8;

// Returns the largest stable explicit step [time]: the root of w^2 dt^2 + 2 l dt = 4, with l and w^2 of the
// stiffest pair times packing_factor.
double largest_timestep(const Scene& scene);

// Returns the automatic implicit step [time], the smallest of these bounds; infinity if none applies.
// - strain / (rate (1 + 2 St)) and times X_A / k. St is the largest rho a^2 rate / eta of all species. In the
//   time X_A / k lubrication at the inner gap holds up the stiffest contact and conservative law. The flow
//   presses pairs through the gaps of lubrication in many steps; inertia is of first order only.
//     scene                           strain                                                  times
//     plain                           0.01; for phi > 0.6 0.2 (0.65 - phi), at least 0.002    20
//     noise                           0.01 (0.1 / (Pe xi))^0.3, from 0.005 to the plain one   7
//     conservative laws               0.005                                                   5
//     friction                        0.005                                                   4
//     friction, conservative laws     0.005                                                   2
//     friction > 1, kinetic friction  0.0025                                                  2
//     friction with rolling or noise  0.0025                                                  2
//   Pe is the Peclet number of the smallest radius, xi the inner gap.
// - 0.0045 eta a^3 / kT, without lubrication 0.0017, a the smallest radius. Noise moves pairs through the
//   gaps of lubrication in many steps.
// - 20 drag / k of the conservative laws beyond the outer gap, where only the drag of single spheres resists
//   them. Larger steps throw the spheres of unbalanced packings apart.
// - Resistance / -V'' where the conservative laws together attract: the time in which the approach of a pair
//   grows e-fold. Steps are explicit in that part.
// - With noise and lubrication, the longest step in which inertia carries spheres across the outer gap
//   (terms/lubrication.h). If it is shorter, two other bounds replace it and 0.0045 eta a^3 / kT: 0.0017 eta
//   a^3 / kT, and the step in which five standard deviations of a leap out of the range of lubrication are
//   twice the outer gap. Either way spheres that were out of range are not hit.
//
// The step is said to be limited by: the flow (strain), contacts (times X_A / k), repulsion (drag / k),
// attraction, noise, or inertia (which carries spheres across the outer gap).
Timestep automatic_implicit_timestep(const Scene& scene);

// The largest ratio of a given implicit step to the automatic one. Warnings tell the error of steps above the
// automatic one: half steps without noise, the step itself with noise.
constexpr double largest_over_automatic = 4;

// Returns the meaning of "auto": half of the largest explicit step, or the automatic implicit one.
Timestep automatic_timestep(const Scene& scene);

// Returns the scene's own step or the automatic one. Throws InputError if the step is too large or infinite.
Timestep resolved_timestep(const Scene& scene, const std::string& file);

}  // namespace peclet::engine
