// The longest step in which inertia holds the spheres of a pair that leaves the range of lubrication.
#pragma once

#include <algorithm>
#include <cmath>

#include "engine/terms/drag.h"
#include "engine/terms/lubrication.h"

namespace peclet::engine {

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
