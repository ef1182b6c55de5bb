// The energy that a step of velocity Verlet makes because it is finite.
//
// Forces F of a configuration x act for a whole step on velocities that they meanwhile change, from U' to
// U' + dt F / m, and springs act with their final tension while they are stretched by dt U'. Counting work by
// the forces and the velocities that they were evaluated with, kinetic and elastic energy grow by more than
// the work done by
//   C = dt^2 / 2 sum (F^2 / m + T^2 / I) + sum over springs [E(x) - E(x - dt U') - dt U'.grad E(x)].
// For a spring that stays linear the bracket is -k (extension)^2 / 2. So the balance over a window,
//   V rate sigma_xy dt summed = dissipated + stored + work of inertia - C summed,
// misses C and nothing else of first order. In smooth motion C is of first order in the step; where modes
// overshoot, as they do beyond the stable range, it is many times the work of the flow.
#pragma once

#include "engine/kernels/pair_kinds.h"
#include "engine/state/system.h"

namespace peclet::engine {

// Of the step that has just ended: velocities are those of the full step, force and torque those at the
// present positions. A tangential or rolling spring at Coulomb's limit slides and counts as not growing.
double spurious_energy(const System& system, const std::vector<PairKind>& kinds, const Physics& physics,
                       const VectorField& force, const VectorField& torque, double timestep);

}  // namespace peclet::engine
