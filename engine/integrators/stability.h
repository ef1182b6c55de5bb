// The largest step of the explicit integrator that a scene allows.
#pragma once

#include "engine/scene.h"

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

// Largest stable step: root of w^2 dt^2 + 2 l dt = 4 with l and w^2 those of the stiffest pair times
// packing_factor.
double largest_timestep(const Scene& scene);

// What "auto" means: half of that.
double automatic_timestep(const Scene& scene);

// The scene's own step or the automatic one. Throws InputError when the given one is beyond the largest.
double resolved_timestep(const Scene& scene, const std::string& file);

}  // namespace peclet::engine
