// Spheres in a flow whose gradient changes, or stretches them with the fluid.
//
// The solvent at x has the acceleration (dL/dt + L L) x, and what accelerates it accelerates spheres of its
// density as well: its pressure. A force m (dL/dt + L L) x and a torque of the changing spin stand for that.
// Without them spheres would lag behind the flow by their inertial time, by more the farther they are from
// the origin, which is no place of a periodic suspension; with them velocities relative to the flow follow
// dv/dt = F / m - L v, whatever the origin. In steady shear both terms are zero.
#pragma once

#include "engine/state/system.h"

namespace peclet::engine {

// Whether the flow gains nothing by having this gradient, for a while, in the place of the cell's.
bool keeps_flow(const System& system, const Matrix3& gradient);

// Gives the cell this velocity gradient, and to velocities and spins what the flow has gained: by the change
// of the gradient, and by `time` in it.
void follow_flow(System& system, const Matrix3& gradient, double time, int threads);

}  // namespace peclet::engine
