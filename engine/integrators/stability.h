// The steps that a scene allows: of explicit ones the largest that is stable, of implicit ones those whose
// error has been looked at.
#pragma once

#include "engine/scene/scene.h"

namespace peclet::engine {

// Fastest modes of the stiffest pair of the scene, at the inner gap and in contact.
struct PairRates {
  // 1/time: (X_A + gamma_n)(1/m_i + 1/m_j) plus the drag of the lighter sphere; the rate of its spin if that
  // is larger.
  double damping;
  // 1/time^2: stiffness (1/m_i + 1/m_j) of the normal, tangential and rolling springs and, added to it, the
  // largest one of the conservative laws at surface distances from 0 on.
  double frequency_squared;
};

PairRates stiffest_pair(const Scene& scene);

// In the densest packings the largest eigenvalue of M^-1 R is 2.8 times that of one pair (2.1 at volume
// fraction 0.45); contacts stay below the same factor.
constexpr double packing_factor = 2.8;

// Largest stable explicit step: root of w^2 dt^2 + 2 l dt = 4 with l and w^2 those of the stiffest pair times
// packing_factor.
double largest_timestep(const Scene& scene);

// The automatic implicit step, the smallest of these:
// - A strain over rate (1 + 2 St), St the largest rho a^2 rate / eta of all species, and a multiple of
//   X_A / k, the time in which lubrication at the inner gap holds up the stiffest contact and conservative
//   law:
//     0.01 (above a volume fraction phi of 0.6: 0.2 (0.65 - phi), at least 0.002) and 20;
//     with noise 0.01 (0.1 / (Pe xi))^0.3, no less than 0.005 and no more than without noise, and 7; Pe is
//     the Peclet number of the smallest radius, xi the inner gap;
//     with conservative laws 0.005 and 5;
//     with friction 0.005 and 4, with conservative laws too 2;
//     with friction above 1 or kinetic friction, friction and rolling, or friction and noise 0.0025 and 2.
//   Pairs that the flow presses together pass through the gaps of lubrication in many steps; inertia is of
//   first order only.
// - 0.0045 eta a^3 / kT, a the smallest radius, without lubrication 0.0017. Noise moves a pair through these
//   gaps in many steps, too.
// - 20 drag / k of the conservative laws from the outer gap on, where the drag of single spheres alone
//   resists them. Larger steps throw the spheres of unbalanced packings apart.
// - Resistance / -V'' where the conservative laws together attract: the time in which the approach of a pair
//   grows e-fold. Steps are explicit in that part.
// - With noise and lubrication, the longest step in which inertia carries the spheres across the outer gap
//   (terms/lubrication.h). Where this makes it shorter, instead of it and of 0.0045 eta a^3 / kT: 0.0017
//   eta a^3 / kT and the step at which five standard deviations of a leap out of the range of lubrication are
//   twice the outer gap. Either way no sphere is hit that was out of range before.
// A scene without flow and temperature has those of contact and repulsion alone. Infinite where nothing sets
// a time.
double automatic_implicit_timestep(const Scene& scene);

// A given implicit step may be that many times the automatic one. Errors of larger steps have a flag of their
// own: half steps without noise, and with it the step itself, beyond the automatic one.
constexpr double largest_over_automatic = 4;

// What "auto" means: half of the largest step, or the automatic implicit one.
double automatic_timestep(const Scene& scene);

// The scene's own step or the automatic one. Throws InputError when the given one is too large, or none sets
// an automatic one.
double resolved_timestep(const Scene& scene, const std::string& file);

}  // namespace peclet::engine
