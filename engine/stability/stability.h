// The steps that a scene allows: of explicit ones the largest that is stable, of implicit ones those whose
// error has been looked at.
#pragma once

#include "engine/scene/scene.h"

namespace peclet::engine {

// Fastest modes of the stiffest pair of the scene, at the inner gap and in contact.
struct PairRates {
  double damping;            // 1/time: (X_A + gamma_n)(1/m_i + 1/m_j) plus the drag of the lighter sphere,
                             // or the like of its spin where that is more
  double frequency_squared;  // 1/time^2: stiffness (1/m_i + 1/m_j), of the normal, tangential and rolling
                             // springs and the repulsion
};

PairRates stiffest_pair(const Scene& scene);

// In the densest packings the largest eigenvalue of M^-1 R is 2.8 times that of one pair (2.1 at volume
// fraction 0.45); contacts stay below the same factor.
constexpr double packing_factor = 2.8;

// Largest stable explicit step: root of w^2 dt^2 + 2 l dt = 4 with l and w^2 those of the stiffest pair times
// packing_factor.
double largest_timestep(const Scene& scene);

// Of implicit steps. The least of
//   0.005 or, with friction, 0.0025 / (rate (1 + 2 St)), St = rho a^2 rate / eta with the largest radius:
//   pairs that the flow presses together pass through the gaps of lubrication in many steps; sliding contacts
//   and inertia are of first order only;
//   0.0017 eta a^3 / kT, a the smallest radius: so does a displacement by the noise;
//   2 or, without friction, 5 times the time X_A / k in which lubrication at the inner gap holds up the
//   stiffest contact or repulsion;
//   20 times drag / k of the repulsion at the outer gap, where the drag of single spheres alone resists it:
//   beyond that packings that start unbalanced throw their spheres apart;
//   with noise and lubrication, that at which five standard deviations of a leap out of the range of
//   lubrication are twice the outer gap, so that no third sphere is hit that was out of the range before.
// Without flow and temperature those of contact and repulsion alone; infinite where nothing sets a time.
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
